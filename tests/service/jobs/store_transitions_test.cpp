#include "service/jobs/transitions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "service/jobs/live_progress.hpp"
#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {
namespace {

using Fault = JobStoreError::Fault;

/// A job's standing by the word that the expected table below uses.
const std::map<std::string, Standing> kStandings = {
    {"queued", {JobState::queued}},
    {"running", {JobState::running}},
    {"pausing", {JobState::running, PendingStop::pause}},
    {"cancelling", {JobState::running, PendingStop::cancel}},
    {"paused", {JobState::paused}},
    {"completed", {JobState::completed}},
    {"failed", {JobState::failed}},
    {"cancelled", {JobState::cancelled}},
};

std::string word_of(const Standing& standing) {
  for (const auto& [word, known] : kStandings) {
    if (known == standing) return word;
  }
  return "?";
}

constexpr std::string_view kActions[] = {"claim", "complete", "fail",   "requeue",
                                         "pause", "resume",   "cancel", "release"};

// Design section 7, written out: what each action gives in each standing. "-" is refused, "="
// changes nothing, "+" stands for "queued, with a later end time only".
constexpr std::string_view kOfUsers = R"(
           claim complete fail requeue pause   resume  cancel     release
queued     -     -        -    -       paused  =       cancelled  -
running    -     -        -    -       pausing =       cancelling -
pausing    -     -        -    -       =       running cancelling -
cancelling -     -        -    -       =       -       =          -
paused     -     -        -    -       =       queued  cancelled  -
completed  -     -        -    -       -       +       -          -
failed     -     -        -    -       -       +       -          -
cancelled  -     -        -    -       -       queued  =          -
)";
constexpr std::string_view kOfAttempts = R"(
           claim complete  fail   requeue   pause     resume cancel    release
queued     -     -         -      -         -         -      -         -
running    -     completed failed queued    paused    -      cancelled paused
pausing    -     completed failed paused    paused    -      cancelled paused
cancelling -     completed failed cancelled cancelled -      cancelled cancelled
paused     -     -         -      -         -         -      -         -
completed  -     -         -      -         -         -      -         -
failed     -     -         -      -         -         -      -         -
cancelled  -     -         -      -         -         -      -         -
)";

struct Cell {
  std::string from;
  JobAction action;
  std::string to;
};

std::vector<Cell> cells(std::string_view table) {
  std::istringstream rows{std::string(table)};
  std::string line;
  std::getline(rows, line);
  std::getline(rows, line);
  std::vector<Cell> all;
  for (std::size_t row = 0; row < kStandings.size(); ++row) {
    std::string from;
    rows >> from;
    for (std::size_t action = 0; action < std::size(kActions); ++action) {
      Cell cell{from, static_cast<JobAction>(action), {}};
      rows >> cell.to;
      all.push_back(cell);
    }
  }
  return all;
}

TEST(Words, OfStatesAndActionsReadBack) {
  for (const auto& [word, standing] : kStandings) {
    EXPECT_EQ(job_state(to_string(standing.state)), standing.state);
    EXPECT_EQ(pending_stop(to_string(standing.pending)), standing.pending);
  }
  EXPECT_EQ(job_state("Queued"), std::nullopt);
  EXPECT_EQ(job_state(""), std::nullopt);
  for (std::size_t i = 0; i < std::size(kActions); ++i) {
    EXPECT_EQ(to_string(static_cast<JobAction>(i)), kActions[i]);
  }
}

TEST(Transitions, AreNamedOncePerCell) {
  for (const Transition& row : transitions()) {
    int found = 0;
    for (const Transition& other : transitions()) {
      found += other.from == row.from && other.actor == row.actor && other.action == row.action;
    }
    EXPECT_EQ(found, 1) << word_of(row.from) << " " << to_string(row.action);
    EXPECT_EQ(row.event.empty(), row.from == row.to && !row.needs_later_end);
  }
}

/// What the store does with one cell, in words of the table.
void check(const Cell& cell, Actor actor) {
  SCOPED_TRACE(fmt::format("{} + {}", cell.from, to_string(cell.action)));
  const DataFolder data;
  JobStore store(data.path());
  const Standing from = kStandings.at(cell.from);
  const Job before = add_job_in(store, from.state, from.pending);
  ASSERT_EQ(word_of({before.state, before.pending_stop}), cell.from);
  // An attempt that outlived its job's running state has some token still.
  const std::string token =
      actor == Actor::user ? "" : (before.token.empty() ? "0123" : before.token);
  const auto apply = [&](const JobChange& change) {
    return store.apply(before.id, cell.action, token, change);
  };
  const std::string old_history = history(store, before.id);
  if (cell.to == "-" || cell.to == "+") {
    const std::string message = expect_refusal(Fault::conflict, [&] { (void)apply({}); });
    EXPECT_NE(message.find(before.id), std::string::npos) << message;
    EXPECT_TRUE(same(store.find(before.id).value(), before));
    EXPECT_EQ(history(store, before.id), old_history);
    if (cell.to == "-") return;
  }
  JobChange change;
  if (cell.to == "+") change.end_time = 2.0 * before.end_time;
  const Job after = apply(change);
  EXPECT_TRUE(same(store.find(before.id).value(), after));
  if (cell.to == "=") {
    EXPECT_TRUE(same(after, before));
    EXPECT_EQ(history(store, before.id), old_history);
    return;
  }
  const std::string expected = cell.to == "+" ? "queued" : cell.to;
  EXPECT_EQ(word_of({after.state, after.pending_stop}), expected);
  const std::string new_history = history(store, before.id);
  EXPECT_TRUE(new_history.starts_with(old_history + " ")) << new_history;
  EXPECT_EQ(new_history.find(' ', old_history.size() + 1), std::string::npos) << new_history;
  EXPECT_EQ(after.token, after.state == JobState::running ? before.token : "");
  EXPECT_EQ(after.ended_ms != 0, is_ended(after.state));
}

TEST(JobStore, DoesForUsersWhatTheTableSaysInEveryCell) {
  for (const Cell& cell : cells(kOfUsers)) check(cell, Actor::user);
}

TEST(JobStore, DoesForAttemptsWhatTheTableSaysInEveryCell) {
  for (const Cell& cell : cells(kOfAttempts)) check(cell, Actor::attempt);
}

TEST(JobStore, RefusesEveryActionOfAStaleAttempt) {
  const DataFolder data;
  JobStore store(data.path());
  const Job first = add_job_in(store, JobState::running);
  (void)store.apply(first.id, JobAction::requeue, first.token, {});
  const Job second = store.claim(1, {}).value();
  ASSERT_EQ(second.id, first.id);
  EXPECT_NE(second.token, first.token);
  for (std::size_t action = 0; action < std::size(kActions); ++action) {
    expect_refusal(Fault::conflict, [&] {
      (void)store.apply(first.id, static_cast<JobAction>(action), first.token, {});
    });
  }
  expect_refusal(Fault::conflict, [&] { store.record_progress(first.id, first.token, "{}"); });
  EXPECT_TRUE(same(store.find(first.id).value(), second));
  store.record_progress(first.id, second.token, R"({"step":7})");
  EXPECT_EQ(store.find(first.id)->progress, R"({"step":7})");
}

TEST(Progress, IsSeenAtOnceAndKeptOverTheEndOfItsAttemptAndARestart) {
  const DataFolder data;
  std::string id;
  {
    JobStore store(data.path());
    const Job running = add_job_in(store, JobState::running);
    id = running.id;
    store.record_progress(id, running.token, R"({"step":1})");
    store.record_progress(id, running.token, R"({"step":2})");
    EXPECT_EQ(store.find(id)->progress, R"({"step":2})");
    EXPECT_EQ(store.list({}).front().progress, R"({"step":2})");
    EXPECT_EQ(store.apply(id, JobAction::requeue, running.token, {}).progress, R"({"step":2})");
  }
  EXPECT_EQ(JobStore(data.path()).find(id)->progress, R"({"step":2})");
}

TEST(Progress, GoesToTheDiskEveryTenSecondsAlsoWhenTheClockIsSetBack) {
  LiveProgress live;
  EXPECT_FALSE(live.note("a", "1", 1'000'000));
  EXPECT_FALSE(live.note("a", "2", 1'009'999));
  EXPECT_TRUE(live.note("a", "3", 1'010'000));
  live.note_written("a", 1'010'000);
  EXPECT_FALSE(live.note("a", "4", 1'011'000));
  EXPECT_TRUE(live.note("a", "5", 1000));
}

TEST(Progress, OfAnAttemptThatEndedIsNotShownForTheNext) {
  LiveProgress live;
  (void)live.note("a", "1", 5);
  Job job;
  job.id = "a";
  live.show_in(job);
  EXPECT_EQ(job.progress, "1");
  EXPECT_EQ(job.updated_ms, 5);
  live.forget("a");
  job.progress = "of the row";
  live.show_in(job);
  EXPECT_EQ(job.progress, "of the row");
}

JobChange with_reason(const std::string& reason) {
  JobChange change;
  change.reason = reason;
  return change;
}

JobChange with_end(double end_time) {
  JobChange change;
  change.end_time = end_time;
  return change;
}

TEST(JobStore, ChangesWhatATransitionBringsAlongAndNothingElse) {
  const DataFolder data;
  JobStore store(data.path());
  const Job running = add_job_in(store, JobState::running);
  JobChange change = with_reason("lost");
  change.outcome = "{}";
  change.crashes = 2;
  const Job queued = store.apply(running.id, JobAction::requeue, running.token, change);
  EXPECT_EQ(queued.reason, "lost");
  EXPECT_EQ(queued.outcome, "{}");
  EXPECT_EQ(queued.crashes, 2);
  const Job again = store.claim(1, {}).value();
  EXPECT_EQ(again.reason, "") << "a reason to wait has no place in a running job";
  EXPECT_EQ(again.crashes, 2);
  EXPECT_EQ(again.attempts, 2);
  const Job paused =
      store.apply(running.id, JobAction::pause, again.token, with_reason("disk full"));
  const Job resumed = store.apply(running.id, JobAction::resume, "", {});
  EXPECT_EQ(paused.reason, "disk full");
  EXPECT_EQ(resumed.reason, "");
  EXPECT_EQ(resumed.crashes, 0);
  EXPECT_EQ(resumed.end_time, running.end_time);
  EXPECT_EQ(resumed.label, running.label);
}

TEST(JobStore, MovesTheEndTimeOnlyLaterAndOnlyByAResume) {
  const DataFolder data;
  JobStore store(data.path());
  const Job paused = add_job_in(store, JobState::paused);
  const auto apply = [&](JobAction action, double end_time) {
    return store.apply(paused.id, action, "", with_end(end_time));
  };
  const double end = paused.end_time;
  for (const double bad : {0.5 * end, 0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    expect_refusal(Fault::conflict, [&] { (void)apply(JobAction::resume, bad); });
  }
  expect_refusal(Fault::conflict, [&] { (void)apply(JobAction::cancel, 2.0 * end); });
  expect_refusal(Fault::conflict, [&] { (void)apply(JobAction::pause, 2.0 * end); });
  EXPECT_EQ(apply(JobAction::resume, 2.0 * end).end_time, 2.0 * end);
  // Queued again: asking for what is so is no change, asking for more is refused.
  EXPECT_EQ(apply(JobAction::resume, 2.0 * end).state, JobState::queued);
  expect_refusal(Fault::conflict, [&] { (void)apply(JobAction::resume, 3.0 * end); });
  EXPECT_EQ(store.find(paused.id)->end_time, 2.0 * end);
}

TEST(JobStore, TellsThatAComputationThatFailedWouldFailAgain) {
  const DataFolder data;
  JobStore store(data.path());
  const auto advice_after = [&](int exit_code) {
    const Job running = add_job_in(store, JobState::running);
    JobChange change;
    change.outcome = fmt::format(R"({{"state": "failed", "exit_code": {}}})", exit_code);
    (void)store.apply(running.id, JobAction::fail, running.token, change);
    std::string all;
    for (const JobAction action : {JobAction::resume, JobAction::cancel}) {
      try {
        (void)store.apply(running.id, action, "", {});
        ADD_FAILURE() << to_string(action);
      } catch (const JobStoreError& error) {
        all += error.what();
      }
    }
    return all;
  };
  const std::string of_physics = advice_after(4);
  EXPECT_NE(of_physics.find("fail again at the same step"), std::string::npos) << of_physics;
  EXPECT_NE(of_physics.find("submit a changed scene"), std::string::npos) << of_physics;
  EXPECT_EQ(of_physics.find("give a later end time"), std::string::npos) << of_physics;
  EXPECT_NE(advice_after(6).find("give a later end time"), std::string::npos);
}

TEST(JobStore, ObeysAPauseThatCameWhileTheAttemptWasLost) {
  const DataFolder data;
  JobStore store(data.path());
  const Job running = add_job_in(store, JobState::running, PendingStop::pause);
  EXPECT_EQ(running.state, JobState::running);
  const Job after = store.apply(running.id, JobAction::requeue, running.token, with_reason("lost"));
  EXPECT_EQ(after.state, JobState::paused);
  EXPECT_EQ(history(store, running.id), "submitted claimed pause_requested paused");
}

TEST(JobStore, SaysThatThereIsNoSuchJob) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string id = store.new_id();
  expect_refusal(Fault::not_found, [&] { (void)store.apply(id, JobAction::pause, "", {}); });
  expect_refusal(Fault::not_found, [&] { store.record_progress(id, "x", "{}"); });
  expect_refusal(Fault::not_found, [&] { store.record_event(id, "checkpoint", "{}"); });
  expect_refusal(Fault::not_found, [&] { store.remove(id); });
  EXPECT_FALSE(store.find(id));
  EXPECT_FALSE(store.find("' OR 1=1 --"));
}

}  // namespace
}  // namespace sluice::test

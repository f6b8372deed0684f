#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "service/jobs/job_ids.hpp"
#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {
namespace {

using Fault = JobStoreError::Fault;

TEST(JobIds, SortByTheirMakingEvenWhenTheClockIsSetBack) {
  JobIds ids;
  std::string last;
  for (const std::int64_t now :
       {1'000'000LL, 1'000'000LL, 1'000'001LL, 5LL, 0LL, -7LL, 2'000'000LL}) {
    for (int i = 0; i < 1000; ++i) {
      const std::string id = ids.next(now);
      ASSERT_TRUE(is_job_id(id)) << id;
      ASSERT_LT(last, id);
      last = id;
    }
  }
  EXPECT_EQ(time_of_job_id(last), 2'000'000);
}

TEST(JobIds, GoOnAfterThoseOfAnEarlierProgram) {
  JobIds before;
  const std::string last = before.next(9'000'000);
  JobIds after;
  after.follow(last);
  after.follow("not an id");
  after.follow("");
  EXPECT_GT(after.next(8'000'000), last);
  // The largest tail carries over into the time.
  JobIds full;
  full.follow("j0000000001vvvvvvvvvv");
  EXPECT_GT(full.next(0), "j0000000001vvvvvvvvvv");
}

TEST(JobIds, AreTheOnlyTextsTakenForIds) {
  for (const char* bad : {"", "j", "..", "j00000000000000000000/", "J00000000000000000000",
                          "j0000000000000000000", "j000000000000000000000", "j0000000000000000000w",
                          "k00000000000000000000", "j000000000\n0000000000"}) {
    EXPECT_FALSE(is_job_id(bad)) << bad;
    EXPECT_EQ(time_of_job_id(bad), std::nullopt);
  }
  EXPECT_TRUE(is_job_id("j0123456789abcdefghij"));
}

TEST(JobIds, OfAStoreDifferAfterARestart) {
  const DataFolder data;
  std::set<std::string> ids;
  std::string last;
  for (int start = 0; start < 3; ++start) {
    JobStore store(data.path());
    for (int i = 0; i < 100; ++i) {
      const std::string id = add_job(store).id;
      EXPECT_LT(last, id);
      last = id;
      ids.insert(id);
    }
  }
  EXPECT_EQ(ids.size(), 300U);
}

TEST(Token, Has128BitsAndIsNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 1000U);
}

TEST(Submit, KeepsTheJobAsItWasGivenAcrossARestart) {
  const DataFolder data;
  Job submitted;
  {
    JobStore store(data.path());
    Job job = a_job(-3, 2);
    job.name = std::string("nul\0inside", 10);
    job.id = store.new_id();
    submitted = store.submit(job, "", "", 10).job;
    EXPECT_EQ(submitted.id, job.id);
    EXPECT_EQ(submitted.name, job.name);
    EXPECT_EQ(submitted.label, job.label);
    EXPECT_EQ(submitted.priority, -3);
    EXPECT_EQ(submitted.threads, 2);
    EXPECT_EQ(submitted.created_ms, job.created_ms);
    EXPECT_EQ(submitted.end_time, 0.1);
    EXPECT_EQ(submitted.estimate, job.estimate);
    EXPECT_EQ(submitted.state, JobState::queued);
    EXPECT_EQ(history(store, job.id), "submitted");
  }
  const JobStore store(data.path());
  EXPECT_TRUE(same(store.find(submitted.id).value(), submitted));
}

TEST(Submit, TakesNoStateTokenOrCountsFromOutside) {
  const DataFolder data;
  JobStore store(data.path());
  Job job = a_job();
  job.state = JobState::running;
  job.token = "mine";
  job.attempts = 7;
  job.ended_ms = 5;
  const Job added = store.submit(job, "", "", 10).job;
  EXPECT_EQ(added.state, JobState::queued);
  EXPECT_EQ(added.token, "");
  EXPECT_EQ(added.attempts, 0);
  EXPECT_EQ(added.ended_ms, 0);
}

TEST(Submit, IsRefusedForAnIdThatIsTakenOrARowThatBreaksARule) {
  const DataFolder data;
  JobStore store(data.path());
  Job job = add_job(store);
  expect_refusal(Fault::conflict, [&] { store.submit(job, "key", "", 10); });
  Job threadless = a_job();
  threadless.threads = 0;
  expect_refusal(Fault::conflict, [&] { store.submit(threadless, "key", "", 10); });
  Job endless = a_job();
  endless.end_time = std::numeric_limits<double>::quiet_NaN();
  expect_refusal(Fault::conflict, [&] { store.submit(endless, "key", "", 10); });
  EXPECT_EQ(store.list({}).size(), 1U);
  EXPECT_FALSE(store.find_by_key("key", "")) << "a refused job must not keep its key";
}

TEST(Submit, StopsAtTheLimitOfTheQueueAndGoesOnWhenThereIsRoom) {
  const DataFolder data;
  JobStore store(data.path());
  store.submit(a_job(), "", "", 2);
  store.submit(a_job(), "first", "hash", 2);
  expect_refusal(Fault::full, [&] { store.submit(a_job(), "", "", 2); });
  EXPECT_TRUE(store.submit(a_job(), "first", "hash", 2).repeated) << "a repetition needs no room";
  ASSERT_TRUE(store.claim(1, {}));
  EXPECT_NO_THROW(store.submit(a_job(), "", "", 2));
}

TEST(IdempotencyKey, GivesTheSameJobUntilTheJobIsRemoved) {
  const DataFolder data;
  std::string id;
  {
    JobStore store(data.path());
    const auto first = store.submit(a_job(), "key", "hash", 10);
    EXPECT_FALSE(first.repeated);
    id = first.job.id;
  }
  JobStore store(data.path());
  const auto second = store.submit(a_job(), "key", "hash", 10);
  EXPECT_TRUE(second.repeated);
  EXPECT_EQ(second.job.id, id);
  EXPECT_EQ(store.find_by_key("key", "hash")->id, id);
  (void)store.apply(id, JobAction::cancel, "", {});
  EXPECT_EQ(store.submit(a_job(), "key", "hash", 10).job.state, JobState::cancelled);
  store.remove(id);
  EXPECT_FALSE(store.find_by_key("key", "hash"));
  EXPECT_NE(store.submit(a_job(), "key", "other", 10).job.id, id);
}

TEST(IdempotencyKey, IsRefusedWithAnotherBody) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string id = store.submit(a_job(), "key", "hash", 10).job.id;
  const std::string message =
      expect_refusal(Fault::key_reused, [&] { store.submit(a_job(), "key", "other", 10); });
  EXPECT_NE(message.find(id), std::string::npos) << message;
  expect_refusal(Fault::key_reused, [&] { (void)store.find_by_key("key", "other"); });
  EXPECT_EQ(store.list({}).size(), 1U);
  EXPECT_FALSE(store.find_by_key("KEY", "hash"));
  EXPECT_FALSE(store.find_by_key("", ""));
}

TEST(Claim, TakesTheHighestPriorityThenTheOldest) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string low = add_job(store, -1).id;
  const std::string old = add_job(store, 5).id;
  const std::string young = add_job(store, 5).id;
  for (const std::string& expected : {old, young, low}) {
    const std::optional<Job> job = store.claim(1, {});
    ASSERT_TRUE(job);
    EXPECT_EQ(job->id, expected);
    EXPECT_EQ(job->state, JobState::running);
    EXPECT_EQ(job->attempts, 1);
    EXPECT_GT(job->started_ms, 0);
    EXPECT_EQ(job->token.size(), 32U);
    EXPECT_TRUE(same(*job, store.find(expected).value()));
  }
  EXPECT_FALSE(store.claim(1, {}));
}

TEST(Claim, PassesOverWhatNeedsMoreThreadsOrIsExcepted) {
  const DataFolder data;
  JobStore store(data.path());
  const std::string wide = add_job(store, 9, 4).id;
  const std::string first = add_job(store, 0, 2).id;
  const std::string second = add_job(store, 0, 1).id;
  EXPECT_FALSE(store.claim(0, {}));
  EXPECT_FALSE(store.claim(4, {wide, first, second, "'); DROP TABLE jobs; --", "\xff\xfe"}));
  EXPECT_EQ(store.claim(3, {first})->id, second);
  EXPECT_EQ(store.claim(3, {})->id, first);
  EXPECT_EQ(store.claim(4, {})->id, wide);
}

TEST(List, GoesThroughAllJobsNewestFirstInPages) {
  const DataFolder data;
  JobStore store(data.path());
  std::vector<std::string> ids;
  for (int i = 0; i < 23; ++i) ids.insert(ids.begin(), add_job(store).id);
  std::vector<std::string> listed;
  JobFilter filter;
  filter.limit = 5;
  std::vector<std::size_t> sizes;
  for (std::vector<Job> page = store.list(filter); !page.empty(); page = store.list(filter)) {
    sizes.push_back(page.size());
    for (const Job& job : page) listed.push_back(job.id);
    filter.after = page.back().id;
    // What comes or goes meanwhile moves no page.
    (void)add_job(store);
  }
  EXPECT_EQ(listed, ids);
  EXPECT_EQ(sizes, (std::vector<std::size_t>{5, 5, 5, 5, 3}));
  filter = {};
  filter.limit = std::numeric_limits<std::size_t>::max();
  EXPECT_EQ(store.list(filter).size(), 28U);
  filter.limit = 0;
  EXPECT_TRUE(store.list(filter).empty());
}

TEST(List, FiltersByStateAndLabelTogether) {
  const DataFolder data;
  JobStore store(data.path());
  const auto add = [&](const std::string& label) {
    Job job = a_job();
    job.label = label;
    return store.submit(job, "", "", 100).job.id;
  };
  const std::string a = add("a");
  const std::string b = add("b");
  const std::string other = add("a");
  (void)store.apply(a, JobAction::pause, "", {});
  const auto ids = [&](std::optional<JobState> state, std::optional<std::string> label) {
    std::vector<std::string> found;
    for (const Job& job : store.list({state, label, "", 50})) found.push_back(job.id);
    return found;
  };
  using Ids = std::vector<std::string>;
  EXPECT_EQ(ids(JobState::paused, "a"), Ids{a});
  EXPECT_EQ(ids(JobState::queued, {}), (Ids{other, b}));
  EXPECT_EQ(ids({}, "a"), (Ids{other, a}));
  EXPECT_EQ(ids({}, ""), Ids{});
  EXPECT_EQ(ids({}, "%"), Ids{});
  EXPECT_EQ(ids(JobState::failed, {}), Ids{});
}

TEST(Counts, NameEveryState) {
  const DataFolder data;
  JobStore store(data.path());
  (void)add_job_in(store, JobState::completed);
  (void)add_job_in(store, JobState::running);
  (void)add_job(store);
  (void)add_job(store);
  std::size_t all = 0;
  for (const auto& [state, count] : store.count_by_state()) {
    const std::size_t expected = state == JobState::queued                                    ? 2U
                                 : state == JobState::completed || state == JobState::running ? 1U
                                                                                              : 0U;
    EXPECT_EQ(count, expected) << to_string(state);
    all += count;
  }
  EXPECT_EQ(store.count_by_state().size(), 6U);
  EXPECT_EQ(all, 4U);
}

TEST(Remove, TakesOnlyEndedJobsAndNothingOfOthers) {
  const DataFolder data;
  JobStore store(data.path());
  const Job ended = add_job_in(store, JobState::failed);
  const Job running = add_job_in(store, JobState::running);
  const Job paused = add_job_in(store, JobState::paused);
  const Job queued = add_job(store);
  for (const Job& job : {running, paused, queued}) {
    expect_refusal(Fault::conflict, [&] { store.remove(job.id); });
    EXPECT_TRUE(same(store.find(job.id).value(), job));
  }
  store.remove(ended.id);
  EXPECT_FALSE(store.find(ended.id));
  EXPECT_TRUE(store.events(ended.id, 0, 10).empty());
  EXPECT_EQ(history(store, running.id), "submitted claimed");
}

}  // namespace
}  // namespace sluice::test

#include "service/scheduler/attempt_end.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/errors.hpp"
#include "service/jobs/worker_exit.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kLongestOutcome = std::uint64_t{1} << 20;
constexpr double kLongestBackOff = 60.0;  // s

std::int64_t changed_ms(const struct stat& status) {
  return std::int64_t{status.st_mtim.tv_sec} * 1000 + status.st_mtim.tv_nsec / 1'000'000;
}

bool written_since(const std::filesystem::path& path, std::int64_t time_ms) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && changed_ms(status) >= time_ms;
}

FreshOutcome outcome_of(const std::string& text, double end_time) {
  const Json object = read_stored_json(text);
  FreshOutcome outcome;
  outcome.state = object.at("state").get<std::string>();
  outcome.exit_code = object.at("exit_code").get<int>();
  outcome.reason = object.at("reason").get<std::string>();
  outcome.at_end = outcome.state == "completed" && object.at("end_time").get<double>() >= end_time;
  outcome.text = text;
  return outcome;
}

std::string end_text(const std::optional<ProcessEnd>& end) {
  if (!end) return "was lost together with the service";
  if (end->signal == SIGKILL) {
    return "was killed by signal 9: by someone, or by the system for want of memory";
  }
  if (end->signal != 0) {
    return fmt::format("was killed by signal {} ({})", end->signal, ::strsignal(end->signal));
  }
  return end->exit_code < 0 ? "ended in an unknown way"
                            : fmt::format("ended with exit code {}", end->exit_code);
}

std::string_view cause_word(StopCause cause) {
  switch (cause) {
    case StopCause::none:
      return "none";
    case StopCause::asked:
      return "asked";
    case StopCause::drain:
      return "drain";
    case StopCause::wall_limit:
      return "wall_limit";
    case StopCause::disk_low:
      return "disk_low";
    case StopCause::disk_limit:
      return "disk_limit";
    case StopCause::stalled:
      return "stalled";
  }
  return "none";
}

std::string detail_of(const AttemptFacts& facts, const std::string& reason) {
  Json detail = Json::object();
  if (facts.end && facts.end->exit_code >= 0) detail["exit_code"] = facts.end->exit_code;
  if (facts.end && facts.end->signal != 0) detail["signal"] = facts.end->signal;
  if (facts.cause != StopCause::none) detail["cause"] = cause_word(facts.cause);
  if (!reason.empty()) detail["reason"] = reason;
  return detail.dump(-1, ' ', false, Json::error_handler_t::replace);
}

AttemptVerdict verdict(const AttemptFacts& facts, JobAction action, std::string reason) {
  AttemptVerdict result;
  result.action = action;
  result.change.event_detail = detail_of(facts, reason);
  result.change.reason = std::move(reason);
  if (facts.outcome) result.change.outcome = facts.outcome->text;
  // Whatever reached a newer checkpoint is no crash that repeats.
  if (facts.progressed && facts.crashes > 0) result.change.crashes = 0;
  return result;
}

std::string or_else(const std::string& text, std::string_view otherwise) {
  return text.empty() ? std::string(otherwise) : text;
}

AttemptVerdict lost(const AttemptFacts& facts, int crash_limit) {
  const int crashes = (facts.progressed ? 0 : facts.crashes) + 1;
  std::string reason = facts.cause == StopCause::stalled
                           ? std::string("its worker made no progress and was ended")
                           : "its worker " + end_text(facts.end);
  if (!facts.message.empty()) reason += fmt::format(" ({})", facts.message);
  const bool enough = crashes >= crash_limit;
  if (enough && crashes > 1) {
    reason = fmt::format("{} attempts in a row were lost without progress; the last: {}", crashes,
                         reason);
  }
  AttemptVerdict result = verdict(facts, enough ? JobAction::fail : JobAction::requeue, reason);
  result.change.crashes = crashes;
  result.next = NextTry::after_crash;
  return result;
}

/// A stop that was asked for, or that no one knows of.
AttemptVerdict stopped(const AttemptFacts& facts, int crash_limit) {
  switch (facts.cause) {
    case StopCause::asked:
    case StopCause::drain:
      return verdict(facts, JobAction::requeue, "");
    case StopCause::wall_limit:
      return verdict(facts, JobAction::pause,
                     "it ran as long as one attempt may; resume it from there");
    case StopCause::disk_low:
      return verdict(facts, JobAction::pause,
                     "the disk of the service is nearly full; make room, then resume it");
    case StopCause::disk_limit:
      return verdict(facts, JobAction::pause,
                     "its files take more of the disk than one job may; delete frames that you do "
                     "not need or have the limit raised, then resume it");
    case StopCause::none:
    case StopCause::stalled:
      break;
  }
  // A worker that stops unasked again and again would do so for ever. One that nobody watched was
  // told by the end of the service.
  if (facts.progressed || !facts.end) return verdict(facts, JobAction::requeue, "");
  return lost(facts, crash_limit);
}

bool was_told_to_stop(StopCause cause) {
  return cause != StopCause::none && cause != StopCause::stalled;
}

/// The exit code that counts: of a worker that nobody watched it is in its outcome.
int exit_code_of(const AttemptFacts& facts) {
  if (facts.end) return facts.end->exit_code;
  return facts.outcome && facts.outcome->state != "completed" ? facts.outcome->exit_code : -1;
}

}  // namespace

std::optional<FreshOutcome> fresh_outcome(const JobPaths& paths, const Job& job) {
  if (!written_since(paths.outcome(), job.started_ms)) return {};
  try {
    return told_outcome(read_text(paths.outcome(), kLongestOutcome, Links::refuse), job);
  } catch (const StorageError&) {
    return {};
  }
}

std::optional<FreshOutcome> told_outcome(const std::string& text, const Job& job) {
  try {
    return outcome_of(text, job.end_time);
  } catch (const std::exception&) {
    return {};
  }
}

bool made_checkpoint(const JobPaths& paths, const Job& job) {
  try {
    const auto checkpoints = paths.checkpoints();
    return !checkpoints.empty() && written_since(checkpoints.front(), job.started_ms);
  } catch (const StorageError&) {
    return false;
  }
}

AttemptVerdict judge(const AttemptFacts& facts, int crash_limit) {
  // However the process ended: what is on disk counts.
  if (facts.outcome && facts.outcome->at_end) return verdict(facts, JobAction::complete, "");
  const int code = exit_code_of(facts);
  const std::string& message =
      facts.outcome && !facts.outcome->reason.empty() ? facts.outcome->reason : facts.message;
  switch (code) {
    case WorkerExit::checkpointed:
      return stopped(facts, crash_limit);
    case WorkerExit::numerical_failure:
      return verdict(facts, JobAction::fail, or_else(message, "the computation failed"));
    case WorkerExit::storage_failure:
      return verdict(facts, JobAction::pause, or_else(message, "its files cannot be written"));
    case WorkerExit::no_usable_checkpoint:
      return verdict(facts, JobAction::fail, or_else(message, "none of its checkpoints is usable"));
    case WorkerExit::invalid_scene:
      return verdict(facts, JobAction::fail, or_else(message, "its scene is invalid"));
    case WorkerExit::usage:
      return verdict(facts, JobAction::fail, or_else(message, "its folder holds no job"));
    case WorkerExit::folder_locked: {
      AttemptVerdict result =
          verdict(facts, JobAction::requeue, or_else(message, "another process uses its folder"));
      result.next = NextTry::after_lock;
      return result;
    }
    default:
      break;
  }
  // It did not obey in time, or not even listen yet; the checkpoints are safe.
  if (was_told_to_stop(facts.cause)) return stopped(facts, crash_limit);
  return lost(facts, crash_limit);
}

double back_off(int count) {
  return std::min(kLongestBackOff, std::exp2(std::clamp(count, 1, 10) - 1));
}

}  // namespace sluice

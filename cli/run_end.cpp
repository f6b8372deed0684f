#include "cli/run_end.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/shell_word.hpp"
#include "engine/report/report.hpp"
#include "engine/run/insist.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kLargestOutcome = 1 << 20;

std::string complete_text(const JobFolder& folder, const Outcome& outcome) {
  return fmt::format("{} is complete already: step {}, t = {:.6g} s; nothing was run\n",
                     folder.name().string(), outcome.step, outcome.time);
}

/// What a run's account was that was complete before: that of the attempt that completed it.
std::string earlier_account(const std::string& earlier) {
  const Json outcome = Json::parse(earlier);
  const Json& attempt = outcome.at("this_attempt");
  return fmt::format("  its last attempt: {} steps in {:.2f} s, {} threads, {}\n",
                     attempt.value("steps", std::uint64_t{0}), attempt.value("seconds", 0.0),
                     outcome.value("threads", 1), outcome.value("simd_target", ""));
}

}  // namespace

std::string completed_outcome(const JobFolder& folder, const Scene& scene) {
  try {
    std::string text = read_text(folder.paths().outcome(), kLargestOutcome);
    const Json outcome = Json::parse(text);
    const bool reached = outcome.at("state") == "completed" &&
                         outcome.at("end_time").get<double>() == scene.end_time;
    return reached ? text : "";
  } catch (const std::exception&) {
    return {};  // Then the run says itself how far it is.
  }
}

std::string closing_text(JobFolder& folder, const Outcome& outcome, const std::string& earlier) {
  const bool nothing_done = outcome.exit_code == ExitCode::done && outcome.account.steps == 0;
  if (!nothing_done) return summary_text(outcome);
  std::string text = complete_text(folder, outcome);
  if (earlier.empty()) return text;
  try {
    const std::string account = earlier_account(earlier);
    folder.publish_text(folder.paths().outcome(), earlier);
    return text + account;
  } catch (const std::exception&) {  // a full disk, or an outcome of another form
    return text;
  }
}

std::string next_commands(const JobFolder& folder, const Scene& scene, const Outcome& outcome) {
  if (!folder.is_held()) return {};
  const fs::path root = folder.name();
  std::string text;
  // A numerical failure would only come again.
  const bool can_resume =
      outcome.exit_code == ExitCode::checkpointed || outcome.exit_code == ExitCode::storage_failure;
  std::error_code ignored;
  const bool has_scene = fs::exists(folder.paths().scene(), ignored);
  if (can_resume && !has_scene) {
    text += "  scene.json was removed meanwhile: put the scene of this run back under that name\n";
  }
  if (can_resume) text += fmt::format("  to resume:  sluice run {}\n", shell_path(root));
  const auto checkpoints = folder.paths().checkpoints();
  if (!checkpoints.empty()) {
    text += fmt::format("  to look in: sluice inspect {}\n",
                        shell_path(root / checkpoints.front().filename()));
  }
  for (const Sensor& sensor : scene.sensors) {
    if (sensor.kind != SensorKind::pressure) continue;
    return text + fmt::format("  to plot:    sluice sensors {} {} --filter gaussian --tau 0.002\n",
                              shell_path(root), sensor.name);
  }
  return text;
}

void leave_report(const JobFolder& folder, const Outcome& outcome, double patience,
                  const std::function<bool()>& hurried) {
  if (outcome.exit_code != ExitCode::done) return;
  try {
    insist(
        patience,
        [&] {
          folder.require_held();
          publish_report(folder.paths().root(), folder.paths().root());
        },
        [&folder](const StorageError& error, double wait) {
          std::fputs(fmt::format("sluice: no report yet, next try in {:.1f} s: {}\n", wait,
                                 told_outside(folder.name(), error).what())
                         .c_str(),
                     stderr);
        },
        hurried);
  } catch (const std::exception& error) {
    std::fputs(fmt::format("sluice: no report: {}; sluice report {} makes it\n",
                           told_outside(folder.name(), std::string(error.what())),
                           shell_path(folder.name()))
                   .c_str(),
               stderr);
  }
}

}  // namespace sluice

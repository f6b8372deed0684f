#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "service/jobs/job_store.hpp"
#include "service/scheduler/scheduler.hpp"
#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {

/// A dam break of 50 particles at the coarse spacing (m); a moment's work for a second of model
/// time.
[[nodiscard]] std::string tiny_scene(double end_time, double spacing = 0.06);
/// Water at rest that stays stable for longer than any test looks on.
[[nodiscard]] std::string endless_scene();

/// A program for the scheduler to start in place of `sluice`: a bash script that gets the arguments
/// of a worker, so that "$2" is the job's folder, where it starts. FOLDER/n holds how many times it
/// was started, and
/// "$n" is that number.
[[nodiscard]] std::filesystem::path write_worker(const DataFolder& data, std::string_view script);
/// Lines for such a script: what a worker says when it begins, and as outcome.json when it is done.
inline constexpr std::string_view kSayStarted = R"(echo '{"event":"started","step":0}')";
inline constexpr std::string_view kComplete =
    R"(echo '{"state":"completed","exit_code":0,"reason":"","end_time":0.1}' > "$2/outcome.json")";

/// A queued job with its folder and scene.
Job add_real_job(JobStore& store, const DataFolder& data, double end_time = 0.1, int priority = 0,
                 int threads = 1);

/// The same with a second or two of work, so that it can be interrupted.
Job add_slow_job(JobStore& store, const DataFolder& data);
/// The same with endless_scene().
Job add_endless_job(JobStore& store, const DataFolder& data);

/// For scripts: no sandbox, two cores, and no disk guard, because the machine's disk is its own.
[[nodiscard]] ServiceLimits limits_for_scripts();
/// For the program itself.
[[nodiscard]] ServiceLimits limits_for_sluice();
[[nodiscard]] std::filesystem::path sluice_program();

/// Waits until `condition` holds. The bound is there only so that a hang ends as a failure.
void wait_until(std::string_view what, const std::function<bool()>& condition);
/// Waits until the job is in that state and returns it.
Job wait_for(const JobStore& store, const std::string& id, JobState state);
/// Waits until the job has an event of that name, and returns its detail.
std::string wait_for_event(const JobStore& store, const std::string& id, std::string_view name);
[[nodiscard]] int count_events(const JobStore& store, const std::string& id, std::string_view name);
/// The process that the last worker_started event names.
[[nodiscard]] int worker_pid(const JobStore& store, const std::string& id);
/// The digest of the particles in a job's outcome.
[[nodiscard]] std::string physics_digest_of(const Job& job);

[[nodiscard]] std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace sluice::test

#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/store/files/job_folder.hpp"
#include "service/api/answer_maker.hpp"
#include "service/http/message.hpp"
#include "service/http/slots.hpp"
#include "service/jobs/job_store.hpp"
#include "service/jobs/study_store.hpp"
#include "service/scheduler/metrics.hpp"
#include "service/scheduler/scheduler.hpp"

namespace sluice {

/// Requests that may hold a thread for long; the rest of the server's threads stay free.
inline constexpr int kMaxStreams = 16;
inline constexpr int kMaxWaits = 24;
/// s between looks at the progress of a job that is waited for: progress makes no event.
inline constexpr double kProgressLook = 0.5;

/// What the routes share. Every member may be used from any thread.
struct ApiContext {
  ApiContext(JobStore& jobs, Scheduler& workers, std::filesystem::path folder,
             std::filesystem::path executable)
      : store(jobs),
        scheduler(workers),
        data(std::move(folder)),
        program(std::move(executable)),
        studies(data),
        metrics(jobs.last_event()) {}

  [[nodiscard]] JobPaths paths(const std::string& id) const { return JobPaths(data / "jobs" / id); }

  JobStore& store;
  Scheduler& scheduler;
  std::filesystem::path data;
  std::filesystem::path program;  ///< `sluice`, which makes reports
  StudyStore studies;
  Metrics metrics;
  AnswerMaker maker;
  Slots streams{kMaxStreams};
  Slots waits{kMaxWaits};
  std::atomic<bool> draining = false;
  std::mutex study_changes;  ///< one at a time: each touches many jobs
  std::mutex keyed_submits;  ///< one at a time, so that a repeated key does no work twice
};

/// A request with what its route's pattern caught, in the pattern's order.
struct RouteRequest {
  const Request& http;
  std::vector<std::string> parts;
};

/// The job that the request names. Throws ApiError(no_such_job).
[[nodiscard]] Job find_job(const ApiContext& context, const std::string& id);
/// The job's JSON, with what the scheduler knows of it now.
[[nodiscard]] nlohmann::ordered_json document_of(const ApiContext& context, const Job& job);
/// The study that the request names. Throws ApiError(no_such_study).
[[nodiscard]] StudyRecord find_study(const ApiContext& context, const std::string& id);

}  // namespace sluice

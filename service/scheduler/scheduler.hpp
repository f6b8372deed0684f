#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/execute/local_executor.hpp"
#include "service/jobs/job_store.hpp"
#include "service/jobs/limits.hpp"
#include "service/scheduler/scheduler_senses.hpp"

namespace sluice {

/// Claims jobs, starts one worker process per attempt (`/proc/self/exe run FOLDER`), reads its JSON
/// lines, and turns its end into a transition. Owns one thread.
///
/// When the disk has less than its reserve left, running jobs are paused with the reason and none
/// is started. They stay paused until someone resumes them: only a person knows whether there is
/// room for good.
class Scheduler {
 public:
  /// At start: jobs that are marked running are completed, requeued or failed by what their folder
  /// says. Where a worker that outlived the last service still holds the folder's lock, that waits
  /// until it is gone. `worker` is the program to start; empty: this one. It and `senses` are for
  /// tests. `executor` starts it, on the scheduler's thread alone, and outlives the scheduler.
  Scheduler(JobStore& store, const std::filesystem::path& data, const ServiceLimits& limits,
            const std::filesystem::path& worker = {}, const SchedulerSenses& senses = {},
            Executor& executor = local_executor());
  /// Drains: asks every worker for a checkpoint, waits for them, and puts the jobs back into the
  /// queue.
  ~Scheduler();

  /// Looks at the queue now: a job came, or a request to stop one.
  void poke();
  /// Stops claiming, has every worker checkpoint, and returns when all are gone. Idempotent.
  void drain();
  /// SIGUSR1 to the job's worker. False when it does not run.
  bool checkpoint_now(const std::string& id);
  /// Why a queued job does not run yet, for a person; empty for a job that is not queued.
  [[nodiscard]] std::string why_waiting(const Job& job) const;
  /// The process that runs the job; nothing when none does, or one of a service before this.
  [[nodiscard]] std::optional<pid_t> worker_of(const Job& job) const;
  [[nodiscard]] const ServiceLimits& limits() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sluice

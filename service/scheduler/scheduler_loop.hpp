#pragma once

#include <filesystem>
#include <list>
#include <string>
#include <vector>

#include "engine/execute/executor.hpp"
#include "service/jobs/job_store.hpp"
#include "service/jobs/queue_view.hpp"
#include "service/jobs/retention_clock.hpp"
#include "service/scheduler/attempt.hpp"
#include "service/scheduler/conclusions.hpp"
#include "service/scheduler/orphan_watch.hpp"
#include "service/scheduler/patience.hpp"
#include "service/scheduler/scheduler.hpp"
#include "service/scheduler/scheduler_board.hpp"
#include "service/scheduler/scheduler_senses.hpp"

namespace sluice {

/// What the scheduler's thread does, from recovery to drain. All of it runs on that one thread:
/// workers get a signal when the thread that started them ends.
class SchedulerLoop {
 public:
  SchedulerLoop(JobStore& store, std::filesystem::path data, ServiceLimits limits,
                const std::filesystem::path& worker, SchedulerSenses senses, Executor& executor,
                const QueueView& queue, SchedulerBoard& board);

  /// Returns when it was asked to drain and all workers are gone.
  void run();

 private:
  // The rounds of the loop.
  void recover();
  void one_round();
  void wait();
  void serve_workers();
  void obey_requests();
  void tick();
  void start_jobs();
  void publish_status();
  [[nodiscard]] bool drained() const;

  // What they consist of.
  template <class Action>
  void orphaned_on_error(const Job& job, const Action& action);
  void record(const Attempt& attempt, const std::vector<WorkerMessage>& messages);
  void record_progress(Attempt& attempt);
  void finish(Attempt& attempt, const ProcessEnd& end);
  void look_after_orphans();
  void conclude_orphan(const Job& job);
  void watch_disk();
  void delete_old_jobs_when_due();
  /// False when the system refused, as it would refuse the next one too.
  bool start(const Job& job);
  /// Back into the queue for a while, or paused when that was so too often; no crash.
  void put_off(const Job& job, std::string reason);
  [[nodiscard]] bool head_waits_for_room(int free, const std::vector<std::string>& except);
  [[nodiscard]] int free_threads() const;
  [[nodiscard]] JobPaths paths(const Job& job) const;

  JobStore& store_;
  std::filesystem::path data_;
  ServiceLimits limits_;
  SchedulerSenses senses_;
  std::filesystem::path worker_;
  Executor& executor_;
  const QueueView& queue_;
  SchedulerBoard& board_;
  int cores_;

  std::list<Attempt> attempts_;
  OrphanWatch orphans_;
  Conclusions conclusions_;
  Patience patience_;
  RetentionClock retention_;
  bool disk_low_ = false;
  bool look_ = true;  ///< something may have changed that concerns the queue or stops
  double next_tick_ = 0.0;
  double next_deletion_ = 0.0;
  double draining_since_ = 0.0;
};

}  // namespace sluice

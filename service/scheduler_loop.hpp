#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <string>
#include <vector>

#include "service/attempt.hpp"
#include "service/back_offs.hpp"
#include "service/job_store.hpp"
#include "service/queue_view.hpp"
#include "service/scheduler.hpp"
#include "service/scheduler_board.hpp"

namespace sluice {

/// What the scheduler's thread does, from recovery to drain. All of it runs on that one thread:
/// workers get a signal when the thread that started them ends.
class SchedulerLoop {
 public:
  SchedulerLoop(JobStore& store, std::filesystem::path data, ServiceLimits limits,
                const std::filesystem::path& worker, const QueueView& queue, SchedulerBoard& board);

  /// Returns when it was asked to drain and all workers are gone.
  void run();

 private:
  /// A job that is marked running and has no worker of this service.
  struct Orphan {
    Job job;
    double since = 0.0;
    bool killed = false;
  };
  /// A transition that the store has yet to take.
  struct Ended {
    Job job;
    AttemptVerdict verdict;
  };

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
  void finish(Attempt& attempt, const WorkerEnd& end);
  void conclude(const Job& job, AttemptVerdict verdict);
  [[nodiscard]] bool try_to_apply(const Ended& ended);
  void look_after_orphans();
  void conclude_orphan(const Job& job);
  void watch_disk();
  void watch(Attempt& attempt);
  void watch_job_disk(Attempt& attempt);
  void delete_old_jobs_when_due();
  void start(const Job& job);
  [[nodiscard]] WorkerCommand command_for(const Job& job) const;
  [[nodiscard]] bool head_waits_for_room(int free, const std::vector<std::string>& except);
  [[nodiscard]] int free_threads() const;
  [[nodiscard]] JobPaths paths(const Job& job) const;

  JobStore& store_;
  std::filesystem::path data_;
  ServiceLimits limits_;
  std::filesystem::path worker_;
  const QueueView& queue_;
  SchedulerBoard& board_;
  int cores_;

  std::list<Attempt> attempts_;
  std::list<Orphan> orphans_;
  std::vector<Ended> ended_;
  BackOffs back_offs_;
  bool disk_low_ = false;
  bool look_ = true;  ///< something may have changed that concerns the queue or stops
  double next_tick_ = 0.0;
  double next_deletion_ = 0.0;
  double draining_since_ = 0.0;
  std::string passed_over_;  ///< the queue's first job, while it does not fit
  double passed_over_since_ = 0.0;
};

}  // namespace sluice

#pragma once

#include <vector>

#include "service/jobs/job_store.hpp"
#include "service/scheduler/attempt_end.hpp"
#include "service/scheduler/back_offs.hpp"

namespace sluice {

/// How attempts ended, until the store has taken it, and when their jobs may be tried again. For
/// one thread.
class Conclusions {
 public:
  explicit Conclusions(JobStore& store) : store_(store) {}

  /// Applies the verdict; kept for the next retry() where the store cannot take it now. `now` is in
  /// seconds of the caller's clock.
  void conclude(const Job& job, AttemptVerdict verdict, double now);
  void retry();
  [[nodiscard]] bool all_taken() const { return waiting_.empty(); }
  [[nodiscard]] const BackOffs& back_offs() const { return back_offs_; }

 private:
  struct Conclusion {
    Job job;
    AttemptVerdict verdict;
  };
  /// True when the store took it, or never will.
  [[nodiscard]] bool is_settled(const Conclusion& conclusion);

  JobStore& store_;
  std::vector<Conclusion> waiting_;
  BackOffs back_offs_;
};

}  // namespace sluice

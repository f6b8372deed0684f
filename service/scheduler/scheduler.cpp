#include "service/scheduler/scheduler.hpp"

#include <fmt/format.h>

#include <cmath>
#include <thread>

#include "engine/sph/threads/new_thread.hpp"
#include "service/jobs/limits.hpp"
#include "service/jobs/queue_view.hpp"
#include "service/scheduler/scheduler_board.hpp"
#include "service/scheduler/scheduler_loop.hpp"

namespace sluice {
namespace {

std::string wait_text(const BackOffs::Wait& wait, double now) {
  const std::string_view why = wait.why == NextTry::after_crash
                                   ? "after its worker was lost"
                                   : "because its worker could not begin";
  return fmt::format("waits {:.0f} s {}", std::ceil(wait.until - now), why);
}

std::string ahead_text(std::size_t count) {
  return count == 1 ? "1 job with higher priority or age is ahead"
                    : fmt::format("{} jobs with higher priority or age are ahead", count);
}

}  // namespace

class Scheduler::Impl {
 public:
  Impl(JobStore& store, const std::filesystem::path& data, const ServiceLimits& limits,
       const std::filesystem::path& worker, const SchedulerSenses& senses, Executor& executor)
      : store_(store),
        limits_(limits),
        clock_(senses.clock),
        queue_(store),
        loop_(store, std::filesystem::absolute(data), limits, worker, senses, executor, queue_,
              board_),
        thread_(new_thread([this] {
          loop_.run();
          board_.note_drained();
        })) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    drain();
    thread_.join();
  }

  void poke() { board_.poke(); }
  void drain() {
    board_.ask_to_drain();
    board_.wait_until_drained();
  }

  bool checkpoint_now(const std::string& id) {
    const std::optional<Job> job = store_.find(id);
    if (!job || job->state != JobState::running) return false;
    board_.ask_for_checkpoint(id);
    return true;
  }

  [[nodiscard]] std::string why_waiting(const Job& job) const {
    if (job.state != JobState::queued) return {};
    if (board_.draining()) return "the service is draining";
    const SchedulerStatus status = board_.status();
    if (status.disk_low) {
      return fmt::format("the disk of the service has less than {} MiB free",
                         limits_.disk_reserve >> 20);
    }
    const double now = clock_();
    if (const auto wait = status.back_offs.find(job.id, now)) return wait_text(*wait, now);
    return place_text(job, status, now);
  }

  [[nodiscard]] std::optional<pid_t> worker_of(const Job& job) const {
    if (job.state != JobState::running) return {};
    const SchedulerStatus status = board_.status();
    const auto found = status.workers.find(job.id);
    return found == status.workers.end() ? std::nullopt : std::optional(found->second);
  }

  [[nodiscard]] const ServiceLimits& limits() const { return limits_; }

 private:
  [[nodiscard]] std::string place_text(const Job& job, const SchedulerStatus& status,
                                       double now) const {
    const int cores = thread_limit(limits_);
    if (job.threads > cores) {
      return fmt::format("needs {} threads, and this service has {}: it can never run here",
                         job.threads, cores);
    }
    const std::size_t ahead = queue_.ahead_of(job, now);
    if (ahead > 0) return ahead_text(ahead);
    if (job.threads > status.free_threads) {
      return fmt::format("needs {} thread{}, {} of {} {} free", job.threads,
                         job.threads == 1 ? "" : "s", status.free_threads, cores,
                         status.free_threads == 1 ? "is" : "are");
    }
    return "starts in a moment";
  }

  JobStore& store_;
  ServiceLimits limits_;
  std::function<double()> clock_;
  QueueView queue_;
  SchedulerBoard board_;
  SchedulerLoop loop_;
  std::thread thread_;
};

Scheduler::Scheduler(JobStore& store, const std::filesystem::path& data,
                     const ServiceLimits& limits, const std::filesystem::path& worker,
                     const SchedulerSenses& senses, Executor& executor)
    : impl_(std::make_unique<Impl>(store, data, limits, worker, senses, executor)) {}

Scheduler::~Scheduler() = default;

void Scheduler::poke() { impl_->poke(); }

void Scheduler::drain() { impl_->drain(); }

bool Scheduler::checkpoint_now(const std::string& id) { return impl_->checkpoint_now(id); }

std::string Scheduler::why_waiting(const Job& job) const { return impl_->why_waiting(job); }

std::optional<pid_t> Scheduler::worker_of(const Job& job) const { return impl_->worker_of(job); }

const ServiceLimits& Scheduler::limits() const { return impl_->limits(); }

}  // namespace sluice

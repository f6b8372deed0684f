#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace sluice {

/// A fixed team of threads for loops over independent tasks. Every task writes only its own
/// results, so that any number of threads gives the same bits. Each thread starts in its own part
/// of the range, for its cache's sake, and helps the others when done. Waiting spins for a bounded
/// time and then sleeps; a helper that has not woken is not waited for, so that a core taken by
/// another program costs that core and no more.
class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  [[nodiscard]] int size() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Calls body(task) for each task in [0, tasks); returns when all are done. Where one throws, for
  /// want of memory, one of the exceptions is thrown here after the rest.
  template <class Body>
  void run(std::size_t tasks, const Body& body) {
    if (helpers_.empty() || tasks < 2) {
      for (std::size_t task = 0; task < tasks; ++task) body(task);
      return;
    }
    run_shared(
        1, tasks, [](const void* b, std::size_t task) { (*static_cast<const Body*>(b))(task); },
        &body);
  }

  /// Calls first(task) for each task in [0, tasks), and second(task) for each, once first() is done
  /// for it and for those that needs(task) lists, all of them earlier tasks: whoever has no first
  /// left to take need not wait for the last of them, and what a first leaves in the cache is used
  /// from there where there is one thread. Returns when all are done; exceptions as in run().
  template <class First, class Needs, class Second>
  void run_both(std::size_t tasks, const First& first, const Needs& needs, const Second& second) {
    if (helpers_.empty() || tasks < 2) {
      for (std::size_t task = 0; task < tasks; ++task) {
        first(task);
        second(task);
      }
      return;
    }
    reset_firsts(tasks);
    const auto body = [&](std::size_t call) {
      if (call < tasks) {
        const Finish at_the_end{*this, call};  // also when it throws: others wait for it
        first(call);
        return;
      }
      // Firsts are taken before any second: those that are not done are at work.
      const std::size_t task = call - tasks;
      await_first(task);
      for (const std::size_t other : needs(task)) await_first(other);
      second(task);
    };
    using Body = decltype(body);
    run_shared(
        2, tasks, [](const void* b, std::size_t call) { (*static_cast<Body*>(b))(call); }, &body);
  }

 private:
  using Call = void (*)(const void* body, std::size_t task);
  struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t begin = 0;
    std::size_t end = 0;
    /// The share's tasks from its second to its first.
    [[nodiscard]] std::size_t rotated(std::size_t task) const {
      return task + 1 < end ? task + 1 : begin;
    }
  };

  struct Finish {
    ThreadTeam& team;
    std::size_t task;
    ~Finish() { team.finish_first(task); }
  };

  /// Calls call(body, n) for n in [0, rounds * tasks): each thread begins a round when nothing is
  /// left to take of the one before. The first of a share needs what the thread before does last,
  /// and so is last in a second round.
  void run_shared(std::size_t rounds, std::size_t tasks, Call call, const void* body);
  void work(std::size_t self);
  void help(std::size_t self);
  void keep_failure(std::exception_ptr failure);
  void end_helpers();

  void reset_firsts(std::size_t tasks);
  void finish_first(std::size_t task);
  void await_first(std::size_t task) const;

  // State word: epoch in the upper half, then one bit "open", then the number of helpers at work.
  static constexpr std::uint64_t kOpen = 1ULL << 16;
  static constexpr std::uint64_t kEpoch = 1ULL << 32;
  static constexpr std::uint64_t kAtWork = kOpen - 1;

  alignas(64) std::atomic<std::uint64_t> state_{0};
  std::atomic<bool> stop_{false};
  Call call_ = nullptr;
  const void* body_ = nullptr;
  std::size_t rounds_ = 1;
  std::mutex failing_;
  std::exception_ptr failure_;                                ///< of one of the tasks
  std::unique_ptr<Share[]> shares_;                           // of each round
  std::unique_ptr<std::atomic<std::uint64_t>[]> first_done_;  // of each task
  std::size_t first_count_ = 0;
  std::vector<std::thread> helpers_;
};

}  // namespace sluice

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
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

  /// Calls body(task) for each task in [0, tasks); returns when all are done. `body` must not
  /// throw.
  template <class Body>
  void run(std::size_t tasks, const Body& body) {
    if (helpers_.empty() || tasks < 2) {
      for (std::size_t task = 0; task < tasks; ++task) body(task);
      return;
    }
    run_shared(
        tasks, [](const void* b, std::size_t task) { (*static_cast<const Body*>(b))(task); },
        &body);
  }

 private:
  using Call = void (*)(const void* body, std::size_t task);
  struct alignas(64) Share {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  void run_shared(std::size_t tasks, Call call, const void* body);
  void work(std::size_t self);
  void help(std::size_t self);

  // State word: epoch in the upper half, then one bit "open", then the number of helpers at work.
  static constexpr std::uint64_t kOpen = 1ULL << 16;
  static constexpr std::uint64_t kEpoch = 1ULL << 32;
  static constexpr std::uint64_t kAtWork = kOpen - 1;

  alignas(64) std::atomic<std::uint64_t> state_{0};
  std::atomic<bool> stop_{false};
  Call call_ = nullptr;
  const void* body_ = nullptr;
  std::unique_ptr<Share[]> shares_;
  std::vector<std::thread> helpers_;
};

}  // namespace sluice

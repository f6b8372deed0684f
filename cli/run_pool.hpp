#pragma once

#include <csignal>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "engine/execute/executor.hpp"

namespace sluice {

/// Processes of an executor that each run a job, `sluice run FOLDER`, this very program, in a
/// process group of its own. While it lives, SIGTERM, SIGINT, SIGHUP (where not ignored at the
/// start), SIGTSTP and SIGCHLD are blocked and only seen by wait(); SIGPIPE is ignored from then
/// on. When the process dies, however it does, its runs write a checkpoint and stop; when a
/// terminal suspends it, they rest with it.
class RunPool {
 public:
  /// The executor outlives it. Its processes are children of this one: SIGCHLD tells of their end.
  explicit RunPool(Executor& executor);
  /// Asks what still runs to stop, and waits for it.
  ~RunPool();
  RunPool(const RunPool&) = delete;
  RunPool& operator=(const RunPool&) = delete;

  /// Starts a run; what it prints goes to `log`. Throws std::runtime_error when the system refuses.
  void start(std::size_t number, const std::filesystem::path& folder,
             const std::filesystem::path& log, int threads);
  [[nodiscard]] std::size_t running() const { return runs_.size(); }

  struct Ended {
    std::size_t number;
    int exit_code;  ///< 128 + the signal's number for one that was killed
  };
  /// Waits for a run to end, or for a stop to be asked: then it holds no value.
  [[nodiscard]] std::optional<Ended> wait();
  /// Passes a stop on: the runs write a checkpoint and end; asked again later than kSameWish
  /// (engine/run/stop_wish.hpp), they end at once.
  void stop_all() const;

 private:
  struct Run {
    std::size_t number;
    std::unique_ptr<RunningProcess> process;
  };
  std::optional<Ended> reap();
  void send(int signal) const;
  /// Suspends the runs and this process until it is continued.
  void rest() const;

  Executor& executor_;
  std::vector<Run> runs_;
  sigset_t watched_{};
  sigset_t before_{};
};

}  // namespace sluice

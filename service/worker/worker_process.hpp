#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"
#include "service/worker/sandbox.hpp"

namespace sluice {

/// What a worker is started with.
struct WorkerCommand {
  std::filesystem::path program;  ///< empty: this program
  std::vector<std::string> arguments;
  std::filesystem::path folder;     ///< of the job; its working directory
  std::string token;                ///< of the attempt; in its environment as kTokenVariable
  std::uint64_t address_space = 0;  ///< bytes; 0: no limit
  std::uint64_t largest_file = 0;   ///< bytes; 0: no limit
  Confinement confinement = Confinement::full;
};

/// The variable in a worker's environment that tells whose attempt it is.
inline constexpr const char* kTokenVariable = "SLUICE_ATTEMPT";

/// How a process ended: by exit with a code or by a signal.
struct WorkerEnd {
  int exit_code = -1;  ///< below 0: by the signal
  int signal = 0;      ///< 0: by exit
};

/// The system refused to start a worker.
class WorkerStartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A child process in a process group of its own. Its stdin is empty, its stdout and stderr are
/// pipes, every other descriptor is closed. SIGUSR1 is ignored until the program takes it, and the
/// program gets SIGTERM when the thread that started it ends. Not for several threads at once: the
/// one that makes it keeps it.
class WorkerProcess {
 public:
  /// Returns when the program runs. Throws WorkerStartError.
  explicit WorkerProcess(const WorkerCommand& command);
  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&&) = delete;
  /// Kills and reaps what still runs.
  ~WorkerProcess();

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Readable once the process ended; below 0 where the kernel has no such descriptors.
  [[nodiscard]] int end_descriptor() const { return end_.get(); }
  /// The pipes' reading ends, non-blocking.
  [[nodiscard]] int output() const { return output_.get(); }
  [[nodiscard]] int errors() const { return errors_.get(); }

  /// To the process alone; nothing once it was reaped.
  void send(int signal_number) const;
  /// SIGKILL to all of its group.
  void kill_group() const;
  /// How it ended, if it did; what it left of its group is killed. Not again after that.
  [[nodiscard]] std::optional<WorkerEnd> reap();

 private:
  pid_t pid_ = -1;
  FileDescriptor end_{-1};
  FileDescriptor output_{-1};
  FileDescriptor errors_{-1};
};

}  // namespace sluice

#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "engine/execute/process_command.hpp"

namespace sluice {

/// How a process ended: by exit with a code or by a signal.
struct ProcessEnd {
  int exit_code = -1;  ///< below 0: by the signal
  int signal = 0;      ///< 0: by exit
};

/// The system refused to start a process. what() says what it cannot do and why; code() is why.
class ProcessStartError : public std::system_error {
 public:
  using std::system_error::system_error;
};

/// A process that an executor has started, in a process group of its own. What still runs at the
/// end of its life is killed. Not for several threads at once: the one that started it keeps it.
class RunningProcess {
 public:
  RunningProcess() = default;
  RunningProcess(const RunningProcess&) = delete;
  RunningProcess& operator=(const RunningProcess&) = delete;
  virtual ~RunningProcess() = default;

  [[nodiscard]] virtual pid_t pid() const = 0;
  /// Readable once the process ended; below 0 where the system has no such descriptors.
  [[nodiscard]] virtual int end_descriptor() const = 0;
  /// Reading ends of its output, non-blocking; below 0 where it does not go into a pipe.
  [[nodiscard]] virtual int output() const = 0;
  [[nodiscard]] virtual int errors() const = 0;

  /// To the process alone; nothing once it was reaped.
  virtual void send(int signal_number) = 0;
  /// SIGKILL to all of its group.
  virtual void kill_group() = 0;
  /// How it ended, if it did; what it left of its group is killed. Not again after that.
  [[nodiscard]] virtual std::optional<ProcessEnd> reap() = 0;
};

/// Starts processes: on this machine (local_executor.hpp), or as another system has it. Tests put
/// their own in its place.
class Executor {
 public:
  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  virtual ~Executor() = default;

  /// Returns when the program runs. Throws ProcessStartError. `command` and the descriptors in it
  /// are not needed any more after that.
  [[nodiscard]] virtual std::unique_ptr<RunningProcess> start(const ProcessCommand& command) = 0;
  /// What Confinement::full lacks here, for a person; empty: nothing.
  [[nodiscard]] virtual std::string missing_confinement() const = 0;
};

}  // namespace sluice

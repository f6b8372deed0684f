#pragma once

namespace sluice {

/// What a process was asked to do from outside.
enum class Request { none, checkpoint, stop };

/// Turns signals into requests for as long as it lives: SIGUSR1 asks for a checkpoint; SIGTERM,
/// SIGINT and SIGHUP (where not ignored at the start) ask for a stop, and a second one ends the
/// process at once with 128 + its number. SIGPIPE and SIGXFSZ are ignored, so that a reader who
/// went away or a file size limit is an error of the write. One at a time per process; the previous
/// actions come back with the destructor.
class SignalRequests {
 public:
  SignalRequests();
  ~SignalRequests();
  SignalRequests(const SignalRequests&) = delete;
  SignalRequests& operator=(const SignalRequests&) = delete;

  /// The strongest request now. A checkpoint request is handed out once, a stop stays.
  [[nodiscard]] Request take();
  /// True once a stop was asked for; leaves requests in place.
  [[nodiscard]] bool stop_requested() const;
};

}  // namespace sluice

#pragma once

namespace sluice {

/// What a process was asked to do from outside.
enum class RunRequest { none, checkpoint, stop };

/// Turns signals into requests for as long as it lives: SIGUSR1 asks for a checkpoint; SIGTERM,
/// SIGINT and SIGHUP (where not ignored at the start) ask for a stop, and one that comes later than
/// kSameWish (stop_wish.hpp) ends the process at once with 128 + its number. SIGPIPE and SIGXFSZ
/// are ignored, so that a reader who went away or a file size limit is an error of the write. One
/// that is made while another lives shares its requests. The previous actions come back with the
/// last one's destructor. For one thread.
class SignalRequests {
 public:
  SignalRequests();
  ~SignalRequests();
  SignalRequests(const SignalRequests&) = delete;
  SignalRequests& operator=(const SignalRequests&) = delete;

  /// The strongest request now. A checkpoint request is handed out once, a stop stays.
  [[nodiscard]] RunRequest take();
  /// True once a stop was asked for; leaves requests in place.
  [[nodiscard]] bool stop_requested() const;
  /// The open file that is emptied before a signal ends the process at once: what it says of the
  /// process is no longer true then. For as long as this lives.
  void empty_when_ended_at_once(int descriptor);
};

}  // namespace sluice

#pragma once

namespace sluice {

/// Turns SIGTERM, SIGINT and SIGHUP into something to wait for, as long as it lives; a second one
/// ends the process at once with 128 + its number. SIGPIPE is ignored. Child processes get the
/// usual actions back when they start another program. One at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Returns when the first one has come.
  void wait() const;
};

}  // namespace sluice

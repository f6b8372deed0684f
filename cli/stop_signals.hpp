#pragma once

#include <vector>

namespace sluice {

/// Turns SIGTERM, SIGINT and SIGHUP (where not ignored at the start) into something to wait for, as
/// long as it lives; one that comes later than kSameWish (engine/run/stop_wish.hpp) ends the
/// process at once with 128 + its number. SIGPIPE is ignored. Child processes get the
/// usual actions back when they start another program. One at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Returns when the first one has come.
  void wait() const;

 private:
  std::vector<int> signals_;
};

}  // namespace sluice

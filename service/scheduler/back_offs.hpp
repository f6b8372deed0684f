#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "service/scheduler/attempt_end.hpp"

namespace sluice {

/// Queued jobs that are not tried again before some time, in seconds of the caller's clock. Kept in
/// memory only: a new service tries at once. For one thread; copies may be read by others.
class BackOffs {
 public:
  struct Wait {
    double until = 0.0;
    NextTry why = NextTry::at_once;
    int count = 0;  ///< such ends in a row
  };

  /// Notes how the last attempt ended. `crashes` in a row count for after_crash; other refusals are
  /// counted here.
  void note(const std::string& id, NextTry next, int crashes, double now);
  [[nodiscard]] std::vector<std::string> waiting(double now) const;
  /// How many attempts in a row ended so.
  [[nodiscard]] int count(const std::string& id, NextTry why) const;
  /// Nothing when the job need not wait.
  [[nodiscard]] std::optional<Wait> find(const std::string& id, double now) const;

 private:
  std::map<std::string, Wait> waits_;
};

}  // namespace sluice

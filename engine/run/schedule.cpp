#include "engine/run/schedule.hpp"

#include <cmath>

namespace sluice {

bool is_due(double time, double interval, std::uint64_t next_index) {
  return interval <= 0.0 || time >= static_cast<double>(next_index) * interval;
}

std::uint64_t next_index_after(double time, double interval, std::uint64_t next_index) {
  if (interval <= 0.0) return next_index + 1;
  // Beyond 2^53 a double no longer counts in ones.
  constexpr double kLargest = 9007199254740992.0;
  const double quotient = std::floor(time / interval);
  if (!(quotient < kLargest)) return static_cast<std::uint64_t>(kLargest);
  auto index = static_cast<std::uint64_t>(std::fmax(quotient, 0.0));
  // The quotient is rounded; the comparison of is_due decides.
  while (index > 0 && !is_due(time, interval, index)) --index;
  while (is_due(time, interval, index)) ++index;
  return index;
}

}  // namespace sluice

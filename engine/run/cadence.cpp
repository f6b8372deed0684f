#include "engine/run/cadence.hpp"

#include <algorithm>
#include <cmath>

namespace sluice {

double checkpoint_interval(double cost) {
  const double ideal = std::sqrt(2.0 * cost * kMeanTimeBetweenFailures) - cost;
  return std::max({2.0, 20.0 * cost, std::min(ideal, 60.0)});
}

double series_interval(double cost) { return std::max(1.0, 200.0 * cost); }

void Backoff::failed(double now) {
  if (failures_ == 0) first_failure_ = now;
  ++failures_;
  next_try_ = now + std::min(8.0, 0.5 * std::pow(2.0, failures_ - 1));
}

bool Backoff::exhausted() const { return failures_ > 0 && next_try_ > first_failure_ + patience_; }

}  // namespace sluice

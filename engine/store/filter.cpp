#include "engine/store/filter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sluice {
namespace {

double duration_of(const Series& series, std::size_t n) {
  if (n > 0) return series.duration[n];
  return series.size() > 1 ? series.duration[1] : 1.0;
}

struct Sums {
  double value = 0.0;   ///< sum of v_n exp(-R^2) Dt_n
  double weight = 0.0;  ///< sum of exp(-R^2) Dt_n, s
};

Sums sum_window(const Series& series, std::size_t column, double tau, std::size_t m,
                std::size_t first) {
  Sums sums;
  for (std::size_t n = first; n < series.size(); ++n) {
    const double ratio = (series.time[n] - series.time[m]) / tau;
    if (ratio >= kFilterReach) break;
    const double value = series.values[n * series.columns.size() + column];
    if (std::isnan(value)) continue;
    const double weight = std::exp(-ratio * ratio) * duration_of(series, n);
    sums.value += weight * value;
    sums.weight += weight;
  }
  return sums;
}

void require_filter_arguments(const Series& series, double tau, std::size_t column) {
  if (!(tau > 0.0) || !std::isfinite(tau)) {
    throw std::invalid_argument(
        fmt::format("the filter time tau is {}, but must be a positive number of seconds", tau));
  }
  if (column >= series.columns.size()) {
    throw std::invalid_argument(fmt::format("series {} has {} columns, no column {}", series.name,
                                            series.columns.size(), column));
  }
}

}  // namespace

Filtered gaussian_filter(const Series& series, double tau, std::size_t column) {
  require_filter_arguments(series, tau, column);
  Filtered filtered;
  filtered.value.reserve(series.size());
  filtered.weight.reserve(series.size());
  const double unit_integral = std::sqrt(std::numbers::pi) * tau;
  std::size_t first = 0;
  for (std::size_t m = 0; m < series.size(); ++m) {
    while ((series.time[m] - series.time[first]) / tau >= kFilterReach) ++first;
    const Sums sums = sum_window(series, column, tau, m, first);
    const bool wet = sums.weight > 0.0;
    filtered.value.push_back(wet ? sums.value / sums.weight
                                 : std::numeric_limits<double>::quiet_NaN());
    filtered.weight.push_back(wet ? sums.weight / unit_integral : 0.0);
  }
  return filtered;
}

double provisional_after(const Series& series, double tau) {
  if (series.time.empty()) return -std::numeric_limits<double>::infinity();
  return series.time.back() - kFilterReach * tau;
}

}  // namespace sluice

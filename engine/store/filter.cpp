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
  const std::size_t count = series.size();
  const auto value = [&](std::size_t n) {
    return series.values[n * series.columns.size() + column];
  };
  // The sums above and below the line, until the last loop.
  Filtered filtered{std::vector<double>(count), std::vector<double>(count)};
  const auto add = [&](std::size_t m, std::size_t n, double kernel) {
    if (std::isnan(value(n))) return;
    const double weight = kernel * duration_of(series, n);
    filtered.value[m] += weight * value(n);
    filtered.weight[m] += weight;
  };
  // One exponential serves a pair both ways; each sample still sums the others in their order.
  for (std::size_t m = 0; m < count; ++m) {
    add(m, m, 1.0);
    for (std::size_t n = m + 1; n < count; ++n) {
      const double ratio = (series.time[n] - series.time[m]) / tau;
      if (ratio >= kFilterReach) break;
      const double kernel = std::exp(-ratio * ratio);
      add(n, m, kernel);
      add(m, n, kernel);
    }
  }
  const double unit_integral = std::sqrt(std::numbers::pi) * tau;
  for (std::size_t m = 0; m < count; ++m) {
    const double weight = filtered.weight[m];
    const bool wet = weight > 0.0;
    filtered.value[m] = wet ? filtered.value[m] / weight : std::numeric_limits<double>::quiet_NaN();
    filtered.weight[m] = wet ? weight / unit_integral : 0.0;
  }
  return filtered;
}

double provisional_after(const Series& series, double tau) {
  if (series.time.empty()) return -std::numeric_limits<double>::infinity();
  return series.time.back() - kFilterReach * tau;
}

}  // namespace sluice

#include "engine/store/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
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

void require_together(const Series& first, const Series& other) {
  if (other.time != first.time || other.duration != first.duration) {
    throw std::invalid_argument(
        fmt::format("series {} and {} were not sampled together", first.name, other.name));
  }
}

/// One column of a few series, [samples, series], so that the loops over pairs of samples run along
/// memory: few enough to stay in the first cache with all samples of a window.
struct Block {
  static constexpr std::size_t kMost = 32;

  std::size_t width;
  std::vector<double> value;   ///< 0 where dry; then what the filter makes of it
  std::vector<double> wet;     ///< 1, or 0 where dry
  std::vector<double> sum;     ///< above the line of eq. 12
  std::vector<double> weight;  ///< below it

  Block(std::span<const Series* const> series, std::size_t column) : width(series.size()) {
    const std::size_t samples = series[0]->size();
    for (auto* a : {&value, &wet, &sum, &weight}) a->assign(samples * width, 0.0);
    for (std::size_t s = 0; s < width; ++s) {
      const std::size_t columns = series[s]->columns.size();
      for (std::size_t n = 0; n < samples; ++n) {
        const double found = series[s]->values[n * columns + column];
        if (std::isnan(found)) continue;
        value[n * width + s] = found;
        wet[n * width + s] = 1.0;
      }
    }
  }

  /// Adds the samples n, each with this weight, to the sums for m.
  void add(std::size_t m, std::size_t n, double of_sample) {
    double* const to = sum.data() + m * width;
    double* const below = weight.data() + m * width;
    const double* const values = value.data() + n * width;
    const double* const counts = wet.data() + n * width;
    for (std::size_t s = 0; s < width; ++s) {
      const double part = of_sample * counts[s];
      to[s] += part * values[s];
      below[s] += part;
    }
  }

  [[nodiscard]] Filtered result(std::size_t s, double tau) const {
    const double unit_integral = std::sqrt(std::numbers::pi) * tau;
    Filtered filtered;
    for (std::size_t at = s; at < sum.size(); at += width) {
      const bool any = weight[at] > 0.0;
      filtered.value.push_back(any ? sum[at] / weight[at]
                                   : std::numeric_limits<double>::quiet_NaN());
      filtered.weight.push_back(any ? weight[at] / unit_integral : 0.0);
    }
    return filtered;
  }
};

void sum_windows(const Series& times, double tau, Block& block) {
  const std::size_t count = times.size();
  // One exponential serves a pair both ways; each sample still sums the others in their order.
  for (std::size_t m = 0; m < count; ++m) {
    block.add(m, m, duration_of(times, m));
    for (std::size_t n = m + 1; n < count; ++n) {
      const double ratio = (times.time[n] - times.time[m]) / tau;
      if (ratio >= kFilterReach) break;
      const double kernel = std::exp(-ratio * ratio);
      block.add(n, m, kernel * duration_of(times, m));
      block.add(m, n, kernel * duration_of(times, n));
    }
  }
}

}  // namespace

std::vector<Filtered> gaussian_filter(std::span<const Series* const> together, double tau,
                                      std::size_t column) {
  for (const Series* const one : together) {
    require_filter_arguments(*one, tau, column);
    require_together(*together[0], *one);
  }
  std::vector<Filtered> all;
  for (std::size_t begin = 0; begin < together.size(); begin += Block::kMost) {
    const auto part = together.subspan(begin, std::min(Block::kMost, together.size() - begin));
    Block block(part, column);
    sum_windows(*together[0], tau, block);
    for (std::size_t s = 0; s < part.size(); ++s) all.push_back(block.result(s, tau));
  }
  return all;
}

Filtered gaussian_filter(const Series& series, double tau, std::size_t column) {
  const Series* const one = &series;
  return gaussian_filter({&one, 1}, tau, column).front();
}

double provisional_after(const Series& series, double tau) {
  if (series.time.empty()) return -std::numeric_limits<double>::infinity();
  return series.time.back() - kFilterReach * tau;
}

}  // namespace sluice

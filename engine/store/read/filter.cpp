#include "engine/store/read/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace sluice {
namespace {

double duration_of(const Series& series, std::size_t n) {
  if (n > 0) return series.duration[n];
  return series.size() > 1 ? series.duration[1] : 1.0;
}

void require_tau(double tau) {
  if (!(tau > 0.0) || !std::isfinite(tau)) {
    throw std::invalid_argument(
        fmt::format("the filter time tau is {}, but must be a positive number of seconds", tau));
  }
}

void require_column(const Series& series, std::size_t column) {
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
/// memory; few, so that what a window holds of them is soon met again in a cache.
class Block {
 public:
  static constexpr std::size_t kMost = 32;

  Block(std::span<const Series* const> series, std::size_t column) : width_(series.size()) {
    const std::size_t samples = series[0]->size();
    for (auto* a : {&raw_, &sum_, &weight_}) a->assign(samples * width_, 0.0);
    for (std::size_t s = 0; s < width_; ++s) {
      const std::size_t columns = series[s]->columns.size();
      for (std::size_t n = 0; n < samples; ++n) {
        const double value = series[s]->values[n * columns + column];
        raw_[n * width_ + s] = std::isnan(value) && series[s]->kind == "pressure" ? 0.0 : value;
      }
    }
  }

  /// Adds the samples n, each with this weight, to the sums for m.
  void add(std::size_t m, std::size_t n, double weight) {
    double* const above = sum_.data() + m * width_;
    double* const below = weight_.data() + m * width_;
    const double* const raw = raw_.data() + n * width_;
    for (std::size_t s = 0; s < width_; ++s) {
      const bool dry = std::isnan(raw[s]);
      above[s] += dry ? 0.0 : weight * raw[s];
      below[s] += dry ? 0.0 : weight;
    }
  }

  /// The quotients of the sums, by series.
  [[nodiscard]] std::vector<Filtered> take(double tau) {
    raw_ = {};
    const double unit_integral = std::sqrt(std::numbers::pi) * tau;
    for (std::size_t at = 0; at < sum_.size(); ++at) {
      const bool wet = weight_[at] > 0.0;
      sum_[at] = wet ? sum_[at] / weight_[at] : std::numeric_limits<double>::quiet_NaN();
      weight_[at] = wet ? weight_[at] / unit_integral : 0.0;
    }
    std::vector<Filtered> all(width_);
    if (width_ == 1) {
      all[0] = {std::move(sum_), std::move(weight_)};
      return all;
    }
    for (std::size_t s = 0; s < width_; ++s) {
      all[s].value.reserve(sum_.size() / width_);
      all[s].weight.reserve(sum_.size() / width_);
      for (std::size_t at = s; at < sum_.size(); at += width_) {
        all[s].value.push_back(sum_[at]);
        all[s].weight.push_back(weight_[at]);
      }
    }
    return all;
  }

 private:
  std::size_t width_;
  std::vector<double> raw_;
  std::vector<double> sum_;     // above the line of eq. 12
  std::vector<double> weight_;  // below it
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
  require_tau(tau);
  for (const Series* const one : together) {
    require_column(*one, column);
    require_together(*together[0], *one);
  }
  std::vector<Filtered> all;
  for (std::size_t begin = 0; begin < together.size(); begin += Block::kMost) {
    Block block(together.subspan(begin, std::min(Block::kMost, together.size() - begin)), column);
    sum_windows(*together[0], tau, block);
    for (Filtered& one : block.take(tau)) all.push_back(std::move(one));
  }
  return all;
}

Filtered gaussian_filter(const Series& series, double tau, std::size_t column) {
  const Series* const one = &series;
  return std::move(gaussian_filter({&one, 1}, tau, column).front());
}

double provisional_after(const Series& series, double tau) {
  if (series.time.empty()) return -std::numeric_limits<double>::infinity();
  return series.time.back() - kFilterReach * tau;
}

}  // namespace sluice

#include "engine/report/measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sluice {
namespace {

constexpr double kCrestReach = 0.4;
constexpr double kLeastRise = 1.15;

double value_at(const Curve& curve, double time) {
  const auto after = std::lower_bound(curve.time.begin(), curve.time.end(), time);
  if (after == curve.time.begin()) return curve.value.front();
  if (after == curve.time.end()) return curve.value.back();
  const auto i = static_cast<std::size_t>(after - curve.time.begin());
  const double share = (time - curve.time[i - 1]) / (curve.time[i] - curve.time[i - 1]);
  return curve.value[i - 1] + share * (curve.value[i] - curve.value[i - 1]);
}

/// Integral of the straight pieces over [from, to], which lies within the curve.
double integrate(const Curve& curve, double from, double to) {
  double sum = 0.0;
  double time = from;
  double value = value_at(curve, from);
  const auto next = std::upper_bound(curve.time.begin(), curve.time.end(), from);
  for (auto i = static_cast<std::size_t>(next - curve.time.begin());
       i < curve.size() && curve.time[i] < to; ++i) {
    sum += 0.5 * (value + curve.value[i]) * (curve.time[i] - time);
    time = curve.time[i];
    value = curve.value[i];
  }
  return sum + 0.5 * (value + value_at(curve, to)) * (to - time);
}

/// Sums of weighted terms over the intervals of a window; the sum is NaN when a term is.
template <typename Term>
std::optional<double> sum_over(const Intervals& intervals, Window window, const Term& term) {
  double sum = 0.0;
  bool any = false;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    if (!window.contains(intervals.centers()[k])) continue;
    sum += intervals.width(k) * term(k);
    any = true;
  }
  if (!any || std::isnan(sum)) return std::nullopt;
  return sum;
}

std::optional<double> total_width(const Intervals& intervals, Window window) {
  return sum_over(intervals, window, [](std::size_t) { return 1.0; });
}

std::optional<double> squared_difference(const Intervals& intervals, std::span<const double> a,
                                         std::span<const double> b, Window window) {
  return sum_over(intervals, window, [&](std::size_t k) { return (a[k] - b[k]) * (a[k] - b[k]); });
}

double highest(const Curve& curve, Window window) {
  double result = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (window.contains(curve.time[i])) result = std::max(result, curve.value[i]);
  }
  return result;
}

}  // namespace

Intervals::Intervals(std::vector<double> centers) : centers_(std::move(centers)) {
  if (centers_.size() < 2) throw std::invalid_argument("intervals need at least two times");
  for (std::size_t k = 1; k < centers_.size(); ++k) {
    if (!(centers_[k - 1] < centers_[k])) {
      throw std::invalid_argument("the times of intervals must increase strictly");
    }
    edges_.push_back(0.5 * (centers_[k - 1] + centers_[k]));
  }
  edges_.insert(edges_.begin(), 2.0 * centers_.front() - edges_.front());
  edges_.push_back(2.0 * centers_.back() - edges_.back());
}

std::vector<double> interval_averages(const Curve& curve, const Intervals& intervals) {
  std::vector<double> averages(intervals.size(), std::numeric_limits<double>::quiet_NaN());
  if (curve.size() == 0) return averages;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const double from = std::max(intervals.begin(k), curve.time.front());
    const double to = intervals.end(k);
    if (from < to && to <= curve.time.back()) {
      averages[k] = integrate(curve, from, to) / (to - from);
    }
  }
  return averages;
}

std::optional<double> relative_l2(const Intervals& intervals, std::span<const double> simulated,
                                  std::span<const double> reference, Window window) {
  const auto difference = squared_difference(intervals, simulated, reference, window);
  const auto scale =
      sum_over(intervals, window, [&](std::size_t k) { return reference[k] * reference[k]; });
  if (!difference || !scale || *scale == 0.0) return std::nullopt;
  return std::sqrt(*difference / *scale);
}

std::optional<double> rms_difference(const Intervals& intervals, std::span<const double> simulated,
                                     std::span<const double> reference, Window window) {
  const auto difference = squared_difference(intervals, simulated, reference, window);
  if (!difference) return std::nullopt;
  return std::sqrt(*difference / *total_width(intervals, window));
}

std::optional<double> integral(const Intervals& intervals, std::span<const double> values,
                               Window window) {
  return sum_over(intervals, window, [&](std::size_t k) { return values[k]; });
}

std::optional<double> mean(const Intervals& intervals, std::span<const double> values,
                           Window window) {
  const auto sum = integral(intervals, values, window);
  if (!sum) return std::nullopt;
  return *sum / *total_width(intervals, window);
}

std::optional<double> first_passage(const Curve& curve, double level, double from) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve.time[i] < from || curve.value[i] < level) continue;
    if (i == 0) return curve.time.front();
    if (curve.value[i - 1] >= level) return from;
    const double share = (level - curve.value[i - 1]) / (curve.value[i] - curve.value[i - 1]);
    return std::max(curve.time[i - 1] + share * (curve.time[i] - curve.time[i - 1]), from);
  }
  return std::nullopt;
}

std::optional<Peak> peak(const Curve& curve, Window window) {
  if (curve.size() == 0 || curve.time.front() > window.from || curve.time.back() < window.to) {
    return std::nullopt;
  }
  std::optional<Peak> best;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (!window.contains(curve.time[i])) continue;
    if (!best || curve.value[i] > best->value) best = Peak{curve.time[i], curve.value[i]};
  }
  return best;
}

std::optional<Rise> second_rise(const Intervals& intervals, std::span<const double> values,
                                const RiseWindows& windows) {
  const auto base = mean(intervals, values, windows.base);
  if (!base || !integral(intervals, values, windows.rise)) return std::nullopt;
  Curve curve;
  curve.time.assign(intervals.centers().begin(), intervals.centers().end());
  curve.value.assign(values.begin(), values.end());
  const double top = highest(curve, windows.rise);
  if (top < kLeastRise * *base) return std::nullopt;
  const auto start = first_passage(curve, 0.5 * (*base + top), windows.rise.from);
  if (!start) return std::nullopt;
  const double crest = highest(curve, {*start, std::min(*start + kCrestReach, windows.rise.to)});
  const auto time = first_passage(curve, *base + 0.9 * (crest - *base), *start);
  if (!time) return std::nullopt;
  return Rise{*time, crest, *base};
}

}  // namespace sluice

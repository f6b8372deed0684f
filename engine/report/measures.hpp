#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace sluice {

/// A function of time known at points, linear between them; all dimensionless (eqs. 19-22). `time`
/// increases strictly and has as many entries as `value`; both are finite.
struct Curve {
  std::vector<double> time;
  std::vector<double> value;

  [[nodiscard]] std::size_t size() const { return time.size(); }
};

/// A stretch of time, from < T < to.
struct Window {
  double from = 0.0;
  double to = 0.0;
  [[nodiscard]] bool contains(double time) const { return from < time && time < to; }
};

/// The times that a figure is tabulated at, each standing for the interval up to half way to its
/// neighbours; the first and the last interval are symmetric about their time.
class Intervals {
 public:
  /// At least two strictly increasing times, else std::invalid_argument.
  explicit Intervals(std::vector<double> centers);

  [[nodiscard]] std::size_t size() const { return centers_.size(); }
  [[nodiscard]] std::span<const double> centers() const { return centers_; }
  [[nodiscard]] double begin(std::size_t k) const { return edges_[k]; }
  [[nodiscard]] double end(std::size_t k) const { return edges_[k + 1]; }
  [[nodiscard]] double width(std::size_t k) const { return end(k) - begin(k); }

 private:
  std::vector<double> centers_;
  std::vector<double> edges_;
};

/// The time average of `curve` over each interval: the integral of its straight pieces over the
/// width. An interval that begins before the curve is cut to where the curve begins; one that holds
/// none of it or goes on after its end is NaN.
[[nodiscard]] std::vector<double> interval_averages(const Curve& curve, const Intervals& intervals);

/// What follows takes values per interval and uses the intervals whose centre lies in the window.
/// Each returns nothing when the window holds no interval or a value in it is NaN.

/// sqrt(sum w (s - r)^2 / sum w r^2), w the widths: the relative L2 distance from `reference`.
[[nodiscard]] std::optional<double> relative_l2(const Intervals& intervals,
                                                std::span<const double> simulated,
                                                std::span<const double> reference, Window window);
/// sqrt(sum w (s - r)^2 / sum w), in the unit of the values.
[[nodiscard]] std::optional<double> rms_difference(const Intervals& intervals,
                                                   std::span<const double> simulated,
                                                   std::span<const double> reference,
                                                   Window window);
/// sum w v: the impulse, for a pressure.
[[nodiscard]] std::optional<double> integral(const Intervals& intervals,
                                             std::span<const double> values, Window window);
/// sum w v / sum w.
[[nodiscard]] std::optional<double> mean(const Intervals& intervals, std::span<const double> values,
                                         Window window);

/// The time at which the curve first comes up to `level` at or after `from`, between two points by
/// their straight line; nothing when it never does.
[[nodiscard]] std::optional<double> first_passage(const Curve& curve, double level, double from);

struct Peak {
  double time = 0.0;
  double value = 0.0;
};
/// The highest point in the window, the first of equals; nothing unless the curve spans the window.
[[nodiscard]] std::optional<Peak> peak(const Curve& curve, Window window);

/// The pressure rise that the falling roller causes (about T = 6 in the experiment).
struct Rise {
  double time = 0.0;    ///< passage of 90 % of the way from base to crest
  double height = 0.0;  ///< crest
  double base = 0.0;    ///< level before the rise
};

/// Where a second rise is looked for.
struct RiseWindows {
  Window base;  ///< before it
  Window rise;
};

/// Found on the averages over intervals, so that experiment and simulation are resolved alike:
/// base, the mean over its window; start, the first passage of half the way from base to the
/// highest value in the rise's window; crest, the highest value from the start to 0.4 after it;
/// time, the first passage of base + 0.9 (crest - base). Nothing when the values do not cover both
/// windows or stay below 1.15 times the base.
[[nodiscard]] std::optional<Rise> second_rise(const Intervals& intervals,
                                              std::span<const double> values,
                                              const RiseWindows& windows);

}  // namespace sluice

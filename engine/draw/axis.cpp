#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/draw/chart.hpp"

namespace sluice {
namespace {

/// 1, 2 or 5 times a power of ten, at least span / wanted.
double nice_step(double span, int wanted) {
  const double least = span / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

std::vector<double> logarithmic_ticks(const Axis& axis) {
  const double span = axis.high / axis.low;
  std::vector<double> places;
  const int first = static_cast<int>(std::floor(std::log10(axis.low)));
  const int last = static_cast<int>(std::ceil(std::log10(axis.high)));
  for (int power = first; power <= last; ++power) {
    for (const double factor : {1.0, 2.0, 3.0, 4.0, 5.0, 7.0}) {
      // The wider the axis, the fewer stand between two powers of ten.
      const bool wanted =
          factor == 1.0 || (span < 300.0 && (factor == 2.0 || factor == 5.0)) || span < 12.0;
      const double place = factor * std::pow(10.0, power);
      const bool inside = place >= axis.low * (1 - 1e-9) && place <= axis.high * (1 + 1e-9);
      if (inside && wanted) places.push_back(place);
    }
  }
  return places;
}

void fit_logarithmic(Axis& axis, double low, double high) {
  // A little room on both sides: marks on the frame are hard to read.
  axis.low = low / 1.25;
  axis.high = high * 1.25;
  if (axis.high / axis.low >= 4.0) return;
  const double middle = std::sqrt(axis.low * axis.high);
  axis.low = middle / 2.0;
  axis.high = middle * 2.0;
}

/// An axis spans at least this share of the values on it.
constexpr double kLeastSpan = 0.1;

}  // namespace

std::vector<double> ticks(const Axis& axis, int wanted) {
  if (axis.scale == AxisScale::logarithmic) return logarithmic_ticks(axis);
  const double step = nice_step(axis.high - axis.low, wanted);
  std::vector<double> places;
  const double first = std::ceil(axis.low / step - 1e-9);
  for (int n = 0; n < 10 * wanted; ++n) {
    const double place = (first + n) * step;
    if (place > axis.high + 1e-9 * step) break;
    places.push_back(place);
  }
  return places;
}

std::string tick_text(double value) {
  if (std::abs(value) < 1e-12) return "0";
  const double size = std::abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
    const double factor = value / std::pow(10.0, power);
    return std::abs(factor - 1.0) < 1e-9 ? fmt::format("1e{}", power)
                                         : fmt::format("{:.3g}e{}", factor, power);
  }
  return fmt::format("{:.6g}", value);
}

void hold_axis(Axis& axis, const std::vector<double>& values) {
  double low = INFINITY;
  double high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low < high)) return fit_axis(axis, values);
  axis.low = low;
  axis.high = high;
}

void fit_axis(Axis& axis, const std::vector<double>& values) {
  const bool logarithmic = axis.scale == AxisScale::logarithmic;
  double low = INFINITY;
  double high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0.0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) {
    low = logarithmic ? 0.1 : 0.0;
    high = 1.0;
  }
  if (logarithmic) return fit_logarithmic(axis, low, high);
  if (low > 0.0 && low < 0.5 * high) low = 0.0;
  // What hardly changes is drawn so: a twentieth of the value fills half of the height.
  const double least = kLeastSpan * std::max(std::abs(low), std::abs(high));
  if (high - low < least) {
    const double middle = 0.5 * (low + high);
    low = middle - 0.5 * least;
    high = middle + 0.5 * least;
  }
  const double room = high > low ? 0.02 * (high - low) : 0.5 * std::max(std::abs(high), 1e-9);
  const double step = nice_step(high - low + 2.0 * room, 6);
  axis.low = low == 0.0 ? 0.0 : std::floor((low - room) / step) * step;
  axis.high = std::ceil((high + room) / step - 1e-9) * step;
}

}  // namespace sluice

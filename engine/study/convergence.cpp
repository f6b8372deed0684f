#include "engine/study/convergence.hpp"

#include <cmath>

namespace sluice {
namespace {

constexpr double kSafety = 1.25;

/// p ln r21 - ln(e32/e21) - ln((r21^p - 1)/(r32^p - 1)); rises with p.
double residual(double p, double e_ratio, double r21, double r32) {
  return p * std::log(r21) - std::log(e_ratio) -
         std::log((std::pow(r21, p) - 1.0) / (std::pow(r32, p) - 1.0));
}

/// By bisection between orders that no scheme goes beyond.
std::optional<double> solve_order(double e_ratio, double r21, double r32) {
  double low = 1e-3;
  double high = 30.0;
  if (residual(low, e_ratio, r21, r32) > 0.0 || residual(high, e_ratio, r21, r32) < 0.0) {
    return std::nullopt;
  }
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = 0.5 * (low + high);
    (residual(middle, e_ratio, r21, r32) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::string_view to_string(Approach approach) {
  switch (approach) {
    case Approach::monotone:
      return "monotone";
    case Approach::oscillating:
      return "oscillating";
    case Approach::diverging:
      return "diverging";
    case Approach::settled:
      return "settled";
  }
  return "?";
}

std::optional<Richardson> richardson(std::span<const Refined> points) {
  if (points.size() < 3) return std::nullopt;
  const double e21 = points[1].value - points[0].value;
  const double e32 = points[2].value - points[1].value;
  const double r21 = points[1].spacing / points[0].spacing;
  const double r32 = points[2].spacing / points[1].spacing;
  Richardson result;
  if (e21 == 0.0) {
    result.approach = Approach::settled;
    return result;
  }
  if (e32 / e21 <= 0.0) {
    result.approach = Approach::oscillating;
    return result;
  }
  result.order = solve_order(e32 / e21, r21, r32);
  if (!result.order) {
    result.approach = Approach::diverging;
    return result;
  }
  const double factor = std::pow(r21, *result.order) - 1.0;
  result.extrapolated = points[0].value - e21 / factor;
  if (points[0].value != 0.0) {
    result.gci = kSafety * std::abs(e21 / points[0].value) / factor;
  }
  return result;
}

std::optional<double> order_of_errors(std::span<const Refined> points) {
  if (points.size() < 2) return std::nullopt;
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Refined& point : points) {
    if (!(point.spacing > 0.0) || !(point.value > 0.0)) return std::nullopt;
    const double lx = std::log(point.spacing);
    const double ly = std::log(point.value);
    x += lx;
    y += ly;
    xx += lx * lx;
    xy += lx * ly;
  }
  const auto n = static_cast<double>(points.size());
  const double spread = xx - x * x / n;
  if (!(spread > 0.0)) return std::nullopt;
  return (xy - x * y / n) / spread;
}

}  // namespace sluice

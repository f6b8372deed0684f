#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace sluice {

/// One quantity at one spacing.
struct Refined {
  double spacing = 0.0;
  double value = 0.0;
};

enum class Approach {
  monotone,     ///< differences shrink and keep their sign: order and extrapolation hold
  oscillating,  ///< differences change sign
  diverging,    ///< differences grow: the spacings are not in the range where an order shows
  settled,      ///< the two finest values are equal
};
[[nodiscard]] std::string_view to_string(Approach approach);

/// What three spacings say of a quantity (Roache 1994; Celik et al., J. Fluids Eng. 130 (2008)
/// 078001). Order and extrapolation only where the approach is monotone.
struct Richardson {
  Approach approach = Approach::monotone;
  std::optional<double> order;         ///< p of value = limit + a spacing^p
  std::optional<double> extrapolated;  ///< the limit
  std::optional<double>
      gci;  ///< grid convergence index of the finest, relative, safety factor 1.25
};

/// From the three finest of the points, which are sorted by spacing, the finest first. Any ratios
/// above 1: p solves p ln r21 = ln(e32/e21) + ln((r21^p - 1)/(r32^p - 1)). Nothing for fewer
/// points.
[[nodiscard]] std::optional<Richardson> richardson(std::span<const Refined> points);

/// Slope of the straight line through (ln spacing, ln error) by least squares: the order, where the
/// error is against the truth. Nothing for fewer than two points or errors that are not positive.
[[nodiscard]] std::optional<double> order_of_errors(std::span<const Refined> points);

}  // namespace sluice

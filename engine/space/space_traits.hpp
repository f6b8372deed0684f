#pragma once

#include <array>
#include <numbers>
#include <string_view>

namespace sluice {

/// The axis that points up, in every number of dimensions: y. Rows of a lattice run along x.
inline constexpr int kUpAxis = 1;

/// What follows from the number of dimensions by counting.
template <int Dim>
struct CountedTraits {
  /// Sides of an axis-aligned box.
  static constexpr int box_sides = 2 * Dim;
  /// Trace of sum_j V_j x_ij (grad W_ij)^T inside the fluid: that of the unit matrix, d.
  static constexpr double trace_inside = Dim;
};

/// All numbers and words that differ from one number of dimensions to the next.
///
/// Norms are those of W = norm h^-d w(R), R = |x|/h, whose integral over space is 1:
/// * `gaussian_norm` of w = exp(-R^2): pi^(-d/2), eq. 6.
/// * `wendland_c2_norm` of w = (1 - R/2)^4 (2R + 1), R < 2 (Wendland 1995), times pi: a short
///   fraction, so that a norm can be multiplied by 1/pi or divided by pi.
///
/// In the plane everything counts per metre of depth, and the units say so.
template <int Dim>
struct SpaceTraits;

template <>
struct SpaceTraits<2> : CountedTraits<2> {
  static constexpr std::array<std::string_view, 2> axis_names{"x", "y"};
  static constexpr std::array<int, 1> floor_axes{0};     ///< all but kUpAxis
  static constexpr double unit_ball = std::numbers::pi;  ///< measure of the ball of radius 1
  static constexpr double gaussian_norm = std::numbers::inv_pi;
  static constexpr double pi_times_wendland_c2_norm = 7.0 / 4.0;
  static constexpr std::string_view measure_unit = "m^2";
  static constexpr std::string_view mass_unit = "kg/m";
  static constexpr std::string_view energy_unit = "J/m";
};

template <>
struct SpaceTraits<3> : CountedTraits<3> {
  static constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};
  static constexpr std::array<int, 2> floor_axes{0, 2};
  static constexpr double unit_ball = 4.0 / 3.0 * std::numbers::pi;
  static constexpr double gaussian_norm = std::numbers::inv_pi * std::numbers::inv_sqrtpi;
  static constexpr double pi_times_wendland_c2_norm = 21.0 / 16.0;
  static constexpr std::string_view measure_unit = "m^3";
  static constexpr std::string_view mass_unit = "kg";
  static constexpr std::string_view energy_unit = "J";
};

/// factor x^power, multiplied from the left: ((factor x) x) ... The order is part of the result.
[[nodiscard]] constexpr double times_power(double factor, double x, int power) {
  for (int k = 0; k < power; ++k) factor *= x;
  return factor;
}
template <int Power>
[[nodiscard]] constexpr double times_power(double factor, double x) {
  return times_power(factor, x, Power);
}

/// Measure of a lattice's cell: spacing^d.
template <int Dim>
[[nodiscard]] constexpr double cell_measure(double spacing) {
  return times_power<Dim>(1.0, spacing);
}

/// How many points of a lattice lie within a distance of one of them, itself included: the measure
/// of the ball over that of a cell. `distance` in spacings.
template <int Dim>
[[nodiscard]] constexpr double points_within(double distance) {
  return times_power<Dim>(SpaceTraits<Dim>::unit_ball, distance);
}

}  // namespace sluice

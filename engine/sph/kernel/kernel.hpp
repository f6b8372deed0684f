#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/space/space_traits.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// Smoothing function W(R, h), R = |x_ij| / h.
enum class KernelKind {
  truncated_gaussian,  ///< eq. 6: pi^(-d/2) h^-d exp(-R^2), R < 3
  wendland_c2,         ///< norm h^-d (1 - R/2)^4 (2R + 1), R < 2; 7/(4 pi) in the plane
};

/// Smoothing functions in d dimensions, dimensionless: W = value(R^2) / h^d and grad W_ij =
/// -slope(R^2) x_ij / h^(d+2), both zero beyond `support` smoothing lengths. The pair sums use
/// vector versions of the same shapes.
template <int Dim>
struct TruncatedGaussianN {
  static constexpr double support = 3.0;
  static constexpr double value_scale = SpaceTraits<Dim>::gaussian_norm;
  static constexpr double slope_scale = 2.0 * value_scale;

  /// eq. 6. Cut, not renormalised: the integral over the plane is 1 - e^-9.
  [[nodiscard]] static double value(double r_sq) {
    return r_sq < support * support ? value_scale * std::exp(-r_sq) : 0.0;
  }
  [[nodiscard]] static double slope(double r_sq) { return 2.0 * value(r_sq); }
};

/// Wendland C2 (Wendland 1995).
template <int Dim>
struct WendlandC2N {
  static constexpr double support = 2.0;
  static constexpr double value_scale =
      SpaceTraits<Dim>::pi_times_wendland_c2_norm * std::numbers::inv_pi;
  static constexpr double slope_scale =
      5.0 * SpaceTraits<Dim>::pi_times_wendland_c2_norm * std::numbers::inv_pi;

  [[nodiscard]] static double value(double r_sq) {
    const double r = std::sqrt(r_sq);
    const double rest = std::max(1.0 - 0.5 * r, 0.0);
    return value_scale * rest * rest * rest * rest * (2.0 * r + 1.0);
  }
  [[nodiscard]] static double slope(double r_sq) {
    const double rest = std::max(1.0 - 0.5 * std::sqrt(r_sq), 0.0);
    return slope_scale * rest * rest * rest;
  }
};

/// Distance at which W becomes zero, in smoothing lengths.
[[nodiscard]] inline double kernel_support(KernelKind kind) {
  return kind == KernelKind::truncated_gaussian ? TruncatedGaussianN<kMostDim>::support
                                                : WendlandC2N<kMostDim>::support;
}

/// value(R^2) of the kernel that a method names.
template <int Dim>
[[nodiscard]] double kernel_value(KernelKind kind, double r_sq) {
  return kind == KernelKind::truncated_gaussian ? TruncatedGaussianN<Dim>::value(r_sq)
                                                : WendlandC2N<Dim>::value(r_sq);
}

/// slope(R^2) of the kernel that a method names.
template <int Dim>
[[nodiscard]] double kernel_slope(KernelKind kind, double r_sq) {
  return kind == KernelKind::truncated_gaussian ? TruncatedGaussianN<Dim>::slope(r_sq)
                                                : WendlandC2N<Dim>::slope(r_sq);
}

/// The constant of value(R^2).
template <int Dim>
[[nodiscard]] double kernel_value_scale(KernelKind kind) {
  return kind == KernelKind::truncated_gaussian ? TruncatedGaussianN<Dim>::value_scale
                                                : WendlandC2N<Dim>::value_scale;
}

/// The constant of slope(R^2).
template <int Dim>
[[nodiscard]] double kernel_slope_scale(KernelKind kind) {
  return kind == KernelKind::truncated_gaussian ? TruncatedGaussianN<Dim>::slope_scale
                                                : WendlandC2N<Dim>::slope_scale;
}

}  // namespace sluice

#pragma once

#include <Eigen/Core>

namespace sluice {

/// Number of space dimensions d of a scene. Types without a dimension of their own have this one.
inline constexpr int kDim = 2;

/// A vector in `Dim` dimensions; SI units of whatever it holds.
template <int Dim>
using VecN = Eigen::Matrix<double, Dim, 1>;

/// An axis-aligned box [min, max] in `Dim` dimensions, m.
template <int Dim>
struct BoxN {
  VecN<Dim> min = VecN<Dim>::Zero();
  VecN<Dim> max = VecN<Dim>::Zero();

  /// Whether a point lies in the box or on its faces.
  [[nodiscard]] bool contains(const VecN<Dim>& point) const {
    return (point.array() >= min.array()).all() && (point.array() <= max.array()).all();
  }
  [[nodiscard]] VecN<Dim> size() const { return max - min; }
  [[nodiscard]] VecN<Dim> middle() const { return 0.5 * (min + max); }
  /// Widens the box until it contains a point.
  void take_in(const VecN<Dim>& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
};

/// The box with a margin on all sides, m; less on all sides where it is negative.
template <int Dim>
[[nodiscard]] BoxN<Dim> grown(BoxN<Dim> box, double margin) {
  box.min.array() -= margin;
  box.max.array() += margin;
  return box;
}

/// Whether two boxes have a point in common.
template <int Dim>
[[nodiscard]] bool overlap(const BoxN<Dim>& one, const BoxN<Dim>& other) {
  return (one.min.array() <= other.max.array()).all() &&
         (one.max.array() >= other.min.array()).all();
}

using Vec = VecN<kDim>;
using Box = BoxN<kDim>;

}  // namespace sluice

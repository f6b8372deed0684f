#pragma once

#include <Eigen/Core>
#include <limits>

namespace sluice {

/// In place of a number of dimensions: two or three, as the values themselves tell. What runs,
/// files and reports hold is of a scene, whose dimensions are known when it is read.
inline constexpr int kAnyDim = Eigen::Dynamic;
inline constexpr int kMostDim = 3;
/// Dimensions of what nothing was said about.
inline constexpr int kPlaneDim = 2;

/// A vector in `Dim` dimensions; SI units of whatever it holds.
template <int Dim>
using VecN = Eigen::Matrix<double, Dim, 1, 0, Dim == kAnyDim ? kMostDim : Dim, 1>;

/// The same number along each axis; of `dimensions` where the type does not say how many.
template <int Dim>
[[nodiscard]] VecN<Dim> filled_vec(double value, int dimensions = kPlaneDim) {
  return VecN<Dim>::Constant(Dim == kAnyDim ? dimensions : Dim, value);
}

/// An axis-aligned box [min, max] in `Dim` dimensions, m.
template <int Dim>
struct BoxN {
  VecN<Dim> min = filled_vec<Dim>(0.0);
  VecN<Dim> max = filled_vec<Dim>(0.0);

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

  /// The same box; an `Other` that says its dimensions has to be of as many.
  template <int Other>
  operator BoxN<Other>() const {  // NOLINT(google-explicit-constructor)
    return {min, max};
  }

  /// All of space.
  [[nodiscard]] static BoxN everywhere(int dimensions = kPlaneDim) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {filled_vec<Dim>(-kFar, dimensions), filled_vec<Dim>(kFar, dimensions)};
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

/// Of a scene's dimensions.
using Vec = VecN<kAnyDim>;
using Box = BoxN<kAnyDim>;
/// Of the plane.
using Vec2 = VecN<2>;
using Box2 = BoxN<2>;
using Vec3 = VecN<3>;

/// Calls f<2>() or f<3>().
template <class F>
decltype(auto) in_dimensions(int dimensions, const F& f) {
  return dimensions == 3 ? f.template operator()<3>() : f.template operator()<2>();
}

[[nodiscard]] inline int dimensions_of(const Vec& vector) {
  return static_cast<int>(vector.size());
}
[[nodiscard]] inline int dimensions_of(const Box& box) { return dimensions_of(box.min); }

}  // namespace sluice

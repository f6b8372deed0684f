#pragma once

#include <Eigen/Core>

namespace sluice {

/// Number of space dimensions d. Everything that depends on it names this constant.
inline constexpr int kDim = 2;

/// A vector in space; SI units of whatever it holds.
using Vec = Eigen::Matrix<double, kDim, 1>;

/// An axis-aligned box [min, max], m.
struct Box {
  Vec min = Vec::Zero();
  Vec max = Vec::Zero();

  [[nodiscard]] bool contains(const Vec& point) const {
    return (point.array() >= min.array()).all() && (point.array() <= max.array()).all();
  }
  [[nodiscard]] Vec size() const { return max - min; }
};

}  // namespace sluice

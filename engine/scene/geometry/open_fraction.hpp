#pragma once

#include <optional>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// How much of the kernel around a point is open to fluid and air: inside the tank or above its
/// rim, and in no obstacle. A half on a wall, a quarter in a corner, 1 far from both.
class OpenFraction {
 public:
  /// `h` is the smoothing length of the sum, m. The kernel's integral is taken over spheres and
  /// rays, to half a percent, and whatever dummy particles stand there.
  OpenFraction(const Scene& scene, const Vec& point, double h);

  /// Dimensionless, 0 to 1; grows while a gate is lifted out of the kernel. `time` in s.
  [[nodiscard]] double at(double time) const;

 private:
  template <int Dim>
  void integrate(const Scene& scene, const VecN<Dim>& point, double h);

  struct Held {
    Vec place;
    double weight;
  };
  double without_gate_ = 0.0;
  std::optional<GateMotion> gate_;
  std::vector<Held> held_;  // by the gate, until it has passed
};

}  // namespace sluice

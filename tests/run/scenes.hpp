#pragma once

#include <string>

#include "engine/scene/model/scene.hpp"

namespace sluice::testing {

/// What a test varies of the small dam break.
struct SmallScene {
  std::string integrator = "modified_leap_frog";
  std::string precision = "mixed";
  double courant = 0.25;
  double end_time = 0.2;  ///< s; the front meets the wall at about 0.12 s
  bool viscous = true;    ///< artificial viscosity and density diffusion
  bool frames = false;
};

/// A column of 0.15 m x 0.15 m in a tank of 0.4 m x 0.3 m, 400 particles, every kind of sensor.
[[nodiscard]] Scene small_dam_break(const SmallScene& choice = {});

}  // namespace sluice::testing

#pragma once

#include <optional>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// A scene as it is written: beside the scene's own values, those from which others are derived
/// when they are left out. `scene.method` holds no derived value until resolve() fills it in.
struct WrittenScene {
  Scene scene;
  std::optional<int> dimensions;          ///< where the scene says it, as one of space does
  std::optional<Vec> gravity;             ///< m/s^2
  std::optional<Box> domain;              ///< m
  std::optional<double> sound_speed;      ///< m/s
  std::optional<double> smoothing_ratio;  ///< h/dx

  /// With the numerics of this scheme.
  explicit WrittenScene(std::optional<Scheme> scheme = Scheme::recommended,
                        int of_dimensions = kPlaneDim);
  /// The document with everything filled in that resolves to `scene`.
  explicit WrittenScene(const Scene& scene);
};

/// h/dx where a scene gives none: three layers of cells (3 dx) then hold the kernel's support, 3h
/// for the truncated Gaussian and 2h for Wendland C2, so a wall of three layers leaves no part of
/// the sums empty, and both kernels see the same 28 neighbours.
[[nodiscard]] double default_smoothing_ratio(KernelKind kernel);

/// H, m: how high the fluid stands against gravity above the lowest point of the tank, or of itself
/// where there is no tank. 0 without gravity.
[[nodiscard]] double fluid_height(const Scene& scene);

/// c = 10 sqrt(2 |f| H), m/s: ten times the speed of a fall through H keeps the density within 1 %.
[[nodiscard]] double default_sound_speed(const Scene& scene);

/// With a tank: the tank, its walls and one smoothing length more, and twice the fluid's height of
/// room above an open top. Without: the fluid's bounding box where it starts and where it would be
/// at the end if it flew freely, widened by its own larger extent, m.
[[nodiscard]] Box default_domain(const Scene& scene);

/// Fills in what `document` left to be derived and returns the scene. Needs every key it has to be
/// in its range and a fluid, and gravity or a sound speed.
[[nodiscard]] Scene resolve(const WrittenScene& written);

}  // namespace sluice

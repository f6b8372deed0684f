#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/sph/method.hpp"
#include "engine/sph/vec.hpp"

namespace sluice {

// Shapes. Lengths in m, x to the right, y up.
struct Rectangle {
  Vec corner = Vec::Zero();  ///< lower left
  Vec size = Vec::Zero();
};
struct Circle {
  Vec center = Vec::Zero();
  double radius = 0.0;
};
struct Ellipse {
  Vec center = Vec::Zero();
  Vec semi_axes = Vec::Zero();
};
struct Polygon {
  std::vector<Vec> points;  ///< simple, not closed by repetition
};
using Shape = std::variant<Rectangle, Circle, Ellipse, Polygon>;

/// A box of solid walls around [0, width] x [0, height], with a lid or without.
struct Tank {
  double width = 0.0;
  double height = 0.0;
  bool open_top = true;
};

enum class InitialPressure {
  hydrostatic,  ///< rho_0 |g| times the depth below the region's highest point against gravity
  zero,
};

struct FluidRegion {
  Shape shape;
  Vec velocity = Vec::Zero();  ///< m/s
  InitialPressure pressure = InitialPressure::hydrostatic;
};

enum class SensorKind { pressure, surface_height, surge_front, column_height, energy, arrival };

/// The word for a kind in scenes and series files.
[[nodiscard]] std::string_view to_string(SensorKind kind);

struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::pressure;
  Vec position = Vec::Zero();     ///< pressure, arrival: the point, m; surface_height and
                                  ///< column_height: x only; otherwise zero
  double smoothing_length = 0.0;  ///< pressure only, m; parsed default: the scene's h
  double interval = 0.0;          ///< s; 0: every step
};

/// Particle snapshots for pictures.
struct Frames {
  double interval = 0.0;  ///< s
};

/// Displaces each particle at the start, so that runs of one scene make an ensemble: what follows
/// an impact is chaotic, and a single run does not tell its spread.
struct Jitter {
  double amplitude = 0.0;  ///< largest displacement in each direction, in spacings
  int seed = 1;
};

/// Lengths that make results dimensionless: T = t sqrt(g/h0), X = w/w0, H = h/h0, P = p/(rho_0 g
/// h0).
struct Scales {
  double height = 0.0;  ///< h0, m
  double width = 0.0;   ///< w0, m
};

/// What to simulate: a parsed and validated scene. An absent part is left out of the run.
struct Scene {
  std::string name;
  std::string description;
  std::optional<Tank> tank;
  std::vector<FluidRegion> fluid;
  std::vector<Shape> obstacles;
  Method method;
  std::vector<Sensor> sensors;
  std::optional<Jitter> jitter;
  std::optional<Frames> frames;
  std::optional<Scales> scales;
  double end_time = 0.0;  ///< s; the run ends at the first step at or after it
};

}  // namespace sluice

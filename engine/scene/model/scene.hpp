#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/model/scheme.hpp"
#include "engine/scene/model/shapes.hpp"
#include "engine/space/vec.hpp"
#include "engine/sph/method/flow_domain.hpp"
#include "engine/sph/method/method.hpp"
#include "sluice/experiment_words.hpp"

namespace sluice {

/// A box of solid walls around [0, size()], with a lid or without.
struct Tank {
  double width = 0.0;           ///< along x, m
  double height = 0.0;          ///< along y, m
  std::optional<double> depth;  ///< along z, m; in space only
  bool open_top = true;

  [[nodiscard]] Vec size() const {
    if (depth) return Vec3(width, height, *depth);
    return Vec2(width, height);
  }
  [[nodiscard]] Box interior() const {
    return {filled_vec<kAnyDim>(0.0, dimensions_of(size())), size()};
  }
};

/// A wall across the whole tank, on its floor, that holds the fluid on its left back and is lifted
/// from t = 0 on. Its thickness, to the right of x, is that of all walls: the kernel's support.
struct Gate {
  double x = 0.0;       ///< the side that the fluid touches, m
  double height = 0.0;  ///< m; parsed default: the tank's height
  double speed = 0.0;   ///< of the lower edge, upwards, m/s
};

enum class InitialPressure {
  hydrostatic,  ///< rho_0 |g| times the depth below the region's highest point against gravity
  zero,
};

struct FluidRegion {
  Shape shape;
  Vec velocity = filled_vec<kAnyDim>(0.0);  ///< m/s
  std::optional<double> strain_rate;        ///< A of v = A (x, -y) about the middle, 1/s
  std::optional<double> rotation_rate;      ///< w of v = w (-y, x) about the middle, 1/s
  InitialPressure pressure = InitialPressure::hydrostatic;
};

enum class SensorKind { pressure, surface_height, surge_front, column_height, energy, arrival };

/// The word for a kind in scenes and series files.
[[nodiscard]] std::string_view to_string(SensorKind kind);

struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::pressure;
  /// pressure, arrival: the point, m; surface_height and column_height: a place on the floor;
  /// otherwise zero.
  Vec position = filled_vec<kAnyDim>(0.0);
  double smoothing_length = 0.0;  ///< pressure only, m; parsed default: the scene's h
  /// Pressure only, Pa above that of a free surface, which is 0: of the air in what neither fluid
  /// nor wall fills around the point. Absent: eq. 11, whose mean is over the fluid alone.
  std::optional<double> air_pressure;
  double interval = 0.0;  ///< s; 0: every step
};

/// Particle snapshots for pictures.
struct Frames {
  double interval = 0.0;  ///< s
};

/// Displaces each particle at the start, so that runs of one scene make an ensemble: what follows
/// an impact is chaotic, and a single run does not tell its spread.
struct Perturbation {
  double amplitude = 0.0;  ///< largest displacement in each direction, in spacings
  int seed = 1;
};

/// Lengths that make results dimensionless: T = t sqrt(g/h0), X = w/w0, H = h/h0, P = p/(rho_0 g
/// h0).
struct Scales {
  double height = 0.0;  ///< h0, m
  double width = 0.0;   ///< w0, m
};

enum class ReferenceKind {
  experiment,  ///< a built-in one
  series,      ///< the scene brings its own curves
  none,        ///< compare with nothing, even where an experiment has the scene's shape
};

/// si: s and the sensor's own unit. dimensionless: divided as eqs. 19-22 say, by the scene's
/// scales.
enum class ReferenceUnits { si, dimensionless };

/// What one sensor should have measured. `low` and `high` are empty or, like `value`, as long as
/// `time`, which increases strictly.
struct ReferenceCurve {
  std::string sensor;
  std::vector<double> time;
  std::vector<double> value;
  std::vector<double> low;  ///< lower edge of a band around the value, such as a percentile
  std::vector<double> high;
};

/// What a run's series are compared with when they are reported. It changes nothing in the run.
struct SceneReference {
  ReferenceKind kind = ReferenceKind::none;
  std::string_view experiment = kExperimentWords.front().word;  ///< one of kExperimentWords
  std::string title;
  std::string citation;
  ReferenceUnits units = ReferenceUnits::si;
  std::vector<ReferenceCurve> curves;
};

/// What to simulate: a parsed and validated scene. An absent part is left out of the run.
struct Scene {
  std::string name;
  std::string description;
  std::optional<Tank> tank;
  std::optional<Gate> gate;
  std::vector<FluidRegion> fluid;
  std::vector<Shape> obstacles;
  Method method;
  FlowDomain domain;        ///< without what solids fill: domain_with_solids() adds it
  NumericsSource numerics;  ///< where the method's words and terms come from; changes nothing
  std::vector<Sensor> sensors;
  std::optional<Perturbation> perturbation;
  std::optional<Frames> frames;
  std::vector<double> pictures;  ///< s; times of a report's pictures; empty: it chooses
  std::optional<Scales> scales;
  std::optional<SceneReference> reference;
  double end_time = 0.0;  ///< s; the run ends at the first step at or after it

  [[nodiscard]] int dimensions() const { return method.dimensions(); }
};

}  // namespace sluice

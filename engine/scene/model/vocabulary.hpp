#pragma once

#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/spec.hpp"

namespace sluice {

/// The alternatives of Shape, in its order.
enum class ShapeKind {
  rectangle,
  circle,
  ellipse,
  polygon,
  box,
  sphere,
  ellipsoid,
  cylinder,
  prism,
  heights,
  mesh
};

[[nodiscard]] inline ShapeKind kind_of(const Shape& shape) {
  return static_cast<ShapeKind>(shape.index());
}
[[nodiscard]] inline Shape shape_of(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::rectangle:
      return Rectangle{};
    case ShapeKind::circle:
      return Circle{};
    case ShapeKind::ellipse:
      return Ellipse{};
    case ShapeKind::polygon:
      return Polygon{};
    case ShapeKind::box:
      return Cuboid<3>{};
    case ShapeKind::sphere:
      return Ball<3>{};
    case ShapeKind::ellipsoid:
      return Ellipsoid<3>{};
    case ShapeKind::cylinder:
      return Cylinder{};
    case ShapeKind::prism:
      return Prism{};
    case ShapeKind::heights:
      return Heights{};
    case ShapeKind::mesh:
      return Mesh{};
  }
  return Rectangle{};
}

// The words that scenes write for each enumeration.
inline constexpr Words<ShapeKind, 11> kShapeWords{{
    {"rectangle", ShapeKind::rectangle, "in the plane, axis-aligned"},
    {"circle", ShapeKind::circle, "in the plane"},
    {"ellipse", ShapeKind::ellipse, "in the plane, axis-aligned"},
    {"polygon", ShapeKind::polygon, "in the plane, without self-intersections"},
    {"box", ShapeKind::box, "in space, axis-aligned"},
    {"sphere", ShapeKind::sphere, "in space"},
    {"ellipsoid", ShapeKind::ellipsoid, "in space, axis-aligned"},
    {"cylinder", ShapeKind::cylinder, "in space, right and circular, its axis in any direction"},
    {"prism", ShapeKind::prism,
     "in space: a polygon of the plane of x and y, without self-intersections, drawn out along z"},
    {"heights", ShapeKind::heights,
     "in space, such as a bed: what lies between a level base and heights on a grid over it"},
    {"mesh", ShapeKind::mesh,
     "in space: the inside of a closed surface of triangles, an STL or OBJ file beside the scene"},
}};
inline constexpr Words<InitialPressure, 2> kInitialPressureWords{{
    {"hydrostatic", InitialPressure::hydrostatic, "that of water at rest below the region's top"},
    {"zero", InitialPressure::zero, "none"},
}};
inline constexpr Words<Scheme, 2> kSchemeWords{{
    {"recommended", Scheme::recommended,
     "wendland_c2, kick_drift_kick at C = 1, fourtakas, alpha 0.02 with beta 0.5, wall_shear, "
     "clamped "
     "walls, particle_shifting"},
    {"paper", Scheme::paper,
     "truncated_gaussian, modified_leap_frog at C = 0.25, molteni_colagrossi, alpha 0.02, "
     "extrapolated walls, reinitialisation"},
}};
inline constexpr Words<KernelKind, 2> kKernelWords{{
    {"truncated_gaussian", KernelKind::truncated_gaussian, "support 3h"},
    {"wendland_c2", KernelKind::wendland_c2, "support 2h"},
}};
inline constexpr Words<Integrator, 2> kIntegratorWords{{
    {"modified_leap_frog", Integrator::modified_leap_frog, "the paper's; steps to about C = 0.5"},
    {"kick_drift_kick", Integrator::kick_drift_kick, "stable at larger steps, to about C = 1"},
}};
inline constexpr Words<Precision, 2> kPrecisionWords{{
    {"mixed", Precision::mixed, "sums in single, state in double precision"},
    {"double", Precision::double_precision, "everything in double precision"},
}};
inline constexpr Words<WallPressure, 2> kWallPressureWords{{
    {"extrapolated", WallPressure::extrapolated, "may be negative"},
    {"clamped", WallPressure::clamped, "not below zero: keeps particles from the wall's far side"},
}};
inline constexpr Words<SensorKind, 6> kSensorWords{{
    {"pressure", SensorKind::pressure,
     "pressure at a point: the kernel's mean over the fluid around it, eq. 11, or with "
     "air_pressure "
     "that over fluid and air; dry, without a value, where no fluid is within the kernel"},
    {"surface_height", SensorKind::surface_height,
     "greatest height at x where fluid fills half of the kernel, so of splashes and of the upper "
     "one of two surfaces too; nearer to a tank wall than half of the kernel's support, taken "
     "there"},
    {"surge_front", SensorKind::surge_front,
     "largest x of any fluid particle, at most the tank's right wall: a front only where a column "
     "on "
     "the left runs to the right over a dry bed; spray counts"},
    {"column_height", SensorKind::column_height,
     "surface_height at x, by default beside the left wall"},
    {"energy", SensorKind::energy,
     "kinetic, potential (against gravity, zero at the origin) and internal energy of the fluid, "
     "in the plane per metre of depth"},
    {"arrival", SensorKind::arrival,
     "the time at which a fluid particle first comes within 1.5 particle distances of a point"},
}};

inline constexpr Words<ReferenceKind, 3> kReferenceWords{{
    {"experiment", ReferenceKind::experiment, "built into the program"},
    {"series", ReferenceKind::series, "curves that stand here"},
    {"none", ReferenceKind::none, "no comparison"},
}};
inline constexpr Words<ReferenceUnits, 2> kReferenceUnitWords{{
    {"si", ReferenceUnits::si, "s and the sensor's unit"},
    {"dimensionless", ReferenceUnits::dimensionless, "by the scales, eqs. 19-22"},
}};

}  // namespace sluice

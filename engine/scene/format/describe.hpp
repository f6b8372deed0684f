#pragma once

#include <optional>
#include <variant>

#include "engine/scene/format/written_scene.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

/// The scene format, once: each key with its member, unit, range, default and meaning. What goes
/// through it decides what happens: Reader parses and reports, Writer makes the canonical text,
/// SchemaWriter the published schema. A default is the value of the member in a fresh struct.
namespace sluice {

// A scene spans at most a few decades around these; the bounds keep squares and products of all
// quantities far from the ends of double.
inline constexpr Range kLength = above(0, 1e6);
inline constexpr Range kCoordinate = from(-1e6, 1e6);
inline constexpr Range kTime = above(0, 1e6);
inline constexpr Range kSoundSpeed = from(1e-6, 1e7);
inline constexpr std::size_t kMaxShapes = 64;
inline constexpr std::size_t kMaxPolygonPoints = 256;
inline constexpr std::size_t kMaxSensors = 1024;
inline constexpr std::size_t kMaxReferenceCurves = 32;
inline constexpr std::size_t kMaxPictures = 24;
inline constexpr std::size_t kMaxReferencePoints = 2000;

template <class Archive>
void describe(Archive& a, Rectangle& shape) {
  a.vector(
      "corner", shape.corner,
      {.about = "lower left corner", .unit = "m", .range = kCoordinate, .need = Need::required});
  a.vector("size", shape.size,
           {.about = "width and height", .unit = "m", .range = kLength, .need = Need::required});
}

template <class Archive>
void describe(Archive& a, Circle& shape) {
  a.vector("center", shape.center,
           {.about = "center", .unit = "m", .range = kCoordinate, .need = Need::required});
  a.number("radius", shape.radius,
           {.about = "radius", .unit = "m", .range = kLength, .need = Need::required});
}

template <class Archive>
void describe(Archive& a, Ellipse& shape) {
  a.vector("center", shape.center,
           {.about = "center", .unit = "m", .range = kCoordinate, .need = Need::required});
  a.vector("semi_axes", shape.semi_axes,
           {.about = "half the width and half the height",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
}

template <class Archive>
void describe(Archive& a, Polygon& shape) {
  a.points("points", shape.points,
           {.about = "corners in order, either way round; the last joins the first",
            .min = 3,
            .max = kMaxPolygonPoints,
            .need = Need::required},
           {.about = "corner", .unit = "m", .range = kCoordinate});
}

/// A shape, and in the same object the keys that `more` describes.
template <class Archive, class More>
void describe_shape(Archive& a, Shape& shape, const More& more) {
  a.choice("shape", kShapeWords, kind_of(shape), "what the region looks like",
           [&](auto& branch, ShapeKind kind) {
             if (kind_of(shape) != kind) shape = shape_of(kind);
             std::visit([&](auto& each) { describe(branch, each); }, shape);
             more(branch);
           });
}

template <class Archive>
void describe(Archive& a, Shape& shape) {
  describe_shape(a, shape, [](auto&) {});
}

template <class Archive>
void describe(Archive& a, FluidRegion& region) {
  describe_shape(a, region.shape, [&](auto& branch) {
    branch.vector("velocity", region.velocity,
                  {.about = "velocity at the start", .unit = "m/s", .range = from(-1e6, 1e6)});
    branch.number("strain_rate", region.strain_rate,
                  {.about = "A of a flow A (x, -y) about the middle of the region, on top of its "
                            "velocity",
                   .unit = "1/s",
                   .range = from(-1e9, 1e9),
                   .otherwise = "none"});
    branch.number("rotation_rate", region.rotation_rate,
                  {.about = "w of a rotation w (-y, x) about the middle of the region, on top of "
                            "its velocity",
                   .unit = "1/s",
                   .range = from(-1e9, 1e9),
                   .otherwise = "none"});
    branch.word("pressure", kInitialPressureWords, region.pressure,
                {.about = "pressure at the start"});
  });
}

template <class Archive>
void describe(Archive& a, Tank& tank) {
  a.number("width", tank.width,
           {.about = "inner width: walls stand at x = 0 and x = width",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
  a.number("height", tank.height,
           {.about = "inner height: the floor lies at y = 0, the walls end at y = height",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
  a.flag("open_top", tank.open_top, {.about = "false: with a lid at y = height"});
}

template <class Archive>
void describe(Archive& a, Gate& gate) {
  a.number("x", gate.x,
           {.about = "the side that the fluid touches; the gate stands on the floor to its right",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
  std::optional<double> given;
  if (gate.height > 0) given = gate.height;
  a.number("height", given,
           {.about = "height before it is lifted",
            .unit = "m",
            .range = kLength,
            .otherwise = "the tank's height"});
  gate.height = given.value_or(0.0);
  a.number("speed", gate.speed,
           {.about = "speed at which it is lifted from t = 0 on",
            .unit = "m/s",
            .range = above(0, 1e6),
            .need = Need::required});
}

template <class Archive>
void describe(Archive& a, Box& box) {
  a.vector(
      "min", box.min,
      {.about = "lower left corner", .unit = "m", .range = kCoordinate, .need = Need::required});
  a.vector(
      "max", box.max,
      {.about = "upper right corner", .unit = "m", .range = kCoordinate, .need = Need::required});
}

template <class Archive>
void describe(Archive& a, DensityDiffusion& term) {
  a.word("kind", kDiffusionWords, term.kind, {.about = "what is diffused"});
  a.number("delta", term.delta, {.about = "strength delta of eq. 7", .range = from(0, 2)});
}

template <class Archive>
void describe_viscosity(Archive& a, double& alpha, double& epsilon) {
  a.number("alpha", alpha, {.about = "strength alpha of eq. 8", .range = from(0, 10)});
  a.number(
      "epsilon", epsilon,
      {.about = "keeps the denominator of eq. 8 from zero: epsilon h^2", .range = above(0, 1)});
}
template <class Archive>
void describe(Archive& a, ArtificialViscosity& term) {
  describe_viscosity(a, term.alpha, term.epsilon);
  a.number("beta", term.beta,
           {.about = "strength of the quadratic part, which acts where particles collide and keeps "
                     "them apart at impacts; 0 leaves it out",
            .range = from(0, 10)});
}
template <class Archive>
void describe(Archive& a, WallArtificialViscosity& term) {
  describe_viscosity(a, term.alpha, term.epsilon);
}

template <class Archive>
void describe(Archive& a, LaminarViscosity& term) {
  a.number("nu", term.nu,
           {.about = "kinematic viscosity: 1e-6 m^2/s is water's own, a turbulent flow's is larger",
            .unit = "m^2/s",
            .range = from(0, 1e12)});
}

template <class Archive>
void describe(Archive& a, WallShear& term) {
  a.number("coefficient", term.coefficient,
           {.about = "skin friction coefficient: stress at the wall over rho v^2/2; 0.004 is a "
                     "smooth wall's, more stands for walls in front and behind as well",
            .range = from(0, 1)});
}

template <class Archive>
void describe(Archive& a, ParticleShifting& term) {
  a.number("coefficient", term.coefficient,
           {.about = "A: a particle moves by A h |v| dt grad C against the gradient of the "
                     "concentration C, at most 0.1 particle distances in a step",
            .range = above(0, 10)});
}

template <class Archive>
void describe(Archive& a, Reinitialisation& term) {
  a.integer("interval", term.interval,
            {.about = "steps from one reinitialisation to the next", .range = from(1, 1e6)});
}

/// Of a scheme, and of single keys beside it. A term takes null: left out.
template <class Archive>
void describe_numerics(Archive& a, Scene& scene) {
  Method& method = scene.method;
  a.word("scheme", kSchemeWords, scene.numerics.scheme,
         {.about = "what the keys that are missing here are; defaults below are those of "
                   "recommended"});
  a.word("kernel", kKernelWords, method.kernel, {.about = "smoothing function W"});
  a.word("integrator", kIntegratorWords, method.integrator, {.about = "time integration"});
  a.number("courant", method.courant,
           {.about = "Courant number C of the time step, eq. 18; 0.25 with modified_leap_frog; "
                     "impacts need it below about two thirds of the limit that linear analysis "
                     "gives for particles at rest (sluice plan)",
            .range = above(0, 2)});
  a.word("precision", kPrecisionWords, method.precision, {.about = "arithmetic"});
  a.term("density_diffusion", method.diffusion, {.about = "density diffusion D_i, eq. 7"});
  a.term("artificial_viscosity", method.viscosity,
         {.about = "artificial viscosity Pi_ij between fluid particles, eq. 8"});
  a.term("wall_artificial_viscosity", method.wall_artificial_viscosity,
         {.about = "Pi_ij of eq. 8 against walls at rest; not beside laminar_viscosity; in place "
                   "of wall_shear"});
  a.term("laminar_viscosity", method.laminar_viscosity,
         {.about = "viscous stress in the fluid, no slip at walls; in place of wall_shear"});
  a.term("wall_shear", method.wall_shear,
         {.about = "stress at walls that grows with the square of the speed"});
  a.word("wall_pressure", kWallPressureWords, method.wall_pressure,
         {.about = "pressure of the walls' dummy particles, eq. 9"});
  a.term("particle_shifting", method.shifting,
         {.about = "moves particles inside the fluid to where others lack; with kick_drift_kick"});
  a.term("reinitialisation", method.reinitialisation,
         {.about = "density reinitialisation, eq. 10"});
}

template <class Archive>
void describe_position(Archive& a, Sensor& sensor) {
  a.vector("position", sensor.position,
           {.about = "where it sits", .unit = "m", .range = kCoordinate, .need = Need::required});
}

template <class Archive>
void describe_smoothing_length(Archive& a, Sensor& sensor) {
  std::optional<double> given;
  if (sensor.smoothing_length > 0) given = sensor.smoothing_length;
  a.number("smoothing_length", given,
           {.about = "h of the sum of eq. 11",
            .unit = "m",
            .range = kLength,
            .otherwise = "the scene's smoothing length"});
  sensor.smoothing_length = given.value_or(0.0);
}

template <class Archive>
void describe_air_pressure(Archive& a, Sensor& sensor) {
  a.number("air_pressure", sensor.air_pressure,
           {.about = "pressure of the air in what neither fluid nor wall fills around the sensor, "
                     "above that of a free surface, so mostly 0; the value is then the mean over "
                     "fluid and air, which its face feels",
            .unit = "Pa",
            .range = from(-1e12, 1e12),
            .otherwise = "the mean over the fluid alone, eq. 11"});
}

template <class Archive>
void describe_kind(Archive& a, Sensor& sensor) {
  switch (sensor.kind) {
    case SensorKind::pressure:
      describe_position(a, sensor);
      describe_smoothing_length(a, sensor);
      describe_air_pressure(a, sensor);
      return;
    case SensorKind::arrival:
      describe_position(a, sensor);
      return;
    case SensorKind::surface_height:
      a.number("x", sensor.position.x(),
               {.about = "where the surface is sought",
                .unit = "m",
                .range = kCoordinate,
                .need = Need::required});
      return;
    case SensorKind::column_height:
      a.number("x", sensor.position.x(),
               {.about = "where the surface is sought: the left wall",
                .unit = "m",
                .range = kCoordinate});
      return;
    case SensorKind::surge_front:
    case SensorKind::energy:
      return;
  }
}

template <class Archive>
void describe(Archive& a, Sensor& sensor) {
  a.choice("kind", kSensorWords, sensor.kind, "what it measures",
           [&](auto& branch, SensorKind kind) {
             sensor.kind = kind;
             branch.text("name", sensor.name,
                         {.about = "name of its series, unique in the scene",
                          .min = 1,
                          .max = 32,
                          .need = Need::required});
             describe_kind(branch, sensor);
             branch.number("interval", sensor.interval,
                           {.about = "time from one sample to the next; 0: every step",
                            .unit = "s",
                            .range = from(0, 1e6),
                            .need = Need::required});
           });
}

template <class Archive>
void describe(Archive& a, Frames& frames) {
  a.number("interval", frames.interval,
           {.about = "time from one snapshot to the next",
            .unit = "s",
            .range = kTime,
            .need = Need::required});
}

template <class Archive>
void describe(Archive& a, Perturbation& perturbation) {
  a.number("amplitude", perturbation.amplitude,
           {.about = "largest displacement in each direction, in particle distances",
            .range = above(0, 0.5),
            .need = Need::required});
  a.integer("seed", perturbation.seed,
            {.about = "another seed, another run", .range = from(0, 1e9)});
}

template <class Archive>
void describe(Archive& a, Scales& scales) {
  a.number("height", scales.height,
           {.about = "h0 of T = t sqrt(g/h0), H = h/h0, P = p/(rho_0 g h0)",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
  a.number("width", scales.width,
           {.about = "w0 of X = w/w0", .unit = "m", .range = kLength, .need = Need::required});
}

template <class Archive>
void describe(Archive& a, ReferenceCurve& curve) {
  constexpr std::size_t kMost = kMaxReferencePoints;
  constexpr NumberSpec kValue{.about = "number", .range = from(-1e12, 1e12)};
  a.text("sensor", curve.sensor,
         {.about = "name of the sensor that should measure this; of its columns the first",
          .min = 1,
          .max = 32,
          .need = Need::required});
  a.numbers("time", curve.time,
            {.about = "times, increasing; each value stands for the time up to half way to its "
                      "neighbours",
             .min = 2,
             .max = kMost,
             .need = Need::required},
            kValue);
  a.numbers("value", curve.value,
            {.about = "one value per time", .min = 2, .max = kMost, .need = Need::required},
            kValue);
  a.numbers("low", curve.low,
            {.about = "lower edge of a band around the values, one number per time", .max = kMost},
            kValue);
  a.numbers("high", curve.high, {.about = "upper edge of that band", .max = kMost}, kValue);
}

template <class Archive>
void describe_reference_series(Archive& a, SceneReference& reference) {
  a.text("title", reference.title,
         {.about = "what it is, for headings",
          .characters = Characters::sentence,
          .min = 1,
          .max = 200,
          .need = Need::required});
  a.text("citation", reference.citation,
         {.about = "where it is from", .characters = Characters::sentence, .max = 500});
  a.word("units", kReferenceUnitWords, reference.units, {.about = "units of times and values"});
  a.list("curves", reference.curves,
         {.about = "what sensors should have measured",
          .min = 1,
          .max = kMaxReferenceCurves,
          .need = Need::required});
}

template <class Archive>
void describe(Archive& a, SceneReference& reference) {
  a.choice("kind", kReferenceWords, reference.kind, "where its figures are",
           [&](auto& branch, ReferenceKind kind) {
             reference.kind = kind;
             if (kind == ReferenceKind::experiment) {
               branch.word("name", kExperimentWords, reference.experiment, {.about = "which one"});
             }
             if (kind == ReferenceKind::series) describe_reference_series(branch, reference);
           });
}

template <class Archive>
void describe_material(Archive& a, WrittenScene& written) {
  a.number("density", written.scene.method.reference_density,
           {.about = "reference density rho_0", .unit = "kg/m^3", .range = from(1e-6, 1e6)});
  a.number("sound_speed", written.sound_speed,
           {.about = "numerical speed of sound c, about ten times the largest flow speed",
            .unit = "m/s",
            .range = kSoundSpeed,
            .otherwise = "10 sqrt(2 |gravity| H), H the fluid's height; required without gravity"});
}

template <class Archive>
void describe_resolution(Archive& a, WrittenScene& written) {
  a.number("spacing", written.scene.method.spacing,
           {.about = "particle distance dx at the start",
            .unit = "m",
            .range = from(1e-9, 1e5),
            .need = Need::required});
  a.number("smoothing_ratio", written.smoothing_ratio,
           {.about = "smoothing length over particle distance, h/dx",
            .range = from(0.8, 2.5),
            .otherwise = "1 for truncated_gaussian, 1.5 for wendland_c2: a support of 3 dx"});
}

template <class Archive>
void describe(Archive& a, WrittenScene& written) {
  Scene& scene = written.scene;
  a.text("name", scene.name,
         {.about = "name of the scene", .min = 1, .max = 64, .need = Need::required});
  a.text("description", scene.description,
         {.about = "what it is for", .characters = Characters::sentence, .max = 2000});
  a.section("tank", scene.tank,
            {.about = "solid walls around [0, width] x [0, height]", .otherwise = "no walls"});
  a.section(
      "gate", scene.gate,
      {.about = "a wall across the tank that is lifted at the start", .otherwise = "no gate"});
  a.list("fluid", scene.fluid,
         {.about = "regions filled with fluid at the start; they must not overlap",
          .min = 1,
          .max = kMaxShapes,
          .need = Need::required});
  a.list("obstacles", scene.obstacles,
         {.about = "solid bodies at rest; they displace fluid", .max = kMaxShapes});
  a.vector("gravity", written.gravity,
           {.about = "body acceleration f",
            .unit = "m/s^2",
            .range = from(-1e9, 1e9),
            .otherwise = "no gravity"});
  a.section("domain", written.domain,
            {.about = "a particle that leaves this box is removed",
             .otherwise = "the tank with its walls and room above, or the fluid with ample room"});
  a.section("material", {.about = "the fluid"},
            [&](auto& child) { describe_material(child, written); });
  a.section("resolution", {.about = "how fine", .need = Need::required},
            [&](auto& child) { describe_resolution(child, written); });
  a.section("perturbation", scene.perturbation,
            {.about = "random displacement of the particles at the start, for ensembles",
             .otherwise = "a regular lattice"});
  a.section("numerics", {.about = "the scheme, and what differs from it"},
            [&](auto& child) { describe_numerics(child, scene); });
  a.list("sensors", scene.sensors, {.about = "what is measured", .max = kMaxSensors});
  a.section("output", {.about = "what is written beside checkpoints and series"}, [&](auto& child) {
    child.section("frames", scene.frames,
                  {.about = "snapshots of all particles", .otherwise = "no snapshots"});
    child.numbers("pictures", scene.pictures,
                  {.about = "times that a report's pictures show, each by the nearest snapshot; "
                            "they change nothing in the run. Without them the report chooses",
                   .max = kMaxPictures},
                  {.about = "time", .unit = "s", .range = from(0, 1e6)});
  });
  a.section("scales", scene.scales,
            {.about = "lengths that make results dimensionless",
             .otherwise = "no dimensionless results"});
  a.section("reference", scene.reference,
            {.about = "what reports compare the series with; it changes nothing in the run",
             .otherwise = "the built-in experiment whose tank and column have the scene's shape, "
                          "if any"});
  a.number("end_time", scene.end_time,
           {.about = "the run ends at the first step at or after it",
            .unit = "s",
            .range = kTime,
            .need = Need::required});
}

}  // namespace sluice

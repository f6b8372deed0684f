#pragma once

#include <optional>

#include "engine/scene/format/describe_numerics.hpp"
#include "engine/scene/format/describe_reference.hpp"
#include "engine/scene/format/describe_regions.hpp"
#include "engine/scene/format/describe_sensors.hpp"
#include "engine/scene/format/written_scene.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

/// The scene format, once: each key with its member, unit, range, default and meaning. What goes
/// through it decides what happens: Reader parses and reports, Writer makes the canonical text,
/// SchemaWriter the published schema. A default is the value of the member in a fresh struct.
namespace sluice {

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
  a.integer("dimensions", written.dimensions,
            {.about = "2: the plane, x and y; 3: space",
             .range = from(2, 3),
             .otherwise = "that of the first fluid's shape"});
  a.section("tank", scene.tank,
            {.about = "solid walls around [0, width] x [0, height], in space x [0, depth]",
             .otherwise = "no walls"});
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

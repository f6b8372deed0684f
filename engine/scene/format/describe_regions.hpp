#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "engine/scene/format/describe_ranges.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

namespace sluice {

// Part of the scene format (describe.hpp): shapes, fluid, tank, gate.

/// A place in a scene, or a way from one place to another.
template <class Archive, class Place>
void describe_place(Archive& a, std::string_view key, Place& place, std::string_view about) {
  a.vector(key, place, {.about = about, .unit = "m", .range = kCoordinate, .need = Need::required});
}

template <class Archive>
void describe_length(Archive& a, std::string_view key, double& length, std::string_view about) {
  a.number(key, length, {.about = about, .unit = "m", .range = kLength, .need = Need::required});
}

template <class Archive, int Dim>
void describe(Archive& a, Cuboid<Dim>& shape) {
  constexpr bool kPlane = Dim == 2;
  describe_place(a, "corner", shape.corner,
                 kPlane ? "lower left corner" : "corner of lowest coordinates");
  a.vector("size", shape.size,
           {.about = kPlane ? "width and height" : "width, height and depth: along x, y and z",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
}

template <class Archive, int Dim>
void describe(Archive& a, Ball<Dim>& shape) {
  describe_place(a, "center", shape.center, "center");
  describe_length(a, "radius", shape.radius, "radius");
}

template <class Archive, int Dim>
void describe(Archive& a, Ellipsoid<Dim>& shape) {
  describe_place(a, "center", shape.center, "center");
  a.vector("semi_axes", shape.semi_axes,
           {.about = Dim == 2 ? "half the width and half the height"
                              : "half the width, half the height and half the depth",
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

template <class Archive>
void describe(Archive& a, Cylinder& shape) {
  describe_place(a, "base", shape.base, "middle of one end");
  describe_place(a, "axis", shape.axis,
                 "from there to the middle of the other end; its length is the height");
  describe_length(a, "radius", shape.radius, "radius");
}

template <class Archive>
void describe(Archive& a, Prism& shape) {
  describe(a, shape.section);
  a.number("z", shape.z,
           {.about = "where it begins", .unit = "m", .range = kCoordinate, .need = Need::required});
  describe_length(a, "depth", shape.depth, "how far it goes on along z");
}

template <class Archive>
void describe(Archive& a, Heights& shape) {
  describe_place(a, "corner", shape.corner,
                 "where the grid begins in x and z; its y is that of the base");
  a.vector("step", shape.step,
           {.about = "from one node of the grid to the next, along x and z",
            .unit = "m",
            .range = kLength,
            .need = Need::required});
  a.rows("heights", shape.heights,
         {.about = "y of the surface above each node, above the base: rows along x, one for each "
                   "z. Between the nodes it is straight: a cell's two triangles meet on the line "
                   "from its node of lowest x and z to that of highest",
          .min = 2,
          .max = kMaxHeights,
          .need = Need::required},
         {.about = "y", .unit = "m", .range = kCoordinate});
}

template <class Archive>
void describe(Archive& a, Rotation& rotation) {
  a.vector("axis", rotation.axis,
           {.about = "the axis' direction, of any length",
            .range = from(-1e6, 1e6),
            .need = Need::required});
  a.number("angle", rotation.angle,
           {.about = "anticlockwise, as seen from the tip of the axis",
            .unit = "degree",
            .range = from(-360, 360),
            .need = Need::required});
}

template <class Archive>
void describe(Archive& a, Mesh& shape) {
  a.text("file", shape.file,
         {.about = "name of an STL (ascii or binary) or OBJ file beside the scene; with a job it "
                   "is submitted as a further part. Its surface is closed: each edge has two "
                   "triangles. At most 16 MiB, and 200000 triangles in all meshes of a scene",
          .characters = Characters::mesh,
          .min = 5,
          .max = 64,
          .need = Need::required});
  a.text("sha256", shape.sha256,
         {.about = "SHA-256 of the file; a job's folder names it, and a file that differs is "
                   "refused",
          .characters = Characters::sha256,
          .min = 64,
          .max = 64});
  a.number("scale", shape.scale,
           {.about = "length of a unit of the file", .unit = "m", .range = above(0, 1e6)});
  a.section("rotation", shape.rotation,
            {.about = "turns it about the file's origin, after the scale", .otherwise = "none"});
  a.vector("place", shape.place,
           {.about = "where the file's origin comes to lie", .unit = "m", .range = kCoordinate});
}

/// A shape, and in the same object the keys that `more` describes.
template <class Archive, class More>
void describe_shape(Archive& a, Shape& shape, const More& more) {
  a.choice("shape", kShapeWords, kind_of(shape), "what the region looks like",
           [&](auto& branch, ShapeKind kind) {
             if (kind_of(shape) != kind) shape = shape_of(kind);
             branch.require_dimensions("shape", dimensions_of(shape));
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
                  {.about = "velocity at the start",
                   .unit = "m/s",
                   .range = from(-1e6, 1e6),
                   .otherwise = "at rest"});
    branch.number("strain_rate", region.strain_rate,
                  {.about = "A of a flow A (x, -y), in space A (x, -y, 0), about the middle of the "
                            "region, on top of its velocity",
                   .unit = "1/s",
                   .range = from(-1e9, 1e9),
                   .otherwise = "none"});
    branch.number("rotation_rate", region.rotation_rate,
                  {.about = "w of a rotation w (-y, x), in space w (-y, x, 0), about the middle of "
                            "the region, on top of its velocity",
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
  a.number("depth", tank.depth,
           {.about = "inner depth: walls stand at z = 0 and z = depth; in space only, and there it "
                     "must be given",
            .unit = "m",
            .range = kLength,
            .otherwise = "a tank of the plane"});
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
  a.vector("min", box.min,
           {.about = "corner of lowest coordinates",
            .unit = "m",
            .range = kCoordinate,
            .need = Need::required});
  a.vector("max", box.max,
           {.about = "corner of highest coordinates",
            .unit = "m",
            .range = kCoordinate,
            .need = Need::required});
}

}  // namespace sluice

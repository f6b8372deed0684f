#include "engine/scene/checks/check_regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/narrow_part.hpp"

namespace sluice {
namespace {

// Points on all outlines together.
constexpr std::size_t kMostRegionPoints = 4096;
constexpr double kTouching = 1e-3;  // of the spacing: a gap of rounding
// In spacings: along a slit its width changes by less over as much. What tapers is none: the gap
// under a drop that touches a pool.
constexpr double kSlitLength = 3.0;
constexpr double kSlitTaper = 0.25;

/// How far it is from a place on one region straight to another, m, if that is less than a spacing.
std::optional<double> gap_to(const ShapeN<2>& other, const OutlinePoint& from, double spacing) {
  for (const double t : chords(other, from.place, from.out)) {
    if (t < kTouching * spacing) continue;
    const bool touches = contains(other, from.place + kTouching * spacing * from.out);
    return t < (1 - kTouching) * spacing && !touches ? std::optional(t) : std::nullopt;
  }
  return std::nullopt;
}

/// The first slit along an outline to another region.
std::optional<Narrow> slit_to(const ShapeN<2>& other, const std::vector<OutlinePoint>& outline,
                              double spacing) {
  std::optional<Narrow> begin;
  for (const OutlinePoint& point : outline) {
    const auto gap = gap_to(other, point, spacing);
    const bool goes_on = gap && begin && std::abs(*gap - begin->width) < kSlitTaper * spacing;
    if (!goes_on) begin = gap ? std::optional(Narrow{*gap, point.place}) : std::nullopt;
    if (begin && (point.place - begin->place).norm() >= kSlitLength * spacing) return begin;
  }
  return std::nullopt;
}

}  // namespace

void warn_of_gaps(const Scene& scene, Problems& warnings) {
  if (scene.dimensions() != 2) return;
  const double dx = scene.method.spacing;
  for (std::size_t i = 1; i < scene.fluid.size(); ++i) {
    const ShapeN<2> region = shape_as<2>(scene.fluid[i].shape);
    const Box2 box = grown(bounds(region), dx);
    const auto points = outline(region, dx / 2, kMostRegionPoints / scene.fluid.size());
    for (std::size_t other = 0; other < i; ++other) {
      const ShapeN<2> shape = shape_as<2>(scene.fluid[other].shape);
      if (!overlap(bounds(shape), box)) continue;
      const auto slit = slit_to(shape, points, dx);
      if (!slit) continue;
      warnings.add(
          at("/fluid", i),
          fmt::format("leaves a gap of {:.3g} m, {:.2g} spacings, to /fluid/{} at "
                      "({:.4g}) m, which closes with a blow at the start; let "
                      "them touch or leave a spacing, {:.3g} m",
                      slit->width, slit->width / dx, other, fmt::join(slit->place, ", "), dx));
    }
  }
}

}  // namespace sluice

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/scene/filling/body_fill.hpp"
#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/ground.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace body_fill {

/// Upright lines along each axis of a column; as many points along dx stand outside.
inline constexpr int kLines = 4;
inline constexpr double kFar = std::numeric_limits<double>::infinity();

template <int Dim>
void add_chords(const ShapeN<Dim>& shape, const VecN<Dim>& foot, Intervals& line) {
  const std::vector<double> at = chords(shape, foot, VecN<Dim>::Unit(kUpAxis));
  for (std::size_t i = 0; i + 1 < at.size(); i += 2) line.emplace_back(at[i], at[i + 1]);
}

}  // namespace body_fill

template <int Dim>
BodyFillN<Dim>::BodyFillN(std::vector<ShapeN<Dim>> regions, std::vector<ShapeN<Dim>> solids,
                          std::optional<TankRoomN<Dim>> tank, double spacing)
    : regions_(std::move(regions)), solids_(std::move(solids)), tank_(tank), spacing_(spacing) {}

template <int Dim>
Intervals BodyFillN<Dim>::solid_line(const Foot& foot) const {
  Intervals line;
  for (const ShapeN<Dim>& solid : solids_) body_fill::add_chords<Dim>(solid, foot, line);
  return merged(std::move(line));
}

template <int Dim>
Intervals BodyFillN<Dim>::open_line(std::size_t region, const Foot& foot) const {
  Intervals line;
  body_fill::add_chords<Dim>(regions_[region], foot, line);
  return without(merged(std::move(line)), solid_line(foot));
}

template <int Dim>
Intervals BodyFillN<Dim>::tank_line(const Foot& foot) const {
  if (!tank_) return {};
  const double height = tank_->size[kUpAxis];
  Intervals line{{-body_fill::kFar, tank_->aside(foot) > 0.0 ? height : 0.0}};
  if (!tank_->open_top) line.emplace_back(height, body_fill::kFar);
  return line;
}

template <int Dim>
template <class F>
void BodyFillN<Dim>::for_each_column(std::size_t region, const F& f) const {
  using body_fill::kLines;
  const BoxN<Dim> box = bounds(regions_[region]);
  CellN<Dim> count{};
  for (int axis = 0; axis < Dim; ++axis) count[axis] = whole_cells(box.size()[axis], spacing_);
  const Point sides = box.size().cwiseQuotient(as_vector<Dim>(count));
  const CellN<Dim> last_line = on_ground<Dim>(shifted<Dim>({}, kLines - 1));
  for_each_cell<Dim>({}, on_ground<Dim>(shifted<Dim>(count, -1)), [&](const CellN<Dim>& cell) {
    const Point low = box.min + as_vector<Dim>(cell).cwiseProduct(sides);
    Column column{foot_of<Dim>(low + sides / 2), {}, 0.0};
    for_each_cell<Dim>({}, last_line, [&](const CellN<Dim>& line) {
      const Point part = (as_vector<Dim>(line).array() + 0.5) / kLines;
      const Foot foot = foot_of<Dim>(low + part.cwiseProduct(sides));
      column.lines.push_back(open_line(region, foot));
      column.measure += over_ground<Dim>(length(column.lines.back()), sides, kLines);
    });
    f(column);
  });
}

template <int Dim>
std::size_t BodyFillN<Dim>::count(std::size_t region) const {
  double sum = 0.0;
  for_each_column(region, [&](const Column& column) { sum += column.measure; });
  return static_cast<std::size_t>(std::llround(sum / cell_measure<Dim>(spacing_)));
}

template <int Dim>
std::vector<VecN<Dim>> BodyFillN<Dim>::places(std::size_t region) const {
  std::vector<Point> result;
  double sum = 0.0;
  for_each_column(region, [&](const Column& column) {
    sum += column.measure;
    const auto until = static_cast<std::size_t>(std::llround(sum / cell_measure<Dim>(spacing_)));
    if (until <= result.size()) return;
    for (const double height : middles(column.lines, until - result.size())) {
      result.push_back(column.foot);
      result.back()[kUpAxis] = height;
    }
  });
  return result;
}

template <int Dim>
std::vector<FixedPointN<Dim>> BodyFillN<Dim>::outside(
    const std::vector<std::size_t>& regions) const {
  const double reach = packing_reach(spacing_);
  const double step = spacing_ / body_fill::kLines;
  BoxN<Dim> box = bounds(regions_[regions.front()]);
  for (const std::size_t region : regions) {
    box.take_in(bounds(regions_[region]).min);
    box.take_in(bounds(regions_[region]).max);
  }
  LinesOnGround<Dim> fluid(box, step);
  for_each_cell<Dim>({}, fluid.last(), [&](const CellN<Dim>& cell) {
    Intervals line;
    for (const std::size_t region : regions) {
      body_fill::add_chords<Dim>(regions_[region], fluid.foot(cell), line);
    }
    fluid[cell] = merged(std::move(line));
  });

  std::vector<FixedPointN<Dim>> result;
  const auto margin = static_cast<std::int64_t>(std::ceil(reach / step));
  const CellN<Dim> first = on_ground<Dim>(shifted<Dim>({}, -margin));
  const CellN<Dim> last = on_ground<Dim>(shifted<Dim>(fluid.last(), margin));
  for_each_cell<Dim>(first, last, [&](const CellN<Dim>& cell) {
    // Only as far up and down as fluid within reach to the sides.
    Intervals near;
    fluid.for_each_near(cell, margin, [&](const Intervals& line) {
      for (const auto& [begin, end] : line) near.emplace_back(begin - reach, end + reach);
    });
    FixedPointN<Dim> point{fluid.foot(cell), 0.0};
    Intervals taken = solid_line(point.position);
    if (fluid.has(cell)) taken.insert(taken.end(), fluid[cell].begin(), fluid[cell].end());
    const Intervals walls = tank_line(point.position);
    taken.insert(taken.end(), walls.begin(), walls.end());
    for (const auto& [begin, end] : without(merged(std::move(near)), merged(std::move(taken)))) {
      const std::int64_t count = whole_cells(end - begin, step);
      const double rise = (end - begin) / static_cast<double>(count);
      point.volume = over_ground<Dim>(rise, fluid.sides(), 1.0) / cell_measure<Dim>(spacing_);
      for (std::int64_t i = 0; i < count; ++i) {
        point.position[kUpAxis] = begin + (static_cast<double>(i) + 0.5) * rise;
        result.push_back(point);
      }
    }
  });
  return result;
}

}  // namespace sluice

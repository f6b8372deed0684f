#include "engine/scene/filling/body_fill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

// Vertical lines over which a column's area is summed; as many points along dx stand outside.
constexpr int kLines = 4;
constexpr double kFar = std::numeric_limits<double>::infinity();

void add_chords(const Shape& shape, double x, Intervals& line) {
  const std::vector<double> at = chords(shape, Vec(x, 0.0), Vec::UnitY());
  for (std::size_t i = 0; i + 1 < at.size(); i += 2) line.emplace_back(at[i], at[i + 1]);
}

}  // namespace

BodyFill::BodyFill(const Scene& scene) : scene_(scene), solids_(solid_bodies(scene)) {}

Intervals BodyFill::solid_line(double x) const {
  Intervals line;
  for (const Shape& solid : solids_) add_chords(solid, x, line);
  return merged(std::move(line));
}

Intervals BodyFill::open_line(std::size_t region, double x) const {
  Intervals line;
  add_chords(scene_.fluid[region].shape, x, line);
  return without(merged(std::move(line)), solid_line(x));
}

template <class F>
void BodyFill::for_each_column(std::size_t region, const F& f) const {
  const Box box = bounds(scene_.fluid[region].shape);
  const std::int64_t columns = whole_cells(box.size().x(), scene_.method.spacing);
  const double width = box.size().x() / static_cast<double>(columns);
  for (std::int64_t k = 0; k < columns; ++k) {
    const double left = box.min.x() + static_cast<double>(k) * width;
    Column column{left + width / 2, {}, 0.0};
    for (int line = 0; line < kLines; ++line) {
      column.lines.push_back(open_line(region, left + (line + 0.5) / kLines * width));
      column.area += length(column.lines.back()) * width / kLines;
    }
    f(column);
  }
}

std::size_t BodyFill::count(std::size_t region) const {
  double area = 0.0;
  for_each_column(region, [&](const Column& column) { area += column.area; });
  const double dx = scene_.method.spacing;
  return static_cast<std::size_t>(std::llround(area / cell_measure<kDim>(dx)));
}

std::vector<Vec> BodyFill::places(std::size_t region) const {
  const double cell = cell_measure<kDim>(scene_.method.spacing);
  std::vector<Vec> result;
  double area = 0.0;
  for_each_column(region, [&](const Column& column) {
    area += column.area;
    const auto until = static_cast<std::size_t>(std::llround(area / cell));
    if (until <= result.size()) return;
    for (const double y : middles(column.lines, until - result.size())) {
      result.emplace_back(column.x, y);
    }
  });
  return result;
}

std::vector<FixedPoint> BodyFill::outside(const std::vector<std::size_t>& regions) const {
  const double dx = scene_.method.spacing;
  const double reach = packing_reach(dx);
  const double step = dx / kLines;
  Box box = bounds(scene_.fluid[regions.front()].shape);
  for (const std::size_t region : regions) {
    const Box other = bounds(scene_.fluid[region].shape);
    box.min = box.min.cwiseMin(other.min);
    box.max = box.max.cwiseMax(other.max);
  }

  // From each line only as far up and down as fluid within reach to either side.
  const auto margin = static_cast<std::int64_t>(std::ceil(reach / step));
  const auto inner = static_cast<std::int64_t>(std::llround(box.size().x() / step));
  const double width = box.size().x() / static_cast<double>(inner);
  const auto place = [&](std::int64_t k) {
    return box.min.x() + (static_cast<double>(k) + 0.5) * width;
  };
  std::vector<Intervals> fluid(static_cast<std::size_t>(inner));
  for (std::int64_t k = 0; k < inner; ++k) {
    Intervals line;
    for (const std::size_t region : regions) {
      add_chords(scene_.fluid[region].shape, place(k), line);
    }
    fluid[static_cast<std::size_t>(k)] = merged(std::move(line));
  }

  std::vector<FixedPoint> result;
  for (std::int64_t k = -margin; k < inner + margin; ++k) {
    const double x = place(k);
    Intervals near;
    for (std::int64_t other = std::max<std::int64_t>(k - margin, 0);
         other <= std::min(k + margin, inner - 1); ++other) {
      for (const auto& [begin, end] : fluid[static_cast<std::size_t>(other)]) {
        near.emplace_back(begin - reach, end + reach);
      }
    }
    Intervals taken = solid_line(x);
    if (k >= 0 && k < inner) {
      const Intervals& own = fluid[static_cast<std::size_t>(k)];
      taken.insert(taken.end(), own.begin(), own.end());
    }
    if (scene_.tank) {
      const bool beside = x < 0.0 || x > scene_.tank->width;
      taken.emplace_back(-kFar, beside ? scene_.tank->height : 0.0);
      if (!scene_.tank->open_top) taken.emplace_back(scene_.tank->height, kFar);
    }
    for (const auto& [begin, end] : without(merged(std::move(near)), merged(std::move(taken)))) {
      const std::int64_t count = whole_cells(end - begin, step);
      const double rise = (end - begin) / static_cast<double>(count);
      for (std::int64_t i = 0; i < count; ++i) {
        result.push_back({Vec(x, begin + (static_cast<double>(i) + 0.5) * rise),
                          rise * width / cell_measure<kDim>(dx)});
      }
    }
  }
  return result;
}

}  // namespace sluice

#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "engine/scene/filling/cells.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace cells {

/// Width in cells of the rim in which a point counts as on the boundary between cells.
inline constexpr double kRim = 1e-6;

inline std::int64_t first_center_from(double cells) {
  return static_cast<std::int64_t>(std::ceil(cells - 0.5));
}
inline std::int64_t last_center_until(double cells) {
  return static_cast<std::int64_t>(std::floor(cells - 0.5));
}

// Where the row through a place enters and leaves a shape, as x in pairs from the left, m. A shape
// without them does not compile.
template <int Dim>
std::vector<double> crossings(const Ellipsoid<Dim>& s, const VecN<Dim>& place) {
  double apart_sq = 0.0;
  for (int axis = 1; axis < Dim; ++axis) {
    const double apart = (place[axis] - s.center[axis]) / s.semi_axes[axis];
    apart_sq += apart * apart;
  }
  if (apart_sq > 1) return {};
  const double half_width = s.semi_axes[0] * std::sqrt(1 - apart_sq);
  return {s.center[0] - half_width, s.center[0] + half_width};
}
template <int Dim>
std::vector<double> crossings(const Ball<Dim>& s, const VecN<Dim>& place) {
  return crossings(Ellipsoid<Dim>{s.center, VecN<Dim>::Constant(s.radius)}, place);
}
inline std::vector<double> crossings(const Polygon& s, const VecN<2>& place) {
  const double y = place.y();
  std::vector<double> result;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const VecN<2>& a = s.points[i];
    const VecN<2>& b = s.points[(i + 1) % s.points.size()];
    if ((a.y() > y) == (b.y() > y)) continue;
    result.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(result.begin(), result.end());
  return result;
}

template <class S>
requires std::is_same_v<S, Cylinder> || std::is_same_v<S, Prism> || Meshed<S> std::vector<double>
crossings(const S& s, const VecN<3>& place) {
  return chords(s, VecN<3>(0.0, place.y(), place.z()), VecN<3>::Unit(0));
}

/// Whether a cell comes before another: by row, numbered (z, y), then along it.
template <int Dim>
bool is_before(const CellN<Dim>& one, const CellN<Dim>& other) {
  return std::lexicographical_compare(one.rbegin(), one.rend(), other.rbegin(), other.rend());
}

template <int Dim>
bool same_row(const CellN<Dim>& one, const CellN<Dim>& other) {
  return std::equal(one.begin() + 1, one.end(), other.begin() + 1);
}

}  // namespace cells

template <int Dim>
CellSetN<Dim>::CellSetN(const ShapeN<Dim>& shape, double spacing, CellFit fit)
    : step_(VecN<Dim>::Constant(spacing)) {
  std::visit([&](const auto& s) { add(s, spacing, fit); }, shape);
}

template <int Dim>
void CellSetN<Dim>::add(const Cuboid<Dim>& cuboid, double spacing, CellFit fit) {
  CellN<Dim> count;
  for (int axis = 0; axis < Dim; ++axis) count[axis] = whole_cells(cuboid.size[axis], spacing);
  origin_ = cuboid.corner;
  if (fit == CellFit::stretched) step_ = cuboid.size.cwiseQuotient(as_vector<Dim>(count));
  const CellN<Dim> last = shifted<Dim>(count, -1);
  for_each_row<Dim>({}, last, [&](const CellN<Dim>& row) { runs_.push_back({row, last[0]}); });
}

template <int Dim>
template <class Round>
void CellSetN<Dim>::add(const Round& shape, double, CellFit) {
  const BoxN<Dim> box = bounds(shape);
  CellN<Dim> first{}, last{};
  for (int axis = 1; axis < Dim; ++axis) {
    first[axis] = cells::first_center_from(box.min[axis] / step_[axis]);
    last[axis] = cells::last_center_until(box.max[axis] / step_[axis]);
  }
  for_each_row<Dim>(first, last, [&](const CellN<Dim>& row) {
    const std::vector<double> x = cells::crossings(shape, center(row));
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) add_run(row, x[i], x[i + 1]);
  });
}

template <int Dim>
void CellSetN<Dim>::add_run(CellN<Dim> row, double from, double to) {
  row[0] = cells::first_center_from(from / step_[0]);
  const std::int64_t last = cells::last_center_until(to / step_[0]);
  // Two runs of a polygon may share the cell on whose centre they meet.
  if (!runs_.empty() && cells::same_row<Dim>(runs_.back().first, row)) {
    row[0] = std::max(row[0], runs_.back().last + 1);
  }
  if (row[0] <= last) runs_.push_back({row, last});
}

template <int Dim>
VecN<Dim> CellSetN<Dim>::center(const CellN<Dim>& cell) const {
  const VecN<Dim> cells = as_vector<Dim>(cell).array() + 0.5;
  return origin_ + cells.cwiseProduct(step_);
}

template <int Dim>
std::size_t CellSetN<Dim>::size() const {
  std::size_t count = 0;
  for (const Run& run : runs_) count += static_cast<std::size_t>(run.last - run.first[0] + 1);
  return count;
}

template <int Dim>
bool CellSetN<Dim>::holds(const CellN<Dim>& first, std::int64_t last) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), first,
                                      [](const CellN<Dim>& cell, const Run& run) {
                                        return cells::is_before<Dim>(cell, run.first);
                                      });
  if (after == runs_.begin()) return false;
  const Run& run = *std::prev(after);
  return cells::same_row<Dim>(run.first, first) && last <= run.last;
}

template <int Dim>
bool CellSetN<Dim>::covers(const VecN<Dim>& point) const {
  const VecN<Dim> place = (point - origin_).cwiseQuotient(step_);
  const CellN<Dim> low = cell_at<Dim>(place.array() - cells::kRim);
  const CellN<Dim> high = cell_at<Dim>(place.array() + cells::kRim);
  bool all = true;
  for_each_row<Dim>(low, high, [&](const CellN<Dim>& row) { all = all && holds(row, high[0]); });
  return all;
}

template <int Dim>
bool CellSetN<Dim>::is_deep(const CellN<Dim>& cell, std::int64_t layers) const {
  const CellN<Dim> low = shifted<Dim>(cell, -layers), high = shifted<Dim>(cell, layers);
  bool all = true;
  for_each_row<Dim>(low, high, [&](const CellN<Dim>& row) { all = all && holds(row, high[0]); });
  return all;
}

}  // namespace sluice

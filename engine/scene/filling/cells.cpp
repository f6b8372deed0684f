#include "engine/scene/filling/cells.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

// Where the line at height y enters and leaves a polygon, m, in pairs from the left.
std::vector<double> crossings(const Polygon& polygon, double y) {
  std::vector<double> result;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    const Vec& a = polygon.points[i];
    const Vec& b = polygon.points[(i + 1) % polygon.points.size()];
    if ((a.y() > y) == (b.y() > y)) continue;
    result.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<double> crossings(const Vec& center, const Vec& semi_axes, double y) {
  const double height = (y - center.y()) / semi_axes.y();
  if (std::abs(height) > 1) return {};
  const double half_width = semi_axes.x() * std::sqrt(1 - height * height);
  return {center.x() - half_width, center.x() + half_width};
}

// A shape without a line of its own here does not compile.
struct CrossingsAt {
  double y;
  std::vector<double> operator()(const Rectangle& s) const {
    const bool meets = s.corner.y() <= y && y < s.corner.y() + s.size.y();
    if (!meets) return {};
    return {s.corner.x(), s.corner.x() + s.size.x()};
  }
  std::vector<double> operator()(const Circle& s) const {
    return crossings(s.center, Vec::Constant(s.radius), y);
  }
  std::vector<double> operator()(const Ellipse& s) const {
    return crossings(s.center, s.semi_axes, y);
  }
  std::vector<double> operator()(const Polygon& s) const { return crossings(s, y); }
};

std::vector<double> crossings(const Shape& shape, double y) {
  return std::visit(CrossingsAt{y}, shape);
}

// Width in cells of the rim in which a point counts as on the boundary between cells.
constexpr double kRim = 1e-6;

std::int64_t first_center_from(double cells) {
  return static_cast<std::int64_t>(std::ceil(cells - 0.5));
}
std::int64_t last_center_until(double cells) {
  return static_cast<std::int64_t>(std::floor(cells - 0.5));
}

}  // namespace

std::int64_t whole_cells(double length, double spacing) {
  return std::max<std::int64_t>(1, std::llround(length / spacing));
}

CellSet::CellSet(const Shape& shape, double spacing, CellFit fit) : step_(Vec::Constant(spacing)) {
  if (const auto* rectangle = std::get_if<Rectangle>(&shape)) {
    add_rectangle(*rectangle, spacing, fit);
  } else {
    add_rows(shape);
  }
}

void CellSet::add_rectangle(const Rectangle& rectangle, double spacing, CellFit fit) {
  const std::int64_t columns = whole_cells(rectangle.size.x(), spacing);
  const std::int64_t rows = whole_cells(rectangle.size.y(), spacing);
  origin_ = rectangle.corner;
  if (fit == CellFit::stretched) {
    step_ =
        rectangle.size.cwiseQuotient(Vec(static_cast<double>(columns), static_cast<double>(rows)));
  }
  for (std::int64_t row = 0; row < rows; ++row) runs_.push_back({row, 0, columns - 1});
}

void CellSet::add_rows(const Shape& shape) {
  const Box box = bounds(shape);
  const std::int64_t last = last_center_until(box.max.y() / step_.y());
  for (std::int64_t row = first_center_from(box.min.y() / step_.y()); row <= last; ++row) {
    const std::vector<double> x = crossings(shape, center(row, 0).y());
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) add_run(row, x[i], x[i + 1]);
  }
}

void CellSet::add_run(std::int64_t row, double from, double to) {
  std::int64_t first = first_center_from(from / step_.x());
  const std::int64_t last = last_center_until(to / step_.x());
  // Two runs of a polygon may share the cell on whose centre they meet.
  if (!runs_.empty() && runs_.back().row == row) first = std::max(first, runs_.back().last + 1);
  if (first <= last) runs_.push_back({row, first, last});
}

Vec CellSet::center(std::int64_t row, std::int64_t column) const {
  const Vec cells(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  return origin_ + cells.cwiseProduct(step_);
}

std::size_t CellSet::size() const {
  std::size_t count = 0;
  for (const Run& run : runs_) count += static_cast<std::size_t>(run.last - run.first + 1);
  return count;
}

bool CellSet::holds(std::int64_t row, std::int64_t first, std::int64_t last) const {
  const auto after =
      std::upper_bound(runs_.begin(), runs_.end(), first, [&](std::int64_t column, const Run& run) {
        return row < run.row || (row == run.row && column < run.first);
      });
  if (after == runs_.begin()) return false;
  const Run& run = *std::prev(after);
  return run.row == row && run.first <= first && last <= run.last;
}

bool CellSet::covers(const Vec& point) const {
  const Vec cells = (point - origin_).cwiseQuotient(step_);
  const auto cell = [](double place) { return static_cast<std::int64_t>(std::floor(place)); };
  for (std::int64_t row = cell(cells.y() - kRim); row <= cell(cells.y() + kRim); ++row) {
    if (!holds(row, cell(cells.x() - kRim), cell(cells.x() + kRim))) return false;
  }
  return true;
}

bool CellSet::is_deep(std::int64_t row, std::int64_t column, std::int64_t layers) const {
  for (std::int64_t other = row - layers; other <= row + layers; ++other) {
    if (!holds(other, column - layers, column + layers)) return false;
  }
  return true;
}

}  // namespace sluice

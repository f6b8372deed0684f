#include "engine/scene/geometry/narrow_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numbers>

namespace sluice {
namespace {

using Point = VecN<2>;

constexpr double kOffOutline = 1e-3;  // of the spacing: a point on the side of the outline
constexpr std::size_t kStepsAcross =
    64;                          // of a search; nothing thinner than a part of it is missed
constexpr double kSteep = 0.18;  // the tangent of ten degrees
constexpr int kSights = 48;
// Of the spacing: a slit below it is shut, and one sees so far through one.
constexpr double kShut = 0.25;
constexpr double kSight = 2.0;
constexpr double kAsNarrow = 1.01;

/// A narrow place and the way across.
struct Crossing {
  Narrow narrow;
  Point way = Point::Zero();
};
using Run = std::vector<Crossing>;

/// How narrow a body is along a run, unless it tapers: between the quartiles a wedge grows by 3,
/// and the rounded edge of a body grows steeply. What is much shorter than wide is a corner of
/// nearly 90 degrees.
std::optional<Narrow> narrow_body(Run run) {
  double length = 0.0;
  for (std::size_t k = 1; k < run.size(); ++k) {
    length += (run[k].narrow.place - run[k - 1].narrow.place).norm();
  }
  std::sort(run.begin(), run.end(),
            [](const Crossing& a, const Crossing& b) { return a.narrow.width < b.narrow.width; });
  const Narrow& lower = run[run.size() / 4].narrow;
  const Narrow& upper = run[(3 * run.size()) / 4].narrow;
  const bool wedge = lower.width < 0.5 * upper.width;
  const bool edge = upper.width - lower.width > kSteep * 0.5 * length;
  const bool corner = length < 0.5 * lower.width;
  if (wedge || edge || corner) return std::nullopt;
  return lower;
}

/// Whether one sees far from a place in two directions at least 120 degrees apart: out of a corner
/// one sees in fewer.
bool sees_both_ways(const SolidsN<2>& solids, const Point& place, const Point& along, double far) {
  std::vector<int> free;
  for (int k = 0; k < kSights; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSights;
    const Point across(-along.y(), along.x());
    const Point way = std::cos(angle) * along + std::sin(angle) * across;
    if (!solids.reach(place, way, far, far / kStepsAcross)) free.push_back(k);
  }
  for (const int a : free) {
    for (const int b : free) {
      const int apart = std::abs(a - b);
      if (3 * std::min(apart, kSights - apart) >= kSights) return true;
    }
  }
  return false;
}

/// The narrowest place of a gap, in the middle of those that are as narrow, if it is a slit.
std::optional<Narrow> slit(const SolidsN<2>& solids, const Run& run, double spacing) {
  const auto least = std::min_element(
      run.begin(), run.end(),
      [](const Crossing& a, const Crossing& b) { return a.narrow.width < b.narrow.width; });
  if (least->narrow.width < kShut * spacing) return std::nullopt;
  Run alike;
  std::copy_if(run.begin(), run.end(), std::back_inserter(alike), [&](const Crossing& each) {
    return each.narrow.width <= kAsNarrow * least->narrow.width;
  });
  const Crossing& middle = alike[alike.size() / 2];
  const Point inside = middle.narrow.place + 0.5 * middle.narrow.width * middle.way;
  const Point along(middle.way.y(), -middle.way.x());
  if (!sees_both_ways(solids, inside, along, kSight * spacing)) return std::nullopt;
  return Narrow{least->narrow.width, middle.narrow.place};
}

/// The runs of neighbours that have a width; `widths` goes round.
std::vector<Run> runs_of(const std::vector<std::optional<Crossing>>& widths) {
  const auto wide =
      std::find_if(widths.begin(), widths.end(), [](const auto& each) { return !each; });
  const auto start = static_cast<std::size_t>(wide - widths.begin());
  std::vector<Run> runs(1);
  for (std::size_t k = 0; k < widths.size(); ++k) {
    const auto& each = widths[(start + k) % widths.size()];
    if (each) {
      runs.back().push_back(*each);
    } else if (!runs.back().empty()) {
      runs.emplace_back();
    }
  }
  if (runs.back().empty()) runs.pop_back();
  return runs;
}

}  // namespace

std::optional<Narrow> narrow_part(const SolidsN<2>& solids,
                                  const std::vector<OutlinePoint>& outline, Across across,
                                  double most, double spacing) {
  const double off = kOffOutline * spacing;
  const bool solid = across == Across::solid;
  std::vector<std::optional<Crossing>> widths;
  for (const OutlinePoint& point : outline) {
    widths.emplace_back();
    const Point before = point.place + off * point.out;
    const Point behind = point.place - off * point.out;
    // Covered by another solid, or by the outline itself where it turns sharply.
    if (solids.holds(before) || !solids.holds(behind)) continue;
    const Point way = solid ? Point(-point.out) : point.out;
    const auto width = solids.reach(solid ? behind : before, way, most - off, most / kStepsAcross);
    if (width) widths.back() = Crossing{{*width + off, point.place}, way};
  }
  std::optional<Narrow> best;
  for (const Run& run : runs_of(widths)) {
    const auto found = solid ? narrow_body(run) : slit(solids, run, spacing);
    if (found && (!best || found->width < best->width)) best = found;
  }
  return best;
}

}  // namespace sluice

#include "engine/scene/filling/water_level.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/tank_room.hpp"

namespace sluice {
namespace {

bool move_alike(const FluidRegion& a, const FluidRegion& b) {
  return a.velocity == b.velocity && a.strain_rate == b.strain_rate &&
         a.rotation_rate == b.rotation_rate;
}

}  // namespace

WaterLevels::WaterLevels(const Scene& scene) : scene_(scene), solids_(solid_bodies(scene)) {
  const Vec& f = scene.method.gravity;
  // f . x is smallest at the region's highest point against f.
  for (const FluidRegion& region : scene.fluid) {
    regions_.push_back({-farthest_along(region.shape, -f), 0.0, {}});
  }
  if (f.isZero(0.0) || scene.fluid.size() < 2) return;
  up_ = -f.normalized();
  across_ = Vec(up_.y(), -up_.x());

  std::vector<bool> open;
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    const std::vector<std::optional<Climb>> found = climbs(i);
    take_nearest_open(i, found);
    open.push_back(std::any_of(found.begin(), found.end(),
                               [](const auto& each) { return each && each->open; }));
  }
  share_with_covered(std::move(open));
}

double WaterLevels::pressure(std::size_t region, const Vec& point) const {
  if (scene_.fluid[region].pressure == InitialPressure::zero) return 0.0;
  const Method& method = scene_.method;
  return method.reference_density * (method.gravity.dot(point) - level_at(region, point));
}

double WaterLevels::level_at(std::size_t region, const Vec& point) const {
  const Levels& levels = regions_[region];
  if (levels.columns.empty()) return levels.own;
  const double last = static_cast<double>(levels.columns.size() - 1);
  const double column = std::floor((across_.dot(point) - levels.first) / scene_.method.spacing);
  return levels.columns[static_cast<std::size_t>(std::clamp(column, 0.0, last))];
}

bool WaterLevels::joined(std::size_t a, std::size_t b) const {
  const FluidRegion& one = scene_.fluid[a];
  const FluidRegion& other = scene_.fluid[b];
  return a != b && move_alike(one, other) && one.pressure == other.pressure;
}

bool WaterLevels::blocked(const Vec& foot, double from, double to) const {
  return std::any_of(solids_.begin(), solids_.end(), [&](const Shape& solid) {
    const std::vector<double> inside = chords(solid, foot, up_);
    for (std::size_t i = 0; i + 1 < inside.size(); i += 2) {
      if (inside[i] <= to && inside[i + 1] >= from) return true;
    }
    return false;
  });
}

bool WaterLevels::below_tank(const Vec& point) const {
  if (!scene_.tank) return false;
  const TankRoom tank = room_of(*scene_.tank);
  if (tank.over(point) > 0.0) return !tank.open_top;
  return !tank.between_sides(point) || point[kUpAxis] < 0.0;
}

std::optional<WaterLevels::Climb> WaterLevels::climb(std::size_t region, double across) const {
  const double dx = scene_.method.spacing;
  const Vec foot = across * across_;
  const std::vector<double> own = chords(scene_.fluid[region].shape, foot, up_);
  if (own.empty()) return std::nullopt;
  double top = own.back();
  Climb result{regions_[region].own, true};
  for (bool higher = true; higher;) {
    higher = false;
    for (std::size_t other = 0; other < scene_.fluid.size(); ++other) {
      if (!joined(region, other)) continue;
      const std::vector<double> inside = chords(scene_.fluid[other].shape, foot, up_);
      for (std::size_t i = 0; i + 1 < inside.size(); i += 2) {
        const double begin = inside[i], end = inside[i + 1];
        // Less than a thousandth higher is rounding.
        if (begin > top + 1.001 * dx || end <= top + 1e-3 * dx) continue;
        if (blocked(foot, top, std::max(begin, top))) continue;
        top = end;
        result.level = std::min(result.level, regions_[other].own);
        higher = true;
      }
    }
  }
  const double reach = dx / 2;
  result.open = !blocked(foot, top, top + reach) && !below_tank(foot + (top + reach) * up_);
  return result;
}

std::vector<std::optional<WaterLevels::Climb>> WaterLevels::climbs(std::size_t region) const {
  const Shape& shape = scene_.fluid[region].shape;
  const double first = -farthest_along(shape, -across_);
  const double dx = scene_.method.spacing;
  const double width = farthest_along(shape, across_) - first;
  std::vector<std::optional<Climb>> found;
  for (double column = 0.5; column == 0.5 || column * dx < width; column += 1.0) {
    found.push_back(climb(region, first + std::min(column * dx, width / 2 + column * dx / 2)));
  }
  return found;
}

void WaterLevels::take_nearest_open(std::size_t region,
                                    const std::vector<std::optional<Climb>>& climbs) {
  Levels& levels = regions_[region];
  levels.first = -farthest_along(scene_.fluid[region].shape, -across_);
  const auto count = climbs.size();
  const auto is_open = [&](std::size_t i) { return i < count && climbs[i] && climbs[i]->open; };
  // Two passes find the nearest open column to either side.
  std::vector<std::size_t> left(count, count), right(count, count);
  for (std::size_t i = 0, at = count; i < count; ++i) left[i] = at = is_open(i) ? i : at;
  for (std::size_t i = count, at = count; i-- > 0;) right[i] = at = is_open(i) ? i : at;
  for (std::size_t i = 0; i < count; ++i) {
    const bool by_left = is_open(left[i]) && (!is_open(right[i]) || i - left[i] <= right[i] - i);
    const std::size_t nearest = by_left ? left[i] : right[i];
    const double covered = climbs[i] ? climbs[i]->level : levels.own;
    levels.columns.push_back(is_open(nearest) ? climbs[nearest]->level : covered);
  }
}

/// Somewhere in both regions' bounds, widened until they may touch, and in no solid.
std::optional<Vec> WaterLevels::touch(std::size_t a, std::size_t b) const {
  const Box one = bounds(scene_.fluid[a].shape);
  const Box other = bounds(scene_.fluid[b].shape);
  const Vec low = one.min.cwiseMax(other.min);
  const Vec high = one.max.cwiseMin(other.max);
  if ((high - low).minCoeff() < -1.001 * scene_.method.spacing) return std::nullopt;
  const Vec middle = (low + high) / 2;
  const bool solid = std::any_of(solids_.begin(), solids_.end(),
                                 [&](const Shape& each) { return contains(each, middle); });
  if (solid) return std::nullopt;
  return middle;
}

void WaterLevels::share_with_covered(std::vector<bool> open) {
  const std::size_t count = regions_.size();
  for (std::size_t round = 0; round < count; ++round) {
    const std::vector<bool> known = open;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t other = 0; other < count && !open[i]; ++other) {
        if (!known[other] || !joined(i, other)) continue;
        const std::optional<Vec> place = touch(i, other);
        // A level below the region's own top is no level of it.
        if (!place || level_at(other, *place) > regions_[i].own) continue;
        regions_[i].columns.assign(1, level_at(other, *place));
        open[i] = true;
      }
    }
  }
}

}  // namespace sluice

#include "engine/scene/filling/water_level.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/tank_room.hpp"

namespace sluice {
namespace {

bool move_alike(const FluidRegion& a, const FluidRegion& b) {
  return a.velocity == b.velocity && a.strain_rate == b.strain_rate &&
         a.rotation_rate == b.rotation_rate;
}

/// Unit vectors across `up` and one another.
std::vector<Vec> vectors_across(const Vec& up) {
  if (up.size() == 2) return {Vec2(up.y(), -up.x())};
  // The axis that is farthest from up, without its part along up.
  const Vec3 upwards = up;
  Eigen::Index axis = 0;
  upwards.cwiseAbs().minCoeff(&axis);
  const Vec3 first = (Vec3::Unit(axis) - upwards[axis] * upwards).normalized();
  return {first, first.cross(upwards)};
}

/// The nearest true place of each place of a grid, in steps along its axes; of two as near the one
/// that comes first. The place itself where there is none.
std::vector<std::size_t> nearest_true(const std::vector<bool>& is_true,
                                      const std::array<std::size_t, 2>& count) {
  const std::size_t none = is_true.size();
  std::vector<std::size_t> nearest(is_true.size(), none);
  std::deque<std::size_t> next;
  for (std::size_t i = 0; i < is_true.size(); ++i) {
    if (!is_true[i]) continue;
    nearest[i] = i;
    next.push_back(i);
  }
  while (!next.empty()) {
    const std::size_t i = next.front();
    next.pop_front();
    const auto spread = [&](bool inside, std::size_t to) {
      if (!inside || nearest[to] != none) return;
      nearest[to] = nearest[i];
      next.push_back(to);
    };
    const std::size_t along = i % count[0], across = i / count[0];
    spread(along > 0, i - 1);
    spread(along + 1 < count[0], i + 1);
    spread(across > 0, i - count[0]);
    spread(across + 1 < count[1], i + count[0]);
  }
  for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = nearest[i] == none ? i : nearest[i];
  return nearest;
}

}  // namespace

WaterLevels::WaterLevels(const Scene& scene) : scene_(scene), solids_(solid_bodies(scene)) {
  const Vec& f = scene.method.gravity;
  // f . x is smallest at the region's highest point against f.
  for (const FluidRegion& region : scene.fluid) {
    regions_.emplace_back().own = -farthest_along(region.shape, -f);
  }
  if (f.isZero(0.0) || scene.fluid.size() < 2) return;
  up_ = -f.normalized();
  across_ = vectors_across(up_);

  std::vector<bool> open;
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    lay_columns(i);
    const Climbs found = climbs(i);
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
  std::size_t index = 0;
  for (std::size_t k = across_.size(); k-- > 0;) {
    const double last = static_cast<double>(levels.count[k] - 1);
    const double column =
        std::floor((across_[k].dot(point) - levels.first[k]) / scene_.method.spacing);
    index = index * levels.count[k] + static_cast<std::size_t>(std::clamp(column, 0.0, last));
  }
  return levels.columns[index];
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
  return in_dimensions(scene_.dimensions(), [&]<int Dim>() {
    const TankRoomN<Dim> tank = room_of<Dim>(*scene_.tank);
    if (tank.over(point) > 0.0) return !tank.open_top;
    return !tank.between_sides(point) || point[kUpAxis] < 0.0;
  });
}

std::optional<WaterLevels::Climb> WaterLevels::climb(std::size_t region,
                                                     const Across& place) const {
  const double dx = scene_.method.spacing;
  Vec foot = place[0] * across_[0];
  if (across_.size() > 1) foot += place[1] * across_[1];
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

void WaterLevels::lay_columns(std::size_t region) {
  const Shape& shape = scene_.fluid[region].shape;
  Levels& levels = regions_[region];
  const double dx = scene_.method.spacing;
  for (std::size_t k = 0; k < across_.size(); ++k) {
    levels.first[k] = -farthest_along(shape, -across_[k]);
    const double width = farthest_along(shape, across_[k]) - levels.first[k];
    levels.count[k] = 0;
    for (double column = 0.5; column == 0.5 || column * dx < width; column += 1.0) {
      ++levels.count[k];
    }
  }
}

WaterLevels::Climbs WaterLevels::climbs(std::size_t region) const {
  const Shape& shape = scene_.fluid[region].shape;
  const Levels& levels = regions_[region];
  const double dx = scene_.method.spacing;
  Across width{};
  for (std::size_t k = 0; k < across_.size(); ++k) {
    width[k] = farthest_along(shape, across_[k]) - levels.first[k];
  }
  const auto place = [&](std::size_t k, std::size_t i) {
    const double column = static_cast<double>(i) + 0.5;
    return levels.first[k] + std::min(column * dx, width[k] / 2 + column * dx / 2);
  };
  Climbs found;
  for (std::size_t j = 0; j < levels.count[1]; ++j) {
    for (std::size_t i = 0; i < levels.count[0]; ++i) {
      found.push_back(climb(region, {place(0, i), place(1, j)}));
    }
  }
  return found;
}

void WaterLevels::take_nearest_open(std::size_t region, const Climbs& climbs) {
  Levels& levels = regions_[region];
  std::vector<bool> is_open;
  for (const auto& each : climbs) is_open.push_back(each && each->open);
  const std::vector<std::size_t> nearest = nearest_true(is_open, levels.count);
  for (std::size_t i = 0; i < climbs.size(); ++i) {
    const auto& from = climbs[nearest[i]];
    levels.columns.push_back(from ? from->level : levels.own);
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
        regions_[i].count = {1, 1};
        open[i] = true;
      }
    }
  }
}

}  // namespace sluice

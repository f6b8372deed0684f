#include "engine/scene/geometry/leaks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "engine/scene/geometry/directions.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/solids.hpp"
#include "engine/scene/geometry/too_thin.hpp"

namespace sluice {
namespace {

constexpr double kShallow = 0.4;  // spacings; nobody has leaked who is less deep
constexpr double kDeepEnough = 1.01;
constexpr int kWays = 8;  // across a solid
constexpr double kStepsPerSpacing = 8;

bool is_deep(const GateMotion& gate, const Vec& place, double time, double depth) {
  Box standing = gate.place;
  standing.min[kUpAxis] += gate.speed * time;
  return grown(standing, -depth).contains(place);
}

void add_tank(const TankRoom& tank, double depth, FlowDomain& domain) {
  domain.room = {Vec::Constant(-depth), tank.size.array() + depth};
  if (!tank.open_top) return;
  domain.room.max[kUpAxis] = std::numeric_limits<double>::infinity();
  domain.walls_reach = tank.size[kUpAxis] - depth;
}

/// The obstacles, with all that is needed to say who is deep in them.
class Obstacles {
 public:
  explicit Obstacles(const Scene& scene)
      : scene_(std::make_shared<const Scene>(scene)),
        solids_(solids_of(*scene_)),
        spacing_(scene.method.spacing),
        ways_(half_of_directions<kDim>(kWays)) {
    for (const Shape& shape : scene_->obstacles) boxes_.push_back(bounds(shape));
  }

  [[nodiscard]] bool hold_deep(const Vec& place) const {
    if (!hold(place)) return false;
    const double depth = solids_.depth(place, kDeepEnough * spacing_);
    return depth > kShallow * spacing_ && depth > allowed_depth(thickness(place), spacing_);
  }

 private:
  [[nodiscard]] bool hold(const Vec& place) const {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (boxes_[i].contains(place) && contains(scene_->obstacles[i], place)) return true;
    }
    return false;
  }

  /// How thick what is solid is around a place, m, where it keeps fluid from fluid; what is thicker
  /// than four spacings counts as that, and so does a tip: fluid flows round it anyway.
  [[nodiscard]] double thickness(const Vec& place) const {
    const double thick = 4 * spacing_;
    const double beyond = 0.5 * spacing_;
    double least = thick;
    Vec one = place;
    Vec other = place;
    for (const Vec& way : ways_) {
      const auto to_open = [&](const Vec& direction) {
        const double step = spacing_ / kStepsPerSpacing;
        return solids_.reach(place, direction, least, step).value_or(least);
      };
      const double ahead = to_open(way);
      const double back = to_open(-way);
      if (ahead + back >= least) continue;
      least = ahead + back;
      one = place + (ahead + beyond) * way;
      other = place - (back + beyond) * way;
    }
    const bool thin = least < thick && keeps_apart(solids_, one, other, least, spacing_);
    return thin ? least : thick;
  }

  std::shared_ptr<const Scene> scene_;  ///< that the solids are of
  Solids solids_;
  double spacing_;
  std::vector<Vec> ways_;  ///< in which a thickness is sought
  std::vector<Box> boxes_;
};

}  // namespace

double allowed_depth(double thickness, double spacing) {
  return std::clamp(0.6 * 0.5 * thickness, kShallow * spacing, spacing);
}

FlowDomain domain_with_solids(const Scene& scene) {
  FlowDomain domain = scene.domain;
  const double depth = scene.method.spacing;
  if (scene.tank) add_tank(room_of(*scene.tank), depth, domain);
  if (scene.obstacles.empty() && !domain.gate) return domain;
  Scene solid;
  solid.tank = scene.tank;
  solid.obstacles = scene.obstacles;
  solid.method.spacing = scene.method.spacing;
  domain.in_solid = [obstacles = Obstacles(solid), gate = domain.gate, depth](const Vec& place,
                                                                              double time) {
    return (gate && is_deep(*gate, place, time, depth)) || obstacles.hold_deep(place);
  };
  return domain;
}

}  // namespace sluice

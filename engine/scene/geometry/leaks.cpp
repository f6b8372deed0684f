#include "engine/scene/geometry/leaks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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
template <int Dim>
constexpr int kWays = Dim == 2 ? 8 : 32;  // across a solid
constexpr double kStepsPerSpacing = 8;

void add_tank(const Tank& tank, double depth, FlowDomain& domain) {
  domain.room = grown(tank.interior(), depth);
  if (!tank.open_top) return;
  domain.room.max[kUpAxis] = std::numeric_limits<double>::infinity();
  domain.walls_reach = tank.height - depth;
}

/// The obstacles, with all that is needed to say who is deep in them.
template <int Dim>
class Obstacles {
 public:
  using Point = VecN<Dim>;

  explicit Obstacles(const Scene& scene)
      : shapes_(shapes_as<Dim>(scene.obstacles)),
        solids_(solids_of<Dim>(scene)),
        spacing_(scene.method.spacing),
        ways_(half_of_directions<Dim>(kWays<Dim>)) {
    for (const ShapeN<Dim>& shape : shapes_) boxes_.push_back(bounds(shape));
  }

  [[nodiscard]] bool hold_deep(const Point& place) const {
    if (!hold(place)) return false;
    const double depth = solids_.depth(place, kDeepEnough * spacing_);
    return depth > kShallow * spacing_ && depth > allowed_depth(thickness(place), spacing_);
  }

 private:
  [[nodiscard]] bool hold(const Point& place) const {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (boxes_[i].contains(place) && contains(shapes_[i], place)) return true;
    }
    return false;
  }

  /// How thick what is solid is around a place, m, where it keeps fluid from fluid; what is thicker
  /// than four spacings counts as that, and so does a tip: fluid flows round it anyway.
  [[nodiscard]] double thickness(const Point& place) const {
    const double thick = 4 * spacing_;
    const double beyond = 0.5 * spacing_;
    double least = thick;
    Point one = place;
    Point other = place;
    for (const Point& way : ways_) {
      const auto to_open = [&](const Point& direction) {
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

  std::vector<ShapeN<Dim>> shapes_;
  SolidsN<Dim> solids_;
  double spacing_;
  std::vector<Point> ways_;  ///< in which a thickness is sought
  std::vector<BoxN<Dim>> boxes_;
};

template <int Dim>
std::function<bool(const Vec&, double)> in_solids_of(const Scene& scene) {
  std::optional<GateMotionN<Dim>> inside_gate;
  if (const auto& gate = scene.domain.gate) {
    inside_gate = {grown(BoxN<Dim>(gate->place), -scene.method.spacing), gate->speed};
  }
  return [obstacles = std::make_shared<const Obstacles<Dim>>(scene), inside_gate](const Vec& any,
                                                                                  double time) {
    const VecN<Dim> place = any;
    const bool in_gate =
        inside_gate && inside_gate->place.contains(place) && !inside_gate->has_passed(place, time);
    return in_gate || obstacles->hold_deep(place);
  };
}

}  // namespace

double allowed_depth(double thickness, double spacing) {
  return std::clamp(0.6 * 0.5 * thickness, kShallow * spacing, spacing);
}

FlowDomain domain_with_solids(const Scene& scene) {
  FlowDomain domain = scene.domain;
  const double depth = scene.method.spacing;
  if (scene.tank) add_tank(*scene.tank, depth, domain);
  if (scene.obstacles.empty() && !domain.gate) return domain;
  domain.in_solid =
      in_dimensions(scene.dimensions(), [&]<int Dim>() { return in_solids_of<Dim>(scene); });
  return domain;
}

}  // namespace sluice

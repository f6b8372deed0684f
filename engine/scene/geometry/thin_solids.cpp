#include "engine/scene/geometry/thin_solids.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sluice {
namespace {

using Point = VecN<2>;

// Lengths in spacings.
constexpr double kNear = kThinnestSolid + 2 * kRoom;   // apart on two sides of what is too thin
constexpr double kAround = kNear + 1.5 * kGridMargin;  // what is looked at first

constexpr double kRounding = 1e-6;  // of the thickness: rounding
constexpr double kDisc = 0.999;     // of a disc: so much of it must lie in the solid
constexpr int kDiscPoints = 16;
constexpr int kHalvings = 24;  // of a bisection
constexpr double kAlongRay = 0.25;

/// Directions from the inward normal, degrees; the normal first, for it is exact across a plate.
constexpr std::array kTurns = {0, -15, 15, -30, 30, -45, 45, -60, 60, -75, 75};

Point turned(const Point& v, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle) * v.x() - std::sin(angle) * v.y(),
          std::sin(angle) * v.x() + std::cos(angle) * v.y()};
}

bool holds_disc(const SolidsN<2>& solids, const Point& center, double radius) {
  for (int k = 0; k < kDiscPoints; ++k) {
    const Point unit = turned(Point(1, 0), 360.0 * k / kDiscPoints);
    if (!solids.holds(center + radius * unit)) return false;
  }
  return true;
}

class ThinSearch {
 public:
  ThinSearch(const SolidsN<2>& solids, double spacing)
      : solids_(solids), spacing_(spacing), ways_(solids, spacing) {}

  [[nodiscard]] std::optional<Narrow> thinnest(const std::vector<OutlinePoint>& outline) {
    std::optional<Narrow> best;
    bool thick = false;
    for (const OutlinePoint& point : outline) {
      thick = thick || holds_disc_near(point);
      if (lies_on_thick(point)) continue;
      const auto found = thinnest_at(point, best ? best->width : kThinnestSolid * spacing_);
      if (found) best = found;
    }
    if (!best && !thick) best = width_of_all(outline);
    return best;
  }

 private:
  [[nodiscard]] bool has_room(const Point& place) const {
    return solids_.leaves_room(place, kRoom * spacing_);
  }

  /// Whether the largest disc that a solid must hold touches the outline from within at this point,
  /// twice over: blocks that touch with corners are thick up to there.
  [[nodiscard]] bool lies_on_thick(const OutlinePoint& point) const {
    const double radius = kThinnestSolid * spacing_;
    return holds_disc(solids_, point.place - radius * point.out, kDisc * radius);
  }

  /// The same of the disc itself, moved along the outline to where it fits best.
  [[nodiscard]] bool holds_disc_near(const OutlinePoint& point) const {
    const double radius = 0.5 * kThinnestSolid * spacing_;
    const Point center = point.place - radius * point.out;
    if (holds_disc(solids_, center, kDisc * radius)) return true;
    if (!solids_.holds(center)) return false;
    const Point along(point.out.y(), -point.out.x());
    const auto room = [&](const Point& way) {
      return solids_.reach(center, way, 2 * radius, radius / 4).value_or(2 * radius);
    };
    const double move = 0.5 * (room(along) - room(-along));
    return holds_disc(solids_, center + move * along, kDisc * radius);
  }

  /// How far it is from a place to where particles have room again behind a solid, m.
  [[nodiscard]] std::optional<double> across(const Point& from, const Point& way,
                                             double most) const {
    bool solid = false;
    double last = 0.0;
    for (double t = kAlongRay * spacing_; last < most; last = t, t += kAlongRay * spacing_) {
      const bool room = has_room(from + t * way);
      solid = solid || !room;
      if (!solid || !room) continue;
      double near = last;
      double far = t;
      for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (near + far);
        (has_room(from + middle * way) ? far : near) = middle;
      }
      return far < most ? std::optional(far) : std::nullopt;
    }
    return std::nullopt;
  }

  /// The thinnest below `most`, m, near this point.
  [[nodiscard]] std::optional<Narrow> thinnest_at(const OutlinePoint& point, double most) {
    const Point from = point.place + kRoom * spacing_ * point.out;
    if (!has_room(from)) return std::nullopt;
    ways_.seek(from, kAround, kLongestWay);
    if (ways_.shut() || !ways_.miss_somebody(kAround - kGridMargin)) return std::nullopt;

    struct Other {
      Point place;
      double width;
    };
    std::vector<Other> others;
    const double gaps = 2 * kRoom * spacing_;
    for (const double turn : kTurns) {
      const Point way = turned(-point.out, turn);
      const auto distance = across(from, way, gaps + most * (1 - kRounding));
      if (distance) others.push_back({from + *distance * way, *distance - gaps});
    }
    if (others.empty()) return std::nullopt;
    std::sort(others.begin(), others.end(),
              [](const Other& a, const Other& b) { return a.width < b.width; });
    ways_.seek(from, kAroundLongestWay, kLongestWay);
    for (const Other& other : others) {
      if (is_long_way(ways_, other.place, other.width / spacing_)) {
        return Narrow{other.width, 0.5 * (from + other.place)};
      }
    }
    return std::nullopt;
  }

  /// The diameter of the largest disc that touches one of some points of the outline from within.
  [[nodiscard]] std::optional<Narrow> width_of_all(const std::vector<OutlinePoint>& outline) const {
    constexpr std::size_t kPoints = 64;
    Narrow widest;
    for (std::size_t k = 0; k < outline.size(); k += 1 + outline.size() / kPoints) {
      double low = 0.0;
      double high = kThinnestSolid * spacing_;
      for (int step = 0; step < kHalvings; ++step) {
        const double middle = 0.5 * (low + high);
        const Point center = outline[k].place - 0.5 * middle * outline[k].out;
        (holds_disc(solids_, center, kDisc * 0.5 * middle) ? low : high) = middle;
      }
      if (low > widest.width) widest = {low, outline[k].place - 0.5 * low * outline[k].out};
    }
    return widest;
  }

  const SolidsN<2>& solids_;
  double spacing_;
  WaysN<2> ways_;
};

}  // namespace

std::optional<Narrow> thin_part(const SolidsN<2>& solids, const std::vector<OutlinePoint>& outline,
                                double spacing) {
  return ThinSearch(solids, spacing).thinnest(outline);
}

}  // namespace sluice

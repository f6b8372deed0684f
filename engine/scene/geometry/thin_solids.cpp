#include "engine/scene/geometry/thin_solids.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry/ways.hpp"

namespace sluice {
namespace {

// Lengths in spacings.
constexpr double kRoom = 0.5;                         // from a solid to the nearest particle
constexpr double kNear = kThinnestSolid + 2 * kRoom;  // apart on two sides of what is too thin
constexpr double kMargin = 0.5;                       // for the grid
constexpr double kAround = kNear + 1.5 * kMargin;     // what is looked at first
constexpr double kWayPerThickness = 7.0;
constexpr double kShortWay = 2.0;  // round a corner of no thickness
constexpr double kLongestWay = kShortWay + kWayPerThickness * kThinnestSolid;

constexpr double kRounding = 1e-6;  // of the thickness: rounding
constexpr double kDisc = 0.999;     // of a disc: so much of it must lie in the solid
constexpr int kDiscPoints = 16;
constexpr int kHalvings = 24;  // of a bisection
constexpr double kAlongRay = 0.25;

/// Directions from the inward normal, degrees; the normal first, for it is exact across a plate.
constexpr std::array kTurns = {0, -15, 15, -30, 30, -45, 45, -60, 60, -75, 75};

Vec turned(const Vec& v, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle) * v.x() - std::sin(angle) * v.y(),
          std::sin(angle) * v.x() + std::cos(angle) * v.y()};
}

bool holds_disc(const Solids& solids, const Vec& center, double radius) {
  for (int k = 0; k < kDiscPoints; ++k) {
    const Vec unit = turned(Vec(1, 0), 360.0 * k / kDiscPoints);
    if (!solids.holds(center + radius * unit)) return false;
  }
  return true;
}

/// Whether the way that was sought to a place is long for a thickness in spacings.
bool is_far(Ways& ways, const Vec& place, double thickness) {
  const auto length = ways.length_to(place);
  const double allowed = kWayPerThickness * std::clamp(thickness, 0.0, kThinnestSolid);
  return length && *length > kShortWay + allowed;
}

class ThinSearch {
 public:
  ThinSearch(const Solids& solids, double spacing)
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
  [[nodiscard]] bool has_room(const Vec& place) const {
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
    const Vec center = point.place - radius * point.out;
    if (holds_disc(solids_, center, kDisc * radius)) return true;
    if (!solids_.holds(center)) return false;
    const Vec along(point.out.y(), -point.out.x());
    const auto room = [&](const Vec& way) {
      return solids_.reach(center, way, 2 * radius, radius / 4).value_or(2 * radius);
    };
    const double move = 0.5 * (room(along) - room(-along));
    return holds_disc(solids_, center + move * along, kDisc * radius);
  }

  /// How far it is from a place to where particles have room again behind a solid, m.
  [[nodiscard]] std::optional<double> across(const Vec& from, const Vec& way, double most) const {
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
    const Vec from = point.place + kRoom * spacing_ * point.out;
    if (!has_room(from)) return std::nullopt;
    ways_.seek(from, kAround, kLongestWay);
    if (ways_.shut() || !ways_.miss_somebody(kAround - kMargin)) return std::nullopt;

    struct Other {
      Vec place;
      double width;
    };
    std::vector<Other> others;
    const double gaps = 2 * kRoom * spacing_;
    for (const double turn : kTurns) {
      const Vec way = turned(-point.out, turn);
      const auto distance = across(from, way, gaps + most * (1 - kRounding));
      if (distance) others.push_back({from + *distance * way, *distance - gaps});
    }
    if (others.empty()) return std::nullopt;
    std::sort(others.begin(), others.end(),
              [](const Other& a, const Other& b) { return a.width < b.width; });
    ways_.seek(from, 0.5 * kLongestWay + kMargin, kLongestWay);
    for (const Other& other : others) {
      if (is_far(ways_, other.place, other.width / spacing_)) {
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
        const Vec center = outline[k].place - 0.5 * middle * outline[k].out;
        (holds_disc(solids_, center, kDisc * 0.5 * middle) ? low : high) = middle;
      }
      if (low > widest.width) widest = {low, outline[k].place - 0.5 * low * outline[k].out};
    }
    return widest;
  }

  const Solids& solids_;
  double spacing_;
  Ways ways_;
};

}  // namespace

std::optional<Narrow> thin_part(const Solids& solids, const std::vector<OutlinePoint>& outline,
                                double spacing) {
  return ThinSearch(solids, spacing).thinnest(outline);
}

bool keeps_apart(const Solids& solids, const Vec& one, const Vec& other, double thickness,
                 double spacing) {
  Ways ways(solids, spacing);
  ways.seek(one, 0.5 * kLongestWay + kMargin, kLongestWay);
  return !ways.shut() && is_far(ways, other, thickness / spacing);
}

}  // namespace sluice

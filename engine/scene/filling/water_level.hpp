#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Where the pressure of water at rest is zero, for each point of the fluid. Columns of water stand
/// side by side: in the plane along a line, in space on a grid.
///
/// A region by itself has one level: its highest point against gravity f. Regions that touch
/// (within a spacing, with no obstacle between) and move alike are one body: a point below another
/// region, straight against f, is as deep as that one's level says. A column beside a shallow bed
/// therefore keeps its own depth and the bed its own, while a bed that reaches below the column
/// carries it. Below an obstacle, a lid or the tank's side the level is that of the nearest column
/// of the region that is open; a region without one takes that of a region it touches.
class WaterLevels {
 public:
  explicit WaterLevels(const Scene& scene);

  /// Pressure at a point of a region, Pa: rho_0 f . (x - x_level); 0 where the region asks for
  /// zero.
  [[nodiscard]] double pressure(std::size_t region, const Vec& point) const;

 private:
  /// A place across f, along each of across_, m; in the plane the second one is 0.
  using Across = std::array<double, 2>;
  /// Levels, as f . x, of columns along f that are a spacing wide; none: one level everywhere.
  struct Levels {
    double own = 0.0;
    Across first{};  ///< where the first column begins
    std::array<std::size_t, 2> count{1, 1};
    std::vector<double> columns;  ///< along the first of across_ fastest
  };
  struct Climb {
    double level = 0.0;
    bool open = true;
  };
  using Climbs = std::vector<std::optional<Climb>>;

  [[nodiscard]] bool joined(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool blocked(const Vec& foot, double from, double to) const;
  [[nodiscard]] bool below_tank(const Vec& point) const;
  [[nodiscard]] std::optional<Climb> climb(std::size_t region, const Across& place) const;
  void lay_columns(std::size_t region);
  [[nodiscard]] Climbs climbs(std::size_t region) const;
  void take_nearest_open(std::size_t region, const Climbs& climbs);
  void share_with_covered(std::vector<bool> open);
  [[nodiscard]] std::optional<Vec> touch(std::size_t a, std::size_t b) const;
  [[nodiscard]] double level_at(std::size_t region, const Vec& point) const;

  const Scene& scene_;
  std::vector<Shape> solids_;
  Vec up_;
  std::vector<Vec> across_;  ///< d - 1 unit vectors across f and one another
  std::vector<Levels> regions_;
};

}  // namespace sluice

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Where the pressure of water at rest is zero, for each point of the fluid; in the plane, where
/// columns of water stand side by side along one line.
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
  /// Levels, as f . x, of columns along f that are a spacing wide; empty: one level everywhere.
  struct Levels {
    double own = 0.0;
    double first = 0.0;  ///< where the first column begins, along across_
    std::vector<double> columns;
  };
  struct Climb {
    double level = 0.0;
    bool open = true;
  };

  [[nodiscard]] bool joined(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool blocked(const Vec& foot, double from, double to) const;
  [[nodiscard]] bool below_tank(const Vec& point) const;
  [[nodiscard]] std::optional<Climb> climb(std::size_t region, double across) const;
  [[nodiscard]] std::vector<std::optional<Climb>> climbs(std::size_t region) const;
  void take_nearest_open(std::size_t region, const std::vector<std::optional<Climb>>& climbs);
  void share_with_covered(std::vector<bool> open);
  [[nodiscard]] std::optional<Vec> touch(std::size_t a, std::size_t b) const;
  [[nodiscard]] double level_at(std::size_t region, const Vec& point) const;

  const Scene& scene_;
  std::vector<Shape> solids_;
  Vec up_ = Vec::Zero();
  Vec across_ = Vec::Zero();
  std::vector<Levels> regions_;
};

}  // namespace sluice

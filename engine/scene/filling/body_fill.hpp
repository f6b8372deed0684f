#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/filling/intervals.hpp"
#include "engine/scene/filling/packing.hpp"
#include "engine/scene/geometry/tank_room.hpp"
#include "engine/space/lattice.hpp"

namespace sluice {

/// Fills regions to their measure, wherever their surfaces lie: for packing to make uniform. It
/// goes by columns that stand side by side, each of a few upright lines.
template <int Dim>
class BodyFillN {
 public:
  using Point = VecN<Dim>;

  BodyFillN(std::vector<ShapeN<Dim>> regions, std::vector<ShapeN<Dim>> solids,
            std::optional<TankRoomN<Dim>> tank, double spacing);

  /// Places in a region less the solids, round(measure/dx^d) of them: in columns about dx wide, row
  /// by row, in each from the bottom up and evenly over what it holds.
  [[nodiscard]] std::vector<Point> places(std::size_t region) const;
  /// How many places() makes.
  [[nodiscard]] std::size_t count(std::size_t region) const;

  /// The outside of a body's free faces, where neither fluid of these regions nor a solid is, as
  /// far as it reaches into the packing's sums: points that stand for cells with sides of dx/4.
  [[nodiscard]] std::vector<FixedPointN<Dim>> outside(
      const std::vector<std::size_t>& regions) const;

 private:
  /// A point on the ground, which has no height.
  using Foot = Point;
  struct Column {
    Foot foot;
    std::vector<Intervals> lines;  ///< of equal width
    double measure;
  };

  [[nodiscard]] Intervals open_line(std::size_t region, const Foot& foot) const;
  [[nodiscard]] Intervals solid_line(const Foot& foot) const;
  [[nodiscard]] Intervals tank_line(const Foot& foot) const;
  template <class F>
  void for_each_column(std::size_t region, const F& f) const;

  std::vector<ShapeN<Dim>> regions_;
  std::vector<ShapeN<Dim>> solids_;
  std::optional<TankRoomN<Dim>> tank_;
  double spacing_;
};

/// The fluid of a scene of as many dimensions among all that stands in its tank.
template <int Dim>
[[nodiscard]] BodyFillN<Dim> body_fill_of(const Scene& scene);

}  // namespace sluice

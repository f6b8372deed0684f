#pragma once

#include <vector>

#include "engine/scene/filling/intervals.hpp"
#include "engine/scene/filling/packing.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Fills regions of the plane to their area, wherever their outlines lie: for packing to make
/// uniform.
class BodyFill {
 public:
  explicit BodyFill(const Scene& scene);

  /// Places in a region less the solid bodies and what `before` names, round(area/dx^2) of them:
  /// in columns about dx wide from the left, in each from the bottom up and evenly over its area.
  [[nodiscard]] std::vector<Vec> places(std::size_t region) const;
  /// How many places() makes.
  [[nodiscard]] std::size_t count(std::size_t region) const;

  /// The outside of a body's free faces, where neither fluid of these regions nor a solid is, as
  /// far as it reaches into the packing's sums: points that stand for dx/4 x dx/4.
  [[nodiscard]] std::vector<FixedPoint> outside(const std::vector<std::size_t>& regions) const;

 private:
  struct Column {
    double x;
    std::vector<Intervals> lines;  ///< of equal width
    double area;
  };
  [[nodiscard]] Intervals open_line(std::size_t region, double x) const;
  [[nodiscard]] Intervals solid_line(double x) const;
  template <class F>
  void for_each_column(std::size_t region, const F& f) const;

  const Scene& scene_;
  std::vector<Shape> solids_;
};

}  // namespace sluice

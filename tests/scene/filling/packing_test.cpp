#include "engine/scene/filling/packing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sluice {
namespace {

constexpr double kDx = 0.01;

/// A ring of fixed lattice points, three deep, around a square of `side` spacings.
std::vector<FixedPoint> ring(int side) {
  std::vector<FixedPoint> fixed;
  for (int row = -3; row < side + 3; ++row) {
    for (int column = -3; column < side + 3; ++column) {
      const bool inside = row >= 0 && row < side && column >= 0 && column < side;
      if (!inside) fixed.push_back({kDx * Vec(column + 0.5, row + 0.5), 1.0});
    }
  }
  return fixed;
}

std::vector<Vec> lattice(int side, double off) {
  std::vector<Vec> points;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double x = off * std::sin(12.9 * row + 78.2 * column);
      const double y = off * std::sin(39.3 * row + 11.1 * column);
      points.push_back(kDx * Vec(column + 0.5 + x, row + 0.5 + y));
    }
  }
  return points;
}

TEST(Packing, LeavesALatticeWhereItIs) {
  std::vector<Vec> points = lattice(10, 0.0);
  const PackingReport report = pack(points, ring(10), kDx);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.particles, 100U);
  EXPECT_LT(report.residual, 1e-12);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((points[i] - lattice(10, 0.0)[i]).norm(), 1e-9 * kDx);
  }
}

TEST(Packing, MakesTheConcentrationUniform) {
  std::vector<Vec> points = lattice(12, 0.3);
  const PackingReport report = pack(points, ring(12), kDx);
  EXPECT_LE(report.residual, 6e-4);
  EXPECT_LT(report.iterations, kMaxPackingIterations);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((points[i] - points[j]).norm(), 0.6 * kDx);
  }
}

TEST(Packing, DoesNotKnowWhereTheOriginIs) {
  std::vector<Vec> here = lattice(8, 0.3), there = here;
  std::vector<FixedPoint> fixed = ring(8);
  (void)pack(here, fixed, kDx);
  const Vec far(1000.0, -2000.0);
  for (Vec& point : there) point += far;
  for (FixedPoint& each : fixed) each.position += far;
  (void)pack(there, fixed, kDx);
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_LT((there[i] - far - here[i]).norm(), 1e-4 * kDx);
  }
}

TEST(Packing, EndsAtItsMostIterationsWhateverItIsGiven) {
  std::vector<Vec> one_place(40, Vec(0.3, 0.2));
  EXPECT_EQ(pack(one_place, {}, kDx).particles, 40U);
  std::vector<Vec> none;
  EXPECT_EQ(pack(none, ring(3), kDx).iterations, 0);
}

}  // namespace
}  // namespace sluice

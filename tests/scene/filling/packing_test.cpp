#include "engine/scene/filling/packing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/scene/filling/packing-inl.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

constexpr double kApart = 0.01;

template <int Dim>
VecN<Dim> middle_of(const CellN<Dim>& cell) {
  return kApart * (as_vector<Dim>(cell).array() + 0.5).matrix();
}

/// A shell of fixed lattice points, three deep, around a cube of `side` spacings.
template <int Dim>
std::vector<FixedPointN<Dim>> shell(int side) {
  std::vector<FixedPointN<Dim>> fixed;
  for_each_cell<Dim>(shifted<Dim>({}, -3), shifted<Dim>({}, side + 2), [&](const auto& cell) {
    const bool inside =
        std::all_of(cell.begin(), cell.end(), [&](std::int64_t k) { return k >= 0 && k < side; });
    if (!inside) fixed.push_back({middle_of<Dim>(cell), 1.0});
  });
  return fixed;
}

/// The lattice in that cube, each point displaced by up to `off` spacings along each axis.
template <int Dim>
std::vector<VecN<Dim>> lattice(int side, double off) {
  std::vector<VecN<Dim>> points;
  for_each_cell<Dim>({}, shifted<Dim>({}, side - 1), [&](const auto& cell) {
    const VecN<Dim> at = as_vector<Dim>(cell);
    VecN<Dim> moved = middle_of<Dim>(cell);
    for (int axis = 0; axis < Dim; ++axis) {
      moved[axis] += kApart * off * std::sin(12.9 * at.sum() + 78.2 * at[axis] + axis);
    }
    points.push_back(moved);
  });
  return points;
}

template <class Dimension>
class PackingIn : public ::testing::Test {};
TYPED_TEST_SUITE(PackingIn, testing::Dimensions);

TYPED_TEST(PackingIn, LeavesALatticeWhereItIs) {
  constexpr int kD = TypeParam::value;
  const std::vector<VecN<kD>> before = lattice<kD>(6, 0.0);
  std::vector<VecN<kD>> points = before;
  const PackingReport report = pack(points, shell<kD>(6), kApart);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.particles, kD == 2 ? 36U : 216U);
  EXPECT_LT(report.residual, 1e-12);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((points[i] - before[i]).norm(), 1e-9 * kApart);
  }
}

TYPED_TEST(PackingIn, MakesTheConcentrationUniform) {
  constexpr int kD = TypeParam::value;
  std::vector<VecN<kD>> points = lattice<kD>(6, 0.3);
  const PackingReport report = pack(points, shell<kD>(6), kApart);
  EXPECT_LE(report.residual, 6e-4);
  EXPECT_LT(report.iterations, kMaxPackingIterations);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((points[i] - points[j]).norm(), 0.6 * kApart);
    }
  }
}

TEST(Packing, DoesNotKnowWhereTheOriginIs) {
  std::vector<Vec2> here = lattice<2>(8, 0.3), there = here;
  std::vector<FixedPointN<2>> fixed = shell<2>(8);
  (void)pack(here, fixed, kApart);
  const Vec2 far(1000.0, -2000.0);
  for (Vec2& point : there) point += far;
  for (FixedPointN<2>& each : fixed) each.position += far;
  (void)pack(there, fixed, kApart);
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_LT((there[i] - far - here[i]).norm(), 1e-4 * kApart);
  }
}

TEST(Packing, EndsAtItsMostIterationsWhateverItIsGiven) {
  std::vector<Vec2> one_place(40, Vec2(0.3, 0.2));
  EXPECT_EQ(pack(one_place, {}, kApart).particles, 40U);
  std::vector<Vec2> none;
  EXPECT_EQ(pack(none, shell<2>(3), kApart).iterations, 0);
}

}  // namespace
}  // namespace sluice

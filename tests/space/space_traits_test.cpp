#include "engine/space/space_traits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

/// Integral over [0, end]^d, by the midpoint rule on d axes: no table of spheres is used.
template <int Dim, class F>
double integral(double end, int slices, const F& f, double r_sq = 0.0) {
  const double width = end / slices;
  double sum = 0.0;
  for (int k = 0; k < slices; ++k) {
    const double x = (k + 0.5) * width;
    if constexpr (Dim == 1) {
      sum += width * f(r_sq + x * x);
    } else {
      sum += width * integral<Dim - 1>(end, slices, f, r_sq + x * x);
    }
  }
  return sum;
}

/// Over all of space, by symmetry from the corner where no coordinate is negative.
template <int Dim, class F>
double over_space(double end, const F& f) {
  return times_power<Dim>(1.0, 2.0) * integral<Dim>(end, 200, f);
}

template <int Dim>
constexpr double kWendlandNorm = SpaceTraits<Dim>::pi_times_wendland_c2_norm / std::numbers::pi;

template <class Dimension>
class Space : public ::testing::Test {};
TYPED_TEST_SUITE(Space, testing::Dimensions);

TYPED_TEST(Space, NormsMakeTheIntegralsOfTheKernelsOne) {
  constexpr int kD = TypeParam::value;
  const double gaussian = over_space<kD>(6.0, [](double r_sq) { return std::exp(-r_sq); });
  EXPECT_NEAR(SpaceTraits<kD>::gaussian_norm * gaussian, 1.0, 1e-12);
  const double wendland = over_space<kD>(2.0, [](double r_sq) {
    const double r = std::sqrt(r_sq);
    return r < 2.0 ? std::pow(1.0 - r / 2.0, 4) * (2.0 * r + 1.0) : 0.0;
  });
  EXPECT_NEAR(kWendlandNorm<kD> * wendland, 1.0, 1e-6);
}

TYPED_TEST(Space, TheUnitBallHasTheMeasureOfAllPointsNearerThanOne) {
  constexpr int kD = TypeParam::value;
  const double ball = over_space<kD>(1.0, [](double r_sq) { return r_sq < 1.0 ? 1.0 : 0.0; });
  EXPECT_NEAR(ball, SpaceTraits<kD>::unit_ball, 2e-3);
}

TYPED_TEST(Space, TheTraceInsideIsThatOfTheShiftingMatrixInAUniformFluid) {
  constexpr int kD = TypeParam::value;
  // x . (-grad W) over space; -W'(R) = 5 R (1 - R/2)^3 for Wendland C2.
  const double trace = over_space<kD>(2.0, [](double r_sq) {
    return r_sq < 4.0 ? 5.0 * r_sq * std::pow(1.0 - std::sqrt(r_sq) / 2.0, 3) : 0.0;
  });
  EXPECT_NEAR(kWendlandNorm<kD> * trace, SpaceTraits<kD>::trace_inside, 1e-5);
}

TYPED_TEST(Space, ABallHoldsAboutAsManyPointsOfALatticeAsItsMeasureSays) {
  constexpr int kD = TypeParam::value;
  // The points within three spacings of one of them, counted by hand.
  const double counted = kD == 2 ? 29.0 : 123.0;
  EXPECT_NEAR(points_within<kD>(3.0) / counted, 1.0, 0.1);
}

TYPED_TEST(Space, EveryAxisHasANameAndTwoSidesOfABox) {
  constexpr int kD = TypeParam::value;
  EXPECT_EQ(SpaceTraits<kD>::axis_names.size(), static_cast<std::size_t>(kD));
  EXPECT_EQ(SpaceTraits<kD>::axis_names[kUpAxis], "y");
  EXPECT_EQ(SpaceTraits<kD>::box_sides, 2 * kD);
}

TEST(SpaceUnits, ThePlaneCountsPerMetreOfDepth) {
  EXPECT_EQ(SpaceTraits<2>::mass_unit, "kg/m");
  EXPECT_EQ(SpaceTraits<3>::mass_unit, "kg");
  EXPECT_EQ(SpaceTraits<2>::energy_unit, "J/m");
  EXPECT_EQ(SpaceTraits<3>::energy_unit, "J");
}

TEST(Powers, AreMultipliedFromTheLeft) {
  // In another order the last bit differs.
  const double rho = 998.2, dx = 0.0061;
  EXPECT_EQ(times_power<2>(rho, dx), (rho * dx) * dx);
  EXPECT_EQ(times_power<3>(rho, dx), ((rho * dx) * dx) * dx);
  EXPECT_EQ(times_power<0>(rho, dx), rho);
  EXPECT_EQ(cell_measure<3>(0.5), 0.125);
}

}  // namespace
}  // namespace sluice

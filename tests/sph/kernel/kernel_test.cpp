#include "engine/sph/kernel/kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/sph/kernel/discretisation.hpp"

namespace sluice {
namespace {

/// Integral over space, by the midpoint rule in R: S R^(d-1) W dR, S = d times the unit ball.
template <int Dim, class Kernel>
double integral() {
  constexpr int kSlices = 200000;
  const double width = Kernel::support / kSlices;
  double sum = 0.0;
  for (int k = 0; k < kSlices; ++k) {
    const double r = (k + 0.5) * width;
    const double sphere = Dim * SpaceTraits<Dim>::unit_ball * times_power<Dim - 1>(1.0, r);
    sum += sphere * Kernel::value(r * r) * width;
  }
  return sum;
}

/// slope is -W'(R)/R; central differences of step e have an error of e^2 W'''/6.
template <class Kernel>
void expect_slope_is_the_derivative() {
  constexpr double e = 1e-4;
  for (double r = 0.05; r < Kernel::support - 0.01; r += 0.05) {
    const double below = Kernel::value((r - e) * (r - e));
    const double above = Kernel::value((r + e) * (r + e));
    EXPECT_NEAR(Kernel::slope(r * r), -(above - below) / (2.0 * e) / r, 1e-6) << "R = " << r;
  }
}

TEST(Kernels, TheTruncatedGaussianIntegratesToOneLessWhatIsCutOff) {
  EXPECT_NEAR((integral<2, TruncatedGaussianN<2>>()), 1.0 - std::exp(-9.0), 1e-10);
  // The part of a normal distribution in space beyond R: erfc(R) + 2 R exp(-R^2) / sqrt(pi).
  const double cut = std::erfc(3.0) + 6.0 * std::exp(-9.0) * std::numbers::inv_sqrtpi;
  EXPECT_NEAR((integral<3, TruncatedGaussianN<3>>()), 1.0 - cut, 1e-10);
}

TEST(Kernels, WendlandC2IntegratesToOne) {
  EXPECT_NEAR((integral<2, WendlandC2N<2>>()), 1.0, 1e-10);
  EXPECT_NEAR((integral<3, WendlandC2N<3>>()), 1.0, 1e-10);
}

TEST(Kernels, TheSlopeIsTheDerivativeOfTheValue) {
  expect_slope_is_the_derivative<TruncatedGaussianN<2>>();
  expect_slope_is_the_derivative<TruncatedGaussianN<3>>();
  expect_slope_is_the_derivative<WendlandC2N<2>>();
  expect_slope_is_the_derivative<WendlandC2N<3>>();
}

TEST(Kernels, TheSlopeIsFiniteAtTheCentre) {
  // Limits of -W'(R)/R for R -> 0.
  EXPECT_NEAR(TruncatedGaussianN<2>::slope(0.0), 2.0 / std::numbers::pi, 1e-15);
  EXPECT_NEAR(WendlandC2N<2>::slope(0.0), 35.0 / (4.0 * std::numbers::pi), 1e-14);
}

TEST(Kernels, ValueAndSlopeAreZeroFromTheSupportOn) {
  for (const double r : {3.0, 3.0001, 4.0, 1e3, 1e150}) {
    EXPECT_EQ(TruncatedGaussianN<2>::value(r * r), 0.0) << r;
    EXPECT_EQ(TruncatedGaussianN<2>::slope(r * r), 0.0) << r;
  }
  for (const double r : {2.0, 2.0001, 3.0, 1e3, 1e50}) {
    EXPECT_EQ(WendlandC2N<2>::value(r * r), 0.0) << r;
    EXPECT_EQ(WendlandC2N<2>::slope(r * r), 0.0) << r;
  }
  EXPECT_GT(TruncatedGaussianN<2>::value(2.999 * 2.999), 0.0);
  EXPECT_GT(WendlandC2N<2>::value(1.99 * 1.99), 0.0);
}

TEST(Kernels, TheMethodsKernelIsTheOneItNames) {
  for (const double r_sq : {0.0, 0.3, 2.0, 5.0, 10.0}) {
    EXPECT_EQ(kernel_value<2>(KernelKind::truncated_gaussian, r_sq),
              TruncatedGaussianN<2>::value(r_sq));
    EXPECT_EQ(kernel_value<2>(KernelKind::wendland_c2, r_sq), WendlandC2N<2>::value(r_sq));
  }
}

TEST(Kernels, TheSupportOfADiscretisationIsWhereItsKernelEnds) {
  Discretisation m;
  m.smoothing_length = 0.5;
  m.kernel = KernelKind::truncated_gaussian;
  EXPECT_DOUBLE_EQ(m.support(), TruncatedGaussianN<2>::support * 0.5);
  m.kernel = KernelKind::wendland_c2;
  EXPECT_DOUBLE_EQ(m.support(), WendlandC2N<2>::support * 0.5);
}

}  // namespace
}  // namespace sluice

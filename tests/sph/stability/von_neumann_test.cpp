// The linear analysis against limits that are known in closed form, and against the engine itself.

#include "engine/sph/stability/von_neumann.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/space/lattice.hpp"
#include "engine/space/space_traits.hpp"
#include "tests/space/dimensions.hpp"
#include "tests/sph/stability/bare_method.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

/// The gradient sum of exp(-R^2), h = dx, by Poisson's formula: the Fourier transform of the slope,
/// k exp(-k^2/4), summed over the reciprocal lattice, 2 pi apart in units of 1/h = 1/dx. Images
/// further away are below 1e-9, the cut at 3 h changes less than 1e-3.
template <int Dim>
VecN<Dim> gaussian_gradient(const VecN<Dim>& k) {
  CellN<Dim> last;
  last.fill(1);
  VecN<Dim> sum = VecN<Dim>::Zero();
  for_each_cell<Dim>({}, last, [&](const CellN<Dim>& cell) {
    const VecN<Dim> image = k - 2 * std::numbers::pi * as_vector<Dim>(cell);
    sum += image * std::exp(-image.squaredNorm() / 4);
  });
  return sum;
}

/// Its largest length over all waves.
template <int Dim>
double largest_gradient() {
  constexpr double kStep = 0.05;
  CellN<Dim> last;
  last.fill(static_cast<std::int64_t>(std::numbers::pi / kStep));
  double most = 0.0;
  for_each_cell<Dim>({}, last, [&](const CellN<Dim>& cell) {
    most = std::max(most, gaussian_gradient<Dim>(kStep * as_vector<Dim>(cell)).norm());
  });
  return most;
}

/// Of the shortest wave along a diagonal, cos(pi (i + j + ...)), the sum of slope (1 - cos k . x):
/// twice the slope over neighbours at odd sums of i, j, ... For exp(-R^2) and R < 3 by hand.
template <int Dim>
double fastest_gaussian_decay() {
  const double sum = Dim == 2 ? 4 * std::exp(-1) + 8 * std::exp(-5)
                              : 6 * std::exp(-1) + 8 * std::exp(-3) + 24 * std::exp(-5);
  return 2 * 2 * SpaceTraits<Dim>::gaussian_norm * sum;
}

template <class Dimension>
class LatticeStabilityIn : public ::testing::Test {};
TYPED_TEST_SUITE(LatticeStabilityIn, testing::Dimensions);

TYPED_TEST(LatticeStabilityIn, OfUndampedKickDriftKickIsTwoOverTheFastestPressureWave) {
  constexpr int kD = TypeParam::value;
  const CourantLimits limits =
      courant_limits(bare_method<kD>(Integrator::kick_drift_kick), Surface::none);
  EXPECT_NEAR(limits.scheme, 2.0 / largest_gradient<kD>(), 0.005);
  EXPECT_EQ(limits.scheme, limits.sound);
  EXPECT_EQ(limits.viscosity, LatticeStability::kMostCourant);
  EXPECT_EQ(limits.diffusion, LatticeStability::kMostCourant);
}

TYPED_TEST(LatticeStabilityIn, UndampedLeapFrogIsStableAtNoStepAndGrowsWithTheFourthPowerOfIt) {
  constexpr int kD = TypeParam::value;
  // |z| = 1 + (C g)^4/4 + O(C^6) for Adams-Bashforth 2 on the imaginary axis.
  const LatticeStabilityN<kD> analysis(bare_method<kD>(Integrator::modified_leap_frog),
                                       Surface::none);
  EXPECT_EQ(analysis.courant_limit(), 0.0);
  const double growth = std::pow(0.1 * largest_gradient<kD>(), 4) / 4;
  EXPECT_NEAR(analysis.spectral_radius(0.1) - 1.0, growth, 0.05 * growth);
}

TYPED_TEST(LatticeStabilityIn,
           DiffusionAloneAllowsTwoOverItsFastestRateAndHalfOfThatWithTheLeapFrog) {
  constexpr int kD = TypeParam::value;
  const double rate = 2 * 0.5 * fastest_gaussian_decay<kD>();
  for (const Integrator integrator : kIntegrators) {
    MethodN<kD> m = bare_method<kD>(integrator);
    m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.5};
    const double on_axis = integrator == Integrator::kick_drift_kick ? 2.0 : 1.0;
    EXPECT_NEAR(courant_limits(m, Surface::none).diffusion, on_axis / rate, 0.002 * on_axis / rate);
  }
}

TYPED_TEST(LatticeStabilityIn, ViscosityLimitGoesWithOneOverAlphaAndBoundsTheScheme) {
  constexpr int kD = TypeParam::value;
  for (const Integrator integrator : kIntegrators) {
    MethodN<kD> m = bare_method<kD>(integrator);
    m.viscosity = ArtificialViscosity{4.0, 0.01};
    const CourantLimits strong = courant_limits(m, Surface::none);
    m.viscosity->alpha = 8.0;
    const CourantLimits stronger = courant_limits(m, Surface::none);
    EXPECT_NEAR(strong.viscosity, 2 * stronger.viscosity, 1e-9);
    EXPECT_LE(stronger.scheme, stronger.viscosity * 1.001);
  }
}

TYPED_TEST(LatticeStabilityIn,
           PhysicalViscosityAllowsTwoOverItsFastestRateAndHalfOfThatWithTheLeapFrog) {
  constexpr int kD = TypeParam::value;
  // As for diffusion, with 2 nu/(c h) for 2 delta: the stress damps each velocity component alike.
  constexpr double kTwoNu = 1.0;
  const double rate = kTwoNu * fastest_gaussian_decay<kD>();
  for (const Integrator integrator : kIntegrators) {
    MethodN<kD> m = bare_method<kD>(integrator);
    m.laminar_viscosity = LaminarViscosity{0.5 * kTwoNu * m.sound_speed * m.smoothing_length};
    const CourantLimits limits = courant_limits(m, Surface::free);
    const double on_axis = integrator == Integrator::kick_drift_kick ? 2.0 : 1.0;
    EXPECT_NEAR(limits.viscosity, on_axis / rate, 0.002 * on_axis / rate);
    EXPECT_LE(limits.scheme, limits.viscosity * 1.001);
  }
}

TYPED_TEST(LatticeStabilityIn, IsOneWaveLessStableJustAboveTheLimitAndNotBelow) {
  constexpr int kD = TypeParam::value;
  for (const KernelKind kernel : {KernelKind::truncated_gaussian, KernelKind::wendland_c2}) {
    for (const Integrator integrator : kIntegrators) {
      MethodN<kD> m = bare_method<kD>(integrator);
      m.kernel = kernel;
      m.viscosity = ArtificialViscosity{0.02, 0.01};
      m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
      const LatticeStabilityN<kD> analysis(m, Surface::free);
      const double limit = analysis.courant_limit();
      EXPECT_GT(limit, 0.4);
      EXPECT_LE(analysis.spectral_radius(0.99 * limit), 1.0 + LatticeStability::kTolerance);
      EXPECT_GT(analysis.spectral_radius(1.03 * limit), 1.0 + 1e-6);
    }
  }
}

TEST(LatticeStabilityInThePlane, IsLowerAtAFreeSurfaceWhereParticlesLackNeighbours) {
  // The largest singular value of the divergence over a free patch of 20 x 20 particles, its
  // corners included, is 2/2.177 (dense matrix, computed apart from this program); a sheet has no
  // corners.
  const MethodN<2> m = bare_method<2>(Integrator::kick_drift_kick);
  const double sheet = courant_limits(m, Surface::free).scheme;
  EXPECT_LT(sheet, 0.95 * courant_limits(m, Surface::none).scheme);
  EXPECT_NEAR(sheet, 2.177, 0.02 * 2.177);
}

TYPED_TEST(LatticeStabilityIn, DoesNotDependOnTheUnitsOfAScene) {
  constexpr int kD = TypeParam::value;
  MethodN<kD> m = bare_method<kD>(Integrator::kick_drift_kick);
  m.diffusion = DensityDiffusion{};
  const double limit = courant_limits(m, Surface::none).scheme;
  m.spacing *= 1e6;
  m.smoothing_length *= 1e6;
  m.sound_speed *= 1e-3;
  m.reference_density *= 1e3;
  EXPECT_NEAR(courant_limits(m, Surface::none).scheme, limit, 1e-9);
}

}  // namespace
}  // namespace sluice

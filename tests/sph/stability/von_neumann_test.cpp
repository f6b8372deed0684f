// The linear analysis against limits that are known in closed form, and against the engine itself.

#include "engine/sph/stability/von_neumann.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

Method bare(Integrator integrator) {
  Method m = method_as<kAnyDim>(plain_method());
  m.integrator = integrator;
  m.kernel = KernelKind::truncated_gaussian;
  m.smoothing_length = m.spacing;
  m.viscosity.reset();
  m.diffusion.reset();
  return m;
}

/// The largest length of the gradient sum over all waves by Poisson's formula: the Fourier
/// transform of the slope, k exp(-k^2/4), summed over the reciprocal lattice, 2 pi apart in units
/// of 1/h = 1/dx. Images further away are below 1e-9, the cut at 3 h changes less than 1e-3.
double largest_gradient() {
  constexpr double kImage = 2 * std::numbers::pi;
  double most = 0.0;
  for (double kx = 0.0; kx < std::numbers::pi; kx += 0.01) {
    for (double ky = 0.0; ky <= kx; ky += 0.01) {
      Vec2 sum = Vec2::Zero();
      for (const double x : {kx, kx - kImage}) {
        for (const double y : {ky, ky - kImage}) {
          sum += Vec2(x, y) * std::exp(-Vec2(x, y).squaredNorm() / 4);
        }
      }
      most = std::max(most, sum.norm());
    }
  }
  return most;
}

TEST(LatticeStability, OfUndampedKickDriftKickIsTwoOverTheFastestPressureWave) {
  const CourantLimits limits = courant_limits(bare(Integrator::kick_drift_kick), Surface::none);
  EXPECT_NEAR(limits.scheme, 2.0 / largest_gradient(), 0.005);
  EXPECT_EQ(limits.scheme, limits.sound);
  EXPECT_EQ(limits.viscosity, LatticeStability::kMostCourant);
  EXPECT_EQ(limits.diffusion, LatticeStability::kMostCourant);
}

TEST(LatticeStability, UndampedLeapFrogIsStableAtNoStepAndGrowsWithTheFourthPowerOfIt) {
  // |z| = 1 + (C g)^4/4 + O(C^6) for Adams-Bashforth 2 on the imaginary axis.
  const LatticeStability analysis(bare(Integrator::modified_leap_frog), Surface::none);
  EXPECT_EQ(analysis.courant_limit(), 0.0);
  const double growth = std::pow(0.1 * largest_gradient(), 4) / 4;
  EXPECT_NEAR(analysis.spectral_radius(0.1) - 1.0, growth, 0.05 * growth);
}

TEST(LatticeStability, DiffusionAloneAllowsTwoOverItsFastestRateAndHalfOfThatWithTheLeapFrog) {
  // The shortest wave along a diagonal, cos(pi (i + j)): twice the slope over neighbours of odd i +
  // j. For exp(-R^2), lattice sums by hand: (2/pi) (4 e^-1 + 8 e^-5) within R < 3.
  const double rate =
      2 * 0.5 * 2 * std::numbers::inv_pi * 2 * (4 * std::exp(-1) + 8 * std::exp(-5));
  for (const Integrator integrator : kIntegrators) {
    Method m = bare(integrator);
    m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.5};
    const double on_axis = integrator == Integrator::kick_drift_kick ? 2.0 : 1.0;
    EXPECT_NEAR(courant_limits(m, Surface::none).diffusion, on_axis / rate, 0.002 * on_axis / rate);
  }
}

TEST(LatticeStability, ViscosityLimitGoesWithOneOverAlphaAndBoundsTheScheme) {
  for (const Integrator integrator : kIntegrators) {
    Method m = bare(integrator);
    m.viscosity = ArtificialViscosity{4.0, 0.01};
    const CourantLimits strong = courant_limits(m, Surface::none);
    m.viscosity->alpha = 8.0;
    const CourantLimits stronger = courant_limits(m, Surface::none);
    EXPECT_NEAR(strong.viscosity, 2 * stronger.viscosity, 1e-9);
    EXPECT_LE(stronger.scheme, stronger.viscosity * 1.001);
  }
}

TEST(LatticeStability, PhysicalViscosityAllowsTwoOverItsFastestRateAndHalfOfThatWithTheLeapFrog) {
  // As for diffusion, with 2 nu/(c h) for 2 delta: the stress damps each velocity component alike.
  constexpr double kTwoNu = 1.0;
  const double rate = kTwoNu * 2 * std::numbers::inv_pi * 2 * (4 * std::exp(-1) + 8 * std::exp(-5));
  for (const Integrator integrator : kIntegrators) {
    Method m = bare(integrator);
    m.laminar_viscosity = LaminarViscosity{0.5 * kTwoNu * m.sound_speed * m.smoothing_length};
    const CourantLimits limits = courant_limits(m, Surface::free);
    const double on_axis = integrator == Integrator::kick_drift_kick ? 2.0 : 1.0;
    EXPECT_NEAR(limits.viscosity, on_axis / rate, 0.002 * on_axis / rate);
    EXPECT_LE(limits.scheme, limits.viscosity * 1.001);
  }
}

TEST(LatticeStability, IsOneWaveLessStableJustAboveTheLimitAndNotBelow) {
  for (const KernelKind kernel : {KernelKind::truncated_gaussian, KernelKind::wendland_c2}) {
    for (const Integrator integrator : kIntegrators) {
      Method m = bare(integrator);
      m.kernel = kernel;
      m.viscosity = ArtificialViscosity{0.02, 0.01};
      m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
      const LatticeStability analysis(m, Surface::free);
      const double limit = analysis.courant_limit();
      EXPECT_GT(limit, 0.4);
      EXPECT_LE(analysis.spectral_radius(0.99 * limit), 1.0 + LatticeStability::kTolerance);
      EXPECT_GT(analysis.spectral_radius(1.03 * limit), 1.0 + 1e-6);
    }
  }
}

TEST(LatticeStability, IsLowerAtAFreeSurfaceWhereParticlesLackNeighbours) {
  // The largest singular value of the divergence over a free patch of 20 x 20 particles, its
  // corners included, is 2/2.177 (dense matrix, computed apart from this program); a sheet has no
  // corners.
  const Method m = bare(Integrator::kick_drift_kick);
  const double sheet = courant_limits(m, Surface::free).scheme;
  EXPECT_LT(sheet, 0.95 * courant_limits(m, Surface::none).scheme);
  EXPECT_NEAR(sheet, 2.177, 0.02 * 2.177);
}

TEST(LatticeStability, DoesNotDependOnTheUnitsOfAScene) {
  Method m = bare(Integrator::kick_drift_kick);
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

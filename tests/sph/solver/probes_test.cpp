#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "tests/sph/plain_sums.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kDx = 0.1;
constexpr double kCSquared = 400.0;

/// A still lattice of 20 x 16 particles from (-1, -1) on: its upper edge is at 0.6, its right at 1.
Fluid still_block() {
  Dice dice(1);
  return random_block(dice, {-1.0, -1.0}, 20, 16, kDx, 0.0, 0.0, 0.0);
}

TEST(PressureProbe, ReturnsALinearFieldWhereTheLatticeIsSymmetric) {
  Fluid fluid = still_block();
  const auto pressure = [](const Vec2& x) { return 300.0 + 40.0 * x.x() - 90.0 * x.y(); };
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    fluid.excess[i] = pressure(fluid.x[i]) / kCSquared;
  }
  for (const KernelKind kernel : kKernels) {
    TestMethod m = plain_method();
    m.kernel = kernel;
    const SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    // Lattice points, cell centres and edge midpoints, farther than any support from the edges.
    for (const Vec2& point :
         {Vec2(0.05, -0.25), Vec2(0.0, -0.2), Vec2(0.05, -0.2), Vec2(-0.1, -0.15)}) {
      // Not dx: where the cut-off meets a lattice point, rounding decides which side it is on.
      for (const double h : {0.07, 0.098, 0.123}) {
        const Probe probe = solver.pressure_at(point, h);
        EXPECT_NEAR(probe.value, pressure(point), 1e-9 * 300.0);
      }
    }
  }
}

TEST(PressureProbe, HasAWeightOfOneInsideAHalfAtTheSurfaceAndNoneOutside) {
  const SolverN<2> solver = solver_for(plain_method(), start_from(still_block()), {}, {});
  // The sum of W over a lattice of h = dx is its integral, 1 - e^-9, to 2 exp(-pi^2) = 1e-4, and
  // what the cut leaves of single particles near it, some 1e-4 each.
  EXPECT_NEAR(solver.pressure_at({0.0, -0.2}, kDx).weight, 1.0, 2e-3);
  EXPECT_NEAR(solver.pressure_at({0.0, 0.6}, kDx).weight, 0.5, 2e-2);
  EXPECT_EQ(solver.pressure_at({0.0, 0.6 + 3.0 * kDx}, kDx).weight, 0.0);
}

TEST(PressureProbe, IsDryWithoutNeighboursWhateverItsSmoothingLength) {
  const SolverN<2> solver = solver_for(plain_method(), start_from(still_block()), {}, {});
  for (const double h : {1e-6, 0.01, 0.1, 0.3}) {
    const Probe probe = solver.pressure_at({1.99, 1.99}, h);
    EXPECT_EQ(probe.weight, 0.0);
    EXPECT_EQ(probe.value, 0.0);
  }
}

/// Probes at random points, in and beside the block of `columns` x `rows` particles while it moves,
/// with smoothing lengths up to `widest`, against the sums over all particles.
void expect_plain_pressures(const std::string& target, KernelKind kernel, int columns, int rows,
                            double widest) {
  SCOPED_TRACE(target);
  Dice dice(71);
  TestMethod m = plain_method();
  m.kernel = kernel;
  const Fluid start = random_block(dice, {-1.0, -1.0}, columns, rows, kDx, 0.2, 1.0, 10.0);
  const Vec2 end = Vec2(-1.0, -1.0) + kDx * Vec2(columns, rows);
  m.domain.box = {{-3.0, -3.0}, end + Vec2(3.0, 3.0)};
  SolverN<2> solver = solver_for(m, start_from(start), {}, {1, target});
  for (int n = 0; n < 25; ++n) {
    solver.step();
    const Fluid fluid = fluid_of(solver.state());
    for (int k = 0; k < 20; ++k) {
      const Vec2 point = dice.in_box({-1.3, -1.3}, end + Vec2(0.3, 0.3));
      TestMethod at = m;
      at.smoothing_length = dice.between(0.02, widest);
      double weighted = 0.0;
      double plain = 0.0;
      double filled = 0.0;
      for (std::size_t i = 0; i < fluid.size(); ++i) {
        const double w = smoothing(at, (fluid.x[i] - point).norm());
        weighted += kCSquared * fluid.excess[i] * w;
        plain += w;
        filled += w * 10.0 / (1000.0 + fluid.excess[i]);
      }
      const Probe probe = solver.pressure_at(point, at.smoothing_length);
      ASSERT_NEAR(probe.weight, filled, 1e-12);
      ASSERT_NEAR(probe.value, plain > 0.0 ? weighted / plain : 0.0, 1e-7) << "step " << n;
    }
  }
}

TEST(PressureProbe, EqualsTheSumOverAllParticlesWhileTheyMove) {
  for (const KernelKind kernel : kKernels) {
    for (const std::string& target : simd_targets()) {
      expect_plain_pressures(target, kernel, 20, 16, 0.3);
    }
  }
}

TEST(PressureProbe, EqualsTheSumOverAllParticlesWhereItReachesFarAlongALayer) {
  for (const std::string& target : simd_targets()) {
    expect_plain_pressures(target, KernelKind::wendland_c2, 400, 4, 8.0);
  }
}

TEST(SurfaceProbe, FindsTheTopOfALatticeToAQuarterOfASpacing) {
  for (const KernelKind kernel : kKernels) {
    for (const double ratio : {1.0, 1.3}) {
      TestMethod m = plain_method();
      m.kernel = kernel;
      m.smoothing_length = ratio * kDx;
      const SolverN<2> solver = solver_for(m, start_from(still_block()), {}, {});
      for (double x = -0.6; x < 0.6; x += 0.037) {
        const Probe probe = solver.surface_height_at({x, 0.0});
        EXPECT_NEAR(probe.value, 0.6, 0.25 * kDx) << "x = " << x << ", h/dx = " << ratio;
        EXPECT_GE(probe.weight, 0.5);
      }
    }
  }
}

TEST(SurfaceProbe, DoesNotCountADropletAboveTheSurface) {
  Fluid fluid = still_block();
  fluid.add({0.0, 1.5});
  fluid.add({0.3, 1.0});
  const SolverN<2> solver = solver_for(plain_method(), start_from(fluid), {}, {});
  EXPECT_NEAR(solver.surface_height_at({0.0, 0.0}).value, 0.6, 0.25 * kDx);
  EXPECT_NEAR(solver.surface_height_at({0.3, 0.0}).value, 0.6, 0.25 * kDx);
}

TEST(SurfaceProbe, HasNoWeightWhereNoFluidIs) {
  const SolverN<2> solver = solver_for(plain_method(), start_from(still_block()), {}, {});
  for (const double x : {-1.9, 1.4, 1.9, 50.0, -50.0}) {
    EXPECT_EQ(solver.surface_height_at({x, 0.0}).weight, 0.0) << x;
  }
}

TEST(FrontProbe, IsHalfASpacingBeforeTheForemostParticle) {
  const SolverN<2> solver = solver_for(plain_method(), start_from(still_block()), {}, {});
  EXPECT_NEAR(solver.surge_front().value, 1.0, 1e-12);
  EXPECT_GT(solver.surge_front().weight, 0.0);
}

TEST(DistanceProbe, IsThatOfTheNearestParticleAndInfiniteBeyondTheSupport) {
  Dice dice(72);
  const TestMethod m = plain_method();
  SolverN<2> solver =
      solver_for(m, start_from(random_block(dice, {-1, -1}, 20, 16, kDx, 0.2, 4.0, 10.0)), {}, {});
  run_steps(solver, 9);
  const Fluid fluid = fluid_of(solver.state());
  int far = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec2 point = dice.in_box({-1.9, -1.9}, {1.9, 1.9});
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& x : fluid.x) nearest = std::min(nearest, (x - point).norm());
    if (nearest > m.support()) nearest = std::numeric_limits<double>::infinity();
    far += std::isinf(nearest) ? 1 : 0;
    ASSERT_DOUBLE_EQ(solver.distance_to_fluid(point), nearest);
  }
  EXPECT_GT(far, 20);
  EXPECT_LT(far, 280);
}

/// Integral of p/rho^2 from rho_0 to rho for p = c^2 (rho - rho_0), by Simpson's rule, J/kg.
double compression_energy(double excess) {
  constexpr int kIntervals = 200;
  const double width = excess / kIntervals;
  const auto integrand = [](double e) { return kCSquared * e / ((1000.0 + e) * (1000.0 + e)); };
  double sum = 0.0;
  for (int k = 0; k < kIntervals; ++k) {
    const double e = k * width;
    sum += width / 6.0 * (integrand(e) + 4.0 * integrand(e + 0.5 * width) + integrand(e + width));
  }
  return sum;
}

TEST(EnergyProbe, IsThatOfKnownStates) {
  TestMethod m = plain_method();
  m.gravity = {0.0, -9.81};
  Fluid fluid;
  fluid.add({0.3, 0.7}, {3.0, 4.0}, 25.0);
  fluid.add({-1.0, -0.2}, {0.0, 2.0}, -40.0);
  const SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
  const Energy energy = solver.energy();
  // 10 kg each.
  EXPECT_NEAR(energy.kinetic, 0.5 * 10.0 * (25.0 + 4.0), 1e-11);
  EXPECT_NEAR(energy.potential, 10.0 * 9.81 * (0.7 - 0.2), 1e-11);
  const double internal = 10.0 * (compression_energy(25.0) + compression_energy(-40.0));
  EXPECT_NEAR(energy.internal, internal, 1e-10 * internal);
  EXPECT_DOUBLE_EQ(energy.total(), energy.kinetic + energy.potential + energy.internal);
}

TEST(EnergyProbe, KeepsItsDigitsFromNoCompressionToMuch) {
  // On both sides of 2 %, where one formula takes over from another.
  for (const double excess : {1e-6, -1e-3, 0.1, 5.0, -19.99, 19.99, 20.01, -20.01, 200.0}) {
    Fluid fluid;
    fluid.add({0.0, 0.0}, {0.0, 0.0}, excess);
    const SolverN<2> solver = solver_for(plain_method(), start_from(fluid), {}, {});
    const double expected = 10.0 * compression_energy(excess);
    EXPECT_NEAR(solver.energy().internal, expected, 1e-9 * expected) << excess;
  }
}

TEST(EnergyProbe, OfAFallingParticleIsKept) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = plain_method();
    m.integrator = integrator;
    m.gravity = {0.0, -9.81};
    Fluid fluid;
    fluid.add({0.0, 1.5}, {0.3, 0.0});
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    const double start = solver.energy().total();
    run_steps(solver, 400);
    EXPECT_GT(solver.energy().kinetic, 50.0);
    EXPECT_NEAR(solver.energy().total(), start, 1e-11 * start);
  }
}

}  // namespace
}  // namespace sluice

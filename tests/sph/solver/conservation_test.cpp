#include <gtest/gtest.h>

#include <cmath>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr int kSteps = 100;

TestMethod free_method(Integrator integrator) {
  TestMethod m = full_method();
  m.integrator = integrator;
  m.gravity.setZero();
  m.wall_artificial_viscosity.reset();
  return m;
}

Fluid moving_block() {
  Dice dice(21);
  Fluid fluid = random_block(dice, {-0.6, -0.6}, 12, 12, 0.1, 0.2, 1.0, 20.0);
  // A spin, so that there is angular momentum to lose.
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    fluid.v[i] += 1.5 * Vec2(-fluid.x[i].y(), fluid.x[i].x());
  }
  return fluid;
}

struct Momentum {
  Vec2 linear = Vec2::Zero();
  double angular = 0.0;
};

/// Per unit of mass. The leap-frog conserves x^n x v^(n-1/2): its drift is along that velocity.
Momentum momentum_of(const SolverStateN<2>& state) {
  const ParticlesN<2>& p = state.particles;
  const bool half = !p.velocity_half[0].empty();
  Momentum sum;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 v = half ? Vec2(p.velocity_half[0][i], p.velocity_half[1][i]) : p.velocity_of(i);
    sum.linear += v;
    sum.angular += p.position[0][i] * v.y() - p.position[1][i] * v.x();
  }
  return sum;
}

/// Rounding: 144 particles of some 3 m/s and 100 steps whose kicks reach 1 m/s.
void expect_momentum_kept(const TestMethod& m, double tolerance) {
  SolverN<2> solver = solver_for(m, start_from(moving_block()), {}, {});
  solver.step();
  const Momentum before = momentum_of(solver.state());
  run_steps(solver, kSteps);
  const Momentum after = momentum_of(solver.state());
  EXPECT_GT(std::abs(before.angular), 50.0);
  EXPECT_NEAR((after.linear - before.linear).norm(), 0.0, tolerance) << name_of(m.integrator);
  EXPECT_NEAR(after.angular, before.angular, tolerance) << name_of(m.integrator);
}

TEST(Conservation, LinearAndAngularMomentumAreKeptToRoundingInDouble) {
  for (const KernelKind kernel : kKernels) {
    for (const Integrator integrator : kIntegrators) {
      TestMethod m = free_method(integrator);
      m.kernel = kernel;
      expect_momentum_kept(m, 1e-11);
    }
  }
}

TEST(Conservation, MixedPrecisionKeepsMomentumToItsRounding) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = free_method(integrator);
    m.precision = Precision::mixed;
    expect_momentum_kept(m, 1e-3);
  }
}

TEST(Conservation, ViscosityTakesEnergyOutAndNeverPutsAnyIn) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = free_method(integrator);
    m.diffusion.reset();
    m.reinitialisation.reset();
    m.viscosity->alpha = 0.2;
    SolverN<2> solver = solver_for(m, start_from(moving_block()), {}, {});
    const double start = solver.energy().total();
    double last = start;
    for (int n = 0; n < kSteps; ++n) {
      solver.step();
      const double now = solver.energy().total();
      // Time integration may move energy to and fro by its error, far below what friction takes.
      EXPECT_LT(now, last + 1e-3 * start) << name_of(integrator) << ", step " << n;
      last = now;
    }
    EXPECT_LT(last, 0.9 * start) << name_of(integrator);
    EXPECT_GT(last, 0.0);
  }
}

TEST(Conservation, EnergyOfAnInviscidDropIsKeptByKickDriftKick) {
  // A smooth start: what the scheme exchanges between kinetic and internal energy it keeps.
  TestMethod m = free_method(Integrator::kick_drift_kick);
  m.viscosity.reset();
  m.diffusion.reset();
  m.reinitialisation.reset();
  Dice dice(3);
  Fluid fluid = random_block(dice, {-1.0, -1.0}, 20, 20, 0.1, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < fluid.size(); ++i) fluid.v[i] = {-fluid.x[i].x(), fluid.x[i].y()};
  SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
  const double start = solver.energy().total();
  run_steps(solver, kSteps);
  EXPECT_NEAR(solver.energy().total(), start, 0.01 * start);
}

}  // namespace
}  // namespace sluice

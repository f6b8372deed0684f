// The time integration, followed by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kGravity = 9.81;

TestMethod falling(Integrator integrator) {
  TestMethod m = plain_method();
  m.integrator = integrator;
  m.gravity = {0.0, -kGravity};
  m.domain.box = {{-50.0, -500.0}, {50.0, 50.0}};
  return m;
}

Fluid lone_particle() {
  Fluid fluid;
  fluid.add({0.3, 1.0}, {2.0, 5.0}, 0.0);
  return fluid;
}

TEST(FreeFall, OfAnIsolatedParticleIsExactWithStepsOfAnyLength) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      TestMethod m = falling(integrator);
      m.precision = precision;
      SolverN<2> solver = solver_for(m, start_from(lone_particle()), {}, {});
      double shortest = 1.0;
      double longest = 0.0;
      for (int n = 0; n < 1500; ++n) {
        solver.step();
        shortest = std::min(shortest, solver.time_step());
        longest = std::max(longest, solver.time_step());
      }
      const double t = solver.time();
      const Fluid fluid = fluid_of(solver.state());
      // Relative to the path of some 12 m and the speed of some 12 m/s.
      EXPECT_GT(t, 1.3);
      EXPECT_NEAR(fluid.x[0].x(), 0.3 + 2.0 * t, 1e-11);
      EXPECT_NEAR(fluid.x[0].y(), 1.0 + 5.0 * t - 0.5 * kGravity * t * t, 1e-11);
      EXPECT_NEAR(fluid.v[0].x(), 2.0, 1e-12);
      EXPECT_NEAR(fluid.v[0].y(), 5.0 - kGravity * t, 1e-11);
      EXPECT_EQ(fluid.excess[0], 0.0);
      EXPECT_GT(longest / shortest, 1.2) << "steps do not vary: this test proves less";
    }
  }
}

TEST(ModifiedLeapFrog, FollowsEquations13To17WithAHalfFirstKickAndTheMeanOfTwoSteps) {
  SolverN<2> solver =
      solver_for(falling(Integrator::modified_leap_frog), start_from(lone_particle()), {}, {});
  double y = 1.0;
  double v_half = 5.0;
  double last = 0.0;  // before the first step: its kick is half
  for (int n = 0; n < 50; ++n) {
    solver.step();
    const double dt = solver.time_step();
    v_half += 0.5 * (last + dt) * -kGravity;
    y += dt * v_half;
    const double v = v_half + 0.5 * dt * -kGravity;
    last = dt;
    const SolverStateN<2> state = solver.state();
    ASSERT_NEAR(state.particles.velocity_half[1][0], v_half, 1e-13) << "step " << n;
    ASSERT_NEAR(state.particles.position[1][0], y, 1e-13) << "step " << n;
    ASSERT_NEAR(state.particles.velocity[1][0], v, 1e-13) << "step " << n;
  }
}

TEST(KickDriftKick, IsHalfKickDriftHalfKick) {
  SolverN<2> solver =
      solver_for(falling(Integrator::kick_drift_kick), start_from(lone_particle()), {}, {});
  EXPECT_EQ(solver.state().particles.acceleration[1][0], -kGravity)
      << "the first kick needs the acceleration";
  double y = 1.0;
  double v = 5.0;
  for (int n = 0; n < 50; ++n) {
    solver.step();
    const double dt = solver.time_step();
    v -= 0.5 * dt * kGravity;
    y += dt * v;
    v -= 0.5 * dt * kGravity;
    const SolverStateN<2> state = solver.state();
    ASSERT_NEAR(state.particles.position[1][0], y, 1e-13) << "step " << n;
    ASSERT_NEAR(state.particles.velocity[1][0], v, 1e-13) << "step " << n;
  }
}

TEST(Integrators, KeepOnlyTheFieldsTheyNeed) {
  for (const Integrator integrator : kIntegrators) {
    const SolverN<2> solver = solver_for(falling(integrator), start_from(lone_particle()), {}, {});
    const SolverStateN<2> state = solver.state();
    for (const FieldN<2>& field : FieldList<2>::fields) {
      const std::size_t expected = carries(integrator, field) ? 1U : 0U;
      EXPECT_EQ((field.values.of(state.particles)).size(), expected) << field.name;
    }
  }
}

TEST(Integrators, TimeIsTheSumOfTheSteps) {
  for (const Integrator integrator : kIntegrators) {
    SolverN<2> solver = solver_for(falling(integrator), start_from(lone_particle()), {}, {});
    double sum = 0.0;
    for (std::uint64_t n = 1; n <= 30; ++n) {
      solver.step();
      sum += solver.time_step();
      EXPECT_EQ(solver.step_count(), n);
      EXPECT_EQ(solver.time(), sum);
    }
  }
}

/// Two particles that approach: their distance after 64/k steps of k times the shortest length.
double distance_after(Integrator integrator, int k) {
  TestMethod m = plain_method();
  m.integrator = integrator;
  m.courant = 0.02 * k;
  Fluid fluid;
  fluid.add({0.0, 0.0}, {0.2, 0.0}, 0.0);
  fluid.add({0.1, 0.0}, {-0.2, 0.0}, 0.0);
  // The fastest particle is a lone one, so that all steps are equally long.
  fluid.add({-1.5, -1.5}, {1.0, 0.0}, 0.0);
  SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
  run_steps(solver, 64 / k);
  const Fluid now = fluid_of(solver.state());
  return now.x[1].x() - now.x[0].x();
}

TEST(Integrators, AreOfSecondOrder) {
  for (const Integrator integrator : kIntegrators) {
    const double one = distance_after(integrator, 1);
    const double two = distance_after(integrator, 2);
    const double four = distance_after(integrator, 4);
    // Halving the step quarters the error: (y4 - y2)/(y2 - y1) = 4 for second order, 2 for first.
    EXPECT_NEAR((four - two) / (two - one), 4.0, 0.5) << name_of(integrator);
  }
}

}  // namespace
}  // namespace sluice

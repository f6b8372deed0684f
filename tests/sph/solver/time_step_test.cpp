// The length of a step and its reason; particles that leave; slots that hold nobody.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/sph/plain_sums.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

TestMethod method_of(Integrator integrator) {
  TestMethod m = plain_method();
  m.integrator = integrator;
  return m;
}

TEST(TimeStep, IsLimitedBySoundAndTheFastestParticle) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = method_of(integrator);
    m.courant = 0.4;
    Fluid fluid;
    fluid.add({0.0, 0.0}, {3.0, 4.0});
    fluid.add({1.0, 0.0}, {-1.0, 0.0});
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    solver.step();
    // C h/(c + |v|)
    EXPECT_NEAR(solver.time_step(), 0.4 * 0.1 / (20.0 + 5.0), 1e-16);
    EXPECT_EQ(solver.step_limit(), StepLimit::sound);
    EXPECT_EQ(to_string(solver.step_limit()), "sound");
    EXPECT_DOUBLE_EQ(solver.extremes().max_speed, 5.0);
  }
}

TEST(TimeStep, IsLimitedByForceWhereAccelerationIsLarge) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = method_of(integrator);
    m.gravity = {3e4, -4e4};
    Fluid fluid;
    fluid.add({0.0, 0.0});
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    solver.step();
    // 0.25 sqrt(h/|a|)
    EXPECT_NEAR(solver.time_step(), 0.25 * std::sqrt(0.1 / 5e4), 1e-16);
    EXPECT_EQ(solver.step_limit(), StepLimit::force);
    EXPECT_EQ(to_string(solver.step_limit()), "force");
    EXPECT_NEAR(solver.extremes().max_acceleration, 5e4, 1e-6);
  }
}

TEST(TimeStep, OfAFluidAtRestIsTheLimitOfSoundAlone) {
  for (const Integrator integrator : kIntegrators) {
    Fluid fluid;
    fluid.add({0.0, 0.0});
    SolverN<2> solver = solver_for(method_of(integrator), start_from(fluid), {}, {});
    run_steps(solver, 3);
    EXPECT_NEAR(solver.time(), 3.0 * 0.25 * 0.1 / 20.0, 1e-16);
  }
}

/// A block under the upper edge of the domain, and one particle more that flies out through it.
Fluid block_with_an_outsider(const Vec2& place, const Vec2& velocity) {
  Dice dice(61);
  Fluid fluid = random_block(dice, {-0.5, 1.5}, 10, 4, 0.1, 0.1, 0.1, 5.0);
  fluid.add(place, velocity, 1.0);
  return fluid;
}

void run_until_removed(SolverN<2>& solver) {
  for (int n = 0; n < 200 && solver.removed().empty(); ++n) solver.step();
}

TEST(Leaving, AboveTheWallIsOvertoppingAndBelowItALeak) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = method_of(integrator);
    m.domain.wall_top = 1.0;
    Fluid fluid;
    fluid.add({0.0, 0.0});
    fluid.add({0.0, 1.5}, {0.0, 20.0});
    fluid.add({1.5, 0.5}, {20.0, 0.0});
    fluid.add({1.5, 1.5}, {20.0, 0.0});
    fluid.add({0.0, -1.5}, {0.0, -20.0});
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    run_steps(solver, 100);
    ASSERT_EQ(solver.removed().size(), 4U);
    EXPECT_EQ(solver.particle_count(), 1U);
    EXPECT_EQ(solver.state().particles.size(), 1U);
    for (const RemovedParticleN<2>& r : solver.removed()) {
      const bool over = r.id == 1.0 || r.id == 3.0;
      EXPECT_EQ(r.cause, over ? RemovalCause::overtopped : RemovalCause::leaked) << r.id;
      EXPECT_FALSE(m.domain.box.contains(r.position)) << r.id;
      EXPECT_GT(r.step, 0U);
      EXPECT_GT(r.time, 0.0);
      EXPECT_LE(r.time, solver.time());
    }
  }
}

TEST(Leaving, OverTheRimIsOvertoppingBeforeItFallsBehindTheWall) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = method_of(integrator);
    m.gravity = {0.0, -9.81};
    m.domain.wall_top = 0.0;
    m.domain.rim.min[0] = -1.0;
    m.domain.rim.max[0] = 1.0;
    Fluid fluid;
    fluid.add({0.0, 0.5});                // falls back into the tank
    fluid.add({0.7, 0.2}, {3.0, 0.0});    // passes the right rim 0.15 above it
    fluid.add({-0.7, 0.2}, {-3.0, 0.0});  // and the left one
    fluid.add({1.2, -0.5}, {4.0, 0.0});   // has been behind the wall from the start
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    while (solver.time() < 0.4) solver.step();
    ASSERT_EQ(solver.removed().size(), 3U);
    for (const RemovedParticleN<2>& r : solver.removed()) {
      const bool over = r.id == 1.0 || r.id == 2.0;
      EXPECT_EQ(r.cause, over ? RemovalCause::overtopped : RemovalCause::leaked) << r.id;
      EXPECT_EQ(m.domain.box.contains(r.position), over) << r.id;
    }
  }
}

TEST(Leaving, WithoutATankIsALeakEverywhere) {
  TestMethod m = method_of(Integrator::kick_drift_kick);
  Fluid fluid;
  fluid.add({0.0, 1.5}, {0.0, 20.0});
  fluid.add({0.0, 0.0});
  SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
  run_until_removed(solver);
  ASSERT_EQ(solver.removed().size(), 1U);
  EXPECT_EQ(solver.removed()[0].cause, RemovalCause::leaked);
}

TEST(Leaving, TakesTheParticleOutOfEverySumAndTheRestGoesOn) {
  for (const Precision precision : kPrecisions) {
    TestMethod m = method_of(Integrator::modified_leap_frog);
    m.precision = precision;
    m.viscosity = ArtificialViscosity{};
    m.diffusion = DensityDiffusion{};
    // It passes close to the block and is within its support when it leaves.
    const Fluid start = block_with_an_outsider({0.02, 1.94}, {0.0, 4.0});
    SolverN<2> solver = solver_for(m, start_from(start), {}, {});
    run_until_removed(solver);
    ASSERT_EQ(solver.removed().size(), 1U);
    ASSERT_EQ(solver.removed()[0].id, 40.0);
    EXPECT_LT(solver.removed()[0].position.y(), 2.1) << "it is far away: this test proves nothing";
    for (int n = 0; n < 5; ++n) {
      const Fluid fluid = fluid_of(solver.state());
      ASSERT_EQ(fluid.size(), 40U);
      const PlainRates expected = plain_rates(m, fluid, {}, {});
      const FluidRates seen = rates_of_next_step(solver);
      const double eps = precision == Precision::mixed ? 1e-5 : 1e-10;
      expect_near(seen.acceleration, expected.acceleration, eps * expected.acceleration_size,
                  "acceleration");
      expect_near(seen.density, expected.density, eps * expected.density_size, "density rate");
    }
    EXPECT_EQ(solver.removed().size(), 1U) << "retired more than once";
    const Fluid fluid = fluid_of(solver.state());
    double kinetic = 0.0;
    for (const Vec2& v : fluid.v) kinetic += 0.5 * 10.0 * v.squaredNorm();
    EXPECT_NEAR(solver.energy().kinetic, kinetic, 1e-12 * kinetic);
  }
}

TEST(Leaving, OfAllParticlesLeavesASolverThatStillSteps) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      TestMethod m = method_of(integrator);
      m.precision = precision;
      m.gravity = {0.0, -9.81};
      m.reinitialisation = Reinitialisation{2};
      Fluid fluid;
      for (int k = 0; k < 3; ++k) fluid.add({0.4 * k, 1.9}, {0.0, 15.0});
      SolverN<2> solver = solver_for(m, start_from(fluid), {{0.0, -1.0}}, {2, ""});
      run_steps(solver, 40);
      EXPECT_EQ(solver.particle_count(), 0U);
      EXPECT_EQ(solver.removed().size(), 3U);
      EXPECT_EQ(solver.energy().total(), 0.0);
      EXPECT_EQ(solver.extremes().max_speed, 0.0);
      EXPECT_EQ(solver.surge_front().weight, 0.0);
      EXPECT_EQ(solver.pressure_at({0.0, 0.0}, 0.1).weight, 0.0);
      EXPECT_EQ(solver.surface_height_at({0.0, 0.0}).weight, 0.0);
      EXPECT_EQ(solver.wall_pressures(), std::vector<double>{0.0});
      // The empty state is one to go on from.
      SolverN<2> next = solver_for(m, solver.state(), {{0.0, -1.0}}, {});
      next.step();
      solver.step();
      expect_same_bits(next.state(), solver.state(), "nobody left");
    }
  }
}

TEST(Leaving, ARunawayNeitherGrowsMemoryNorForcesASortAtEachStep) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = method_of(integrator);
    m.domain.box = {{-2.0, -2.0}, {3000.0, 2.0}};
    Dice dice(62);
    Fluid fluid = random_block(dice, {-1.0, -1.0}, 10, 10, 0.1, 0.0, 0.0, 0.0);
    fluid.add({0.5, 1.0}, {20.0, 0.0});  // c
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    const std::size_t before = solver.memory_bytes();
    constexpr int kSteps = 2000;
    run_steps(solver, kSteps);
    EXPECT_EQ(solver.particle_count(), 101U);
    EXPECT_LE(solver.memory_bytes(), before + before / 4);
    EXPECT_LE(solver.sort_count(), kSteps / 4U);
  }
}

TEST(Leaving, AParticleThatStartsOutsideIsRemovedAtTheFirstStep) {
  for (const Integrator integrator : kIntegrators) {
    Fluid fluid;
    fluid.add({0.0, 0.0});
    fluid.add({1e9, -1e9});
    SolverN<2> solver = solver_for(method_of(integrator), start_from(fluid), {}, {});
    solver.step();
    EXPECT_EQ(solver.particle_count(), 1U);
    EXPECT_EQ(solver.removed().size(), 1U);
  }
}

TEST(EmptySlots, NeverLeakIntoWhatReadersSee) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      for (int count = 1; count <= 9; ++count) {
        TestMethod m = full_method();
        m.gravity = {0.0, -9.81};
        m.integrator = integrator;
        m.precision = precision;
        m.domain.box = {{-100.0, -100.0}, {100.0, 100.0}};
        Fluid fluid;
        // Rising: they slow down while anything at rest speeds up.
        for (int k = 0; k < count; ++k) fluid.add({1.3 * k, 0.7 * k}, {0.0, 9.81}, 2.0 + k);
        SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
        const std::string what = std::to_string(count) + " particles, " + name_of(integrator);
        while (solver.time() < 0.7) solver.step();
        const double v = 9.81 * (1.0 - solver.time());
        EXPECT_EQ(solver.particle_count(), static_cast<std::size_t>(count)) << what;
        EXPECT_EQ(solver.state().particles.size(), static_cast<std::size_t>(count)) << what;
        EXPECT_NEAR(solver.extremes().max_speed, v, 1e-9) << what;
        EXPECT_NEAR(solver.extremes().max_acceleration, 9.81, 1e-9) << what;
        // Isolated: reinitialisation keeps the density, in mixed precision to its rounding: a
        // product and a quotient each time.
        const double times = 1.0 + static_cast<double>(solver.step_count()) / 20.0;
        const double rounding = times * (1.0 + count) * std::numeric_limits<float>::epsilon();
        EXPECT_NEAR(solver.extremes().min_density_excess, 2.0, rounding) << what;
        EXPECT_NEAR(solver.extremes().max_density_excess, 1.0 + count, rounding) << what;
        EXPECT_NEAR(solver.energy().kinetic, 0.5 * 10.0 * v * v * count, 1e-9) << what;
      }
    }
  }
}

}  // namespace
}  // namespace sluice

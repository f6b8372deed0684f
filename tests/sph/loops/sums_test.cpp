// The engine's sums against plain double loops over all pairs, for all combinations of terms, both
// kernels, integrators and precisions, and every SIMD target of this machine.

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "tests/sph/plain_sums.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

/// Rounding of one sum, relative to the sizes of its summands: a few units in the last place of the
/// coordinates (up to 20 h) and of the kernel, which single precision states as 9e-7.
double tolerance(Precision precision) { return precision == Precision::mixed ? 1e-5 : 1e-11; }

std::vector<TestMethod> all_combinations_of_terms(KernelKind kernel) {
  std::vector<TestMethod> methods;
  for (int mask = 0; mask < 4 * 24; ++mask) {
    TestMethod m = full_method();
    m.reinitialisation.reset();
    m.kernel = kernel;
    if (mask % 3 == 0) m.diffusion.reset();
    if (mask % 3 == 1) m.diffusion->kind = DiffusionKind::molteni_colagrossi;
    const int rest = mask / 3;
    if ((rest & 1) == 0) m.viscosity.reset();
    if ((rest & 3) == 3) m.viscosity->beta = 0.4;
    if ((rest & 2) == 0) m.gravity.setZero();
    if ((rest & 4) == 0) m.wall_pressure = WallPressure::clamped;
    const int drag = rest / 8;
    if (drag != 1) m.wall_artificial_viscosity.reset();
    if (drag == 2) m.laminar_viscosity = LaminarViscosity{0.3};
    if (drag == 3) m.wall_shear = WallShear{0.2};
    methods.push_back(m);
  }
  return methods;
}

struct Scene {
  Fluid fluid;
  std::vector<Vec2> walls;
};

Scene perturbed_tank(std::uint64_t seed) {
  Dice dice(seed);
  const Vec2 corner(-0.73, -0.51);
  return {random_block(dice, corner, 13, 9, 0.1, 0.3, 2.0, 20.0), walls_around(corner, 13, 9, 0.1)};
}

std::string describe(const TestMethod& m, const std::string& target) {
  return target + ", " + name_of(m.precision) + ", " + name_of(m.integrator) + ", kernel " +
         std::to_string(static_cast<int>(m.kernel)) + ", diffusion " +
         (m.diffusion ? std::to_string(static_cast<int>(m.diffusion->kind)) : "none") +
         ", viscosity " + std::to_string(m.viscosity.has_value()) + " (beta " +
         std::to_string(m.viscosity ? m.viscosity->beta : 0.0) + "), friction " +
         std::to_string(m.wall_artificial_viscosity.has_value()) + ", physical viscosity " +
         std::to_string(m.laminar_viscosity.has_value()) + ", wall drag " +
         std::to_string(m.wall_shear.has_value()) + ", gravity " +
         std::to_string(!m.gravity.isZero()) + ", walls clamped " +
         std::to_string(m.wall_pressure == WallPressure::clamped);
}

std::vector<double> rate_between(const std::vector<double>& before,
                                 const std::vector<double>& after, double dt) {
  std::vector<double> rate;
  for (std::size_t i = 0; i < before.size(); ++i) rate.push_back((after[i] - before[i]) / dt);
  return rate;
}

/// The rates at the start, out of one leap-frog step: its first kick moves both by rate times dt.
void expect_leap_frog_sums(const TestMethod& m, const Scene& scene, const std::string& target,
                           const std::vector<double>& pressure, const PlainRates& expected) {
  const std::string what = describe(m, target);
  const double eps = tolerance(m.precision);
  SolverN<2> solver = solver_for(m, start_from(scene.fluid), scene.walls, {1, target});
  solver.step();
  const Fluid after = fluid_of(solver.state());
  std::vector<Vec2> a;
  for (std::size_t i = 0; i < after.size(); ++i) {
    a.emplace_back((after.v[i] - scene.fluid.v[i]) / solver.time_step());
  }
  expect_near(a, expected.acceleration, eps * expected.acceleration_size, what + ": acceleration");
  expect_near(rate_between(scene.fluid.excess, after.excess, solver.time_step()), expected.density,
              eps * expected.density_size, what + ": density rate");
  // Pressures and heads of this scene are below 20 000 Pa.
  expect_near(solver.wall_pressures(), pressure, eps * 2e4, what + ": wall pressure");
}

/// Kick-drift-kick keeps the acceleration; its density rate is taken half a step later.
void expect_kick_drift_kick_sums(const TestMethod& m, const Scene& scene, const std::string& target,
                                 const std::vector<double>& pressure, const PlainRates& expected) {
  const std::string what = describe(m, target);
  const double eps = tolerance(m.precision);
  SolverN<2> solver = solver_for(m, start_from(scene.fluid), scene.walls, {1, target});
  expect_near(solver.wall_pressures(), pressure, eps * 2e4, what + ": wall pressure");
  const SolverStateN<2> start = solver.state();
  const auto ax = by_id(start, {&ParticlesN<2>::acceleration, 0});
  const auto ay = by_id(start, {&ParticlesN<2>::acceleration, 1});
  std::vector<Vec2> a;
  for (std::size_t i = 0; i < ax.size(); ++i) a.emplace_back(ax[i], ay[i]);
  expect_near(a, expected.acceleration, eps * expected.acceleration_size, what + ": acceleration");

  solver.step();
  const double dt = solver.time_step();
  const Fluid middle = middle_of_step(scene.fluid, start, dt);
  const PlainRates later = plain_rates(m, middle, scene.walls, pressure);
  expect_near(rate_between(scene.fluid.excess, fluid_of(solver.state()).excess, dt), later.density,
              eps * later.density_size, what + ": density rate");
}

void expect_sums(TestMethod m, const Scene& scene) {
  const std::vector<double> pressure = plain_wall_pressures(m, scene.fluid, scene.walls);
  const PlainRates rates = plain_rates(m, scene.fluid, scene.walls, pressure);
  for (const std::string& target : simd_targets()) {
    for (m.precision = Precision::mixed;; m.precision = Precision::double_precision) {
      m.integrator = Integrator::modified_leap_frog;
      expect_leap_frog_sums(m, scene, target, pressure, rates);
      m.integrator = Integrator::kick_drift_kick;
      expect_kick_drift_kick_sums(m, scene, target, pressure, rates);
      if (m.precision == Precision::double_precision) break;
    }
  }
}

TEST(PairSums, EqualThePlainDoubleLoopForAllTermsBesideWalls) {
  const Scene scene = perturbed_tank(1);
  for (const KernelKind kernel : kKernels) {
    for (const TestMethod& m : all_combinations_of_terms(kernel)) expect_sums(m, scene);
  }
}

TEST(PairSums, EqualThePlainDoubleLoopForAllTermsWithoutWalls) {
  const Scene scene{perturbed_tank(2).fluid, {}};
  for (const KernelKind kernel : kKernels) {
    for (const TestMethod& m : all_combinations_of_terms(kernel)) {
      if (m.wall_artificial_viscosity || m.wall_pressure == WallPressure::clamped) continue;
      expect_sums(m, scene);
    }
  }
}

TEST(PairSums, EqualThePlainDoubleLoopWhereParticlesLieAtRandom) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Dice dice(100 + seed);
    Scene scene;
    for (int i = 0; i < 70; ++i) {
      scene.fluid.add(dice.in_box({-0.6, -0.6}, {0.6, 0.6}), dice.in_box({-3, -3}, {3, 3}),
                      dice.between(-30.0, 30.0));
    }
    for (int i = 0; i < 50; ++i) scene.walls.push_back(dice.in_box({-0.9, -0.9}, {0.9, 0.9}));
    for (const KernelKind kernel : kKernels) {
      TestMethod m = full_method();
      m.reinitialisation.reset();
      m.kernel = kernel;
      expect_sums(m, scene);
    }
  }
}

TEST(PairSums, LeaveOutWhatALiftedWallHasPassed) {
  const Scene scene = perturbed_tank(5);
  // The right wall, x > 0.57 m: after 0.14 s its edge is between the fourth and the fifth row.
  TestMethod m = full_method();
  m.reinitialisation.reset();
  m.domain.gate = GateMotionN<2>{{{0.57, -0.51}, {0.9, 0.4}}, 3.0};
  SolverStateN<2> state = start_from(scene.fluid);
  state.time = 0.14;
  std::vector<Vec2> standing;
  for (const Vec2& wall : scene.walls) {
    if (wall.x() < 0.57 || wall.y() < -0.51 || wall.y() > -0.09) standing.push_back(wall);
  }
  ASSERT_LT(standing.size(), scene.walls.size());
  for (m.integrator = Integrator::modified_leap_frog;; m.integrator = Integrator::kick_drift_kick) {
    SolverN<2> lifted = solver_for(m, state, scene.walls, {});
    TestMethod still = m;
    still.domain.gate.reset();
    SolverN<2> fewer = solver_for(still, state, standing, {});
    lifted.step();
    fewer.step();
    const Fluid a = fluid_of(lifted.state());
    const Fluid b = fluid_of(fewer.state());
    expect_near(a.v, b.v, 1e-11, "velocity, m/s, of up to 2");
    expect_near(a.excess, b.excess, 1e-9, "density excess, kg/m^3, of up to 20");
    if (m.integrator == Integrator::kick_drift_kick) break;
  }
}

TEST(PairSums, AWallParticleWithoutFluidNearHasNoPressure) {
  TestMethod m = full_method();
  Fluid fluid;
  fluid.add({0.0, 0.0}, {0.0, 0.0}, 5.0);
  const double edge = m.support();
  const std::vector<Vec2> walls{{1.001 * edge, 0.0}, {0.999 * edge, 0.0}, {-1.5, -1.5}};
  for (const Precision precision : kPrecisions) {
    m.precision = precision;
    m.integrator = Integrator::kick_drift_kick;
    const SolverN<2> solver = solver_for(m, start_from(fluid), walls, {});
    const auto pressure = solver.wall_pressures();
    EXPECT_EQ(pressure[0], 0.0);
    EXPECT_GT(pressure[1], 0.0);
    EXPECT_EQ(pressure[2], 0.0);
  }
}

/// The leap-frog reinitialises at the start of a step, both time levels by the same increment.
void expect_leap_frog_reinitialisation(const TestMethod& m, const Scene& scene) {
  const double eps = tolerance(m.precision);
  SolverN<2> solver = solver_for(m, start_from(scene.fluid), scene.walls, {});
  solver.step();
  const SolverStateN<2> first = solver.state();
  Fluid fluid = fluid_of(first);
  const auto old_pressure = plain_wall_pressures(m, fluid, scene.walls);
  const auto fresh = plain_reinitialisation(m, fluid, scene.walls, old_pressure);
  auto half = by_id(first, &ParticlesN<2>::density_excess_half);
  for (std::size_t i = 0; i < half.size(); ++i) half[i] += fresh[i] - fluid.excess[i];
  fluid.excess = fresh;
  const auto rates =
      plain_rates(m, fluid, scene.walls, plain_wall_pressures(m, fluid, scene.walls));
  solver.step();
  const double dt_mean = 0.5 * (first.time_step + solver.time_step());
  for (std::size_t i = 0; i < half.size(); ++i) half[i] += dt_mean * rates.density[i];
  std::vector<double> full = half;
  for (std::size_t i = 0; i < full.size(); ++i) {
    full[i] += 0.5 * solver.time_step() * rates.density[i];
  }
  // Excesses are below 100 kg/m^3 and the rates act for one step.
  const double size = 100.0 + dt_mean * rates.density_size;
  const SolverStateN<2> second = solver.state();
  expect_near(by_id(second, &ParticlesN<2>::density_excess_half), half, eps * size, "half level");
  expect_near(by_id(second, &ParticlesN<2>::density_excess), full, eps * size, "full level");
}

/// Kick-drift-kick reinitialises at the end of a step, before the acceleration.
void expect_kick_drift_kick_reinitialisation(const TestMethod& m, const Scene& scene) {
  const double eps = tolerance(m.precision);
  TestMethod without = m;
  without.reinitialisation.reset();
  SolverN<2> plain = solver_for(without, start_from(scene.fluid), scene.walls, {});
  SolverN<2> solver = solver_for(m, start_from(scene.fluid), scene.walls, {});
  plain.step();
  solver.step();
  Fluid fluid = fluid_of(plain.state());
  const auto pressure = plain_wall_pressures(m, fluid, scene.walls);
  fluid.excess = plain_reinitialisation(m, fluid, scene.walls, pressure);
  const Fluid after = fluid_of(solver.state());
  expect_near(after.x, fluid.x, 0.0, "position");
  expect_near(after.excess, fluid.excess, eps * 100.0, "density");
  const auto walls_after = plain_wall_pressures(m, fluid, scene.walls);
  expect_near(solver.wall_pressures(), walls_after, eps * 4e4, "wall pressure");
  // The acceleration saw the velocities before the last half kick.
  const auto ax = by_id(solver.state(), {&ParticlesN<2>::acceleration, 0});
  const auto ay = by_id(solver.state(), {&ParticlesN<2>::acceleration, 1});
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    fluid.v[i] = after.v[i] - 0.5 * solver.time_step() * Vec2(ax[i], ay[i]);
  }
  const auto rates = plain_rates(m, fluid, scene.walls, walls_after);
  std::vector<double> expected;
  for (const Vec2& a : rates.acceleration) expected.push_back(a.x());
  expect_near(ax, expected, eps * rates.acceleration_size, "acceleration");
}

TEST(PairSums, ReinitialisationEqualsThePlainDoubleLoop) {
  for (const bool walls : {true, false}) {
    Scene scene = perturbed_tank(3);
    if (!walls) scene.walls.clear();
    for (const KernelKind kernel : kKernels) {
      for (const Precision precision : kPrecisions) {
        TestMethod m = full_method();
        m.kernel = kernel;
        m.precision = precision;
        m.reinitialisation = Reinitialisation{1};
        m.integrator = Integrator::modified_leap_frog;
        expect_leap_frog_reinitialisation(m, scene);
        m.integrator = Integrator::kick_drift_kick;
        expect_kick_drift_kick_reinitialisation(m, scene);
      }
    }
  }
}

}  // namespace
}  // namespace sluice

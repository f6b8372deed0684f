// Particle shifting against plain double loops, and what it is for.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "tests/sph/plain_sums.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kShiftedSpacing = 0.1;

TestMethod shifting_method(KernelKind kernel, Precision precision) {
  TestMethod m = full_method();
  m.kernel = kernel;
  m.smoothing_length = kernel == KernelKind::wendland_c2 ? 0.15 : 0.1;
  m.precision = precision;
  m.integrator = Integrator::kick_drift_kick;
  m.reinitialisation.reset();
  m.shifting = ParticleShifting{2.0};
  return m;
}

/// The way of each particle: 2 h |v| dt sum V slope x_ij, as far as the trace of sum V slope x_ij
/// x_ij is above 1.75, in full from 1.9 on, and no more than dx/10.
std::vector<Vec2> plain_shift(const TestMethod& m, const Fluid& fluid,
                              const std::vector<Vec2>& walls,
                              const std::vector<double>& wall_pressure, double dt) {
  const double mass = m.reference_density * m.spacing * m.spacing;
  std::vector<Vec2> ways;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    Vec2 towards = Vec2::Zero();
    double trace = 0.0;
    const auto add = [&](const Vec2& x_j, double excess_j) {
      const Vec2 x_ij = fluid.x[i] - x_j;
      const double weight =
          mass / (m.reference_density + excess_j) * smoothing_slope(m, x_ij.norm());
      towards += weight * x_ij;
      trace += weight * x_ij.squaredNorm();
    };
    for (std::size_t j = 0; j < fluid.size(); ++j) {
      if (j != i) add(fluid.x[j], fluid.excess[j]);
    }
    for (std::size_t w = 0; w < walls.size(); ++w) {
      add(walls[w], wall_pressure[w] / (m.sound_speed * m.sound_speed));
    }
    const double inside = std::clamp((trace - 1.75) / 0.15, 0.0, 1.0);
    Vec2 way = inside * 2.0 * m.smoothing_length * fluid.v[i].norm() * dt * towards;
    if (way.norm() > 0.1 * m.spacing) way *= 0.1 * m.spacing / way.norm();
    ways.push_back(way);
  }
  return ways;
}

struct FluidAndWalls {
  Fluid fluid;
  std::vector<Vec2> walls;
};

FluidAndWalls restless_tank() {
  Dice dice(5);
  const Vec2 corner(-0.73, -0.51);
  return {random_block(dice, corner, 17, 13, kShiftedSpacing, 0.25, 2.0, 20.0),
          walls_around(corner, 17, 13, kShiftedSpacing)};
}

void expect_shift(const TestMethod& m, const FluidAndWalls& scene, const std::string& target) {
  const std::string what = target + ", " + name_of(m.precision);
  const double eps = m.precision == Precision::mixed ? 2e-5 : 1e-11;
  SolverN<2> solver = solver_for(m, start_from(scene.fluid), scene.walls, {1, target});
  TestMethod without = m;
  without.shifting.reset();
  SolverN<2> plain = solver_for(without, start_from(scene.fluid), scene.walls, {1, target});
  const auto pressure = plain_wall_pressures(m, scene.fluid, scene.walls);
  const SolverStateN<2> start = solver.state();
  solver.step();
  plain.step();
  const double dt = solver.time_step();
  ASSERT_EQ(dt, plain.time_step());
  const Fluid middle = middle_of_step(scene.fluid, start, dt);
  const std::vector<Vec2> expected = plain_shift(m, middle, scene.walls, pressure, 2.0 * dt);

  const Fluid shifted = fluid_of(solver.state());
  const Fluid still = fluid_of(plain.state());
  std::vector<Vec2> way;
  std::vector<double> excess;
  std::vector<double> expected_excess;
  for (std::size_t i = 0; i < shifted.size(); ++i) {
    way.emplace_back(shifted.x[i] - still.x[i]);
    excess.push_back(shifted.excess[i] - still.excess[i]);
    expected_excess.push_back(m.reference_density * m.gravity.dot(expected[i]) /
                              (m.sound_speed * m.sound_speed));
  }
  expect_near(way, expected, eps * kShiftedSpacing, what + ": way");
  expect_near(excess, expected_excess, eps * 20.0, what + ": density");
  const auto moved = std::count_if(expected.begin(), expected.end(), [](const Vec2& one) {
    return one.norm() > 1e-4 * kShiftedSpacing;
  });
  EXPECT_GT(moved, 50) << "else it proves little";
  EXPECT_LT(moved, static_cast<std::ptrdiff_t>(expected.size()) - 10) << "some are at a surface";
}

TEST(ParticleShifting, IsThatOfThePlainDoubleLoop) {
  const FluidAndWalls tank = restless_tank();
  const FluidAndWalls block{tank.fluid, {}};
  for (const KernelKind kernel : kKernels) {
    for (const Precision precision : kPrecisions) {
      for (const std::string& target : simd_targets()) {
        expect_shift(shifting_method(kernel, precision), tank, target);
        expect_shift(shifting_method(kernel, precision), block, target);
      }
    }
  }
}

TEST(ParticleShifting, TakesPlaceInEverySecondStep) {
  const FluidAndWalls tank = restless_tank();
  TestMethod m = shifting_method(KernelKind::wendland_c2, Precision::mixed);
  SolverN<2> solver = solver_for(m, start_from(tank.fluid), tank.walls, {});
  m.shifting.reset();
  for (int n = 0; n < 4; ++n) {
    SolverN<2> plain = solver_for(m, solver.state(), tank.walls, {});
    solver.step();
    plain.step();
    const bool shifted = fluid_of(solver.state()).x != fluid_of(plain.state()).x;
    EXPECT_EQ(shifted, n % 2 == 0) << "step " << n;
  }
}

TEST(ParticleShifting, IsBoundedByATenthOfTheSpacing) {
  TestMethod m = shifting_method(KernelKind::wendland_c2, Precision::double_precision);
  m.shifting->coefficient = 10.0;
  m.courant = 0.5;
  Dice dice(9);
  Fluid fluid = random_block(dice, {-0.7, -0.7}, 14, 14, kShiftedSpacing, 0.45, 0.0, 0.0);
  for (Vec2& v : fluid.v) v = {9.0, 0.0};
  SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
  m.shifting.reset();
  SolverN<2> plain = solver_for(m, start_from(fluid), {}, {});
  solver.step();
  plain.step();
  const Fluid a = fluid_of(solver.state());
  const Fluid b = fluid_of(plain.state());
  double farthest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    farthest = std::max(farthest, (a.x[i] - b.x[i]).norm());
  }
  EXPECT_NEAR(farthest, 0.1 * kShiftedSpacing, 1e-12);
}

/// Particles of a moving lattice, of which one inside is displaced; no forces.
Fluid lattice_under_way(const Vec2& velocity, const Vec2& displaced) {
  Dice dice(1);
  Fluid fluid = random_block(dice, {-0.75, -0.75}, 15, 15, kShiftedSpacing, 0.0, 0.0, 0.0);
  for (Vec2& v : fluid.v) v = velocity;
  fluid.x[7 * 15 + 7] += displaced;
  return fluid;
}

TEST(ParticleShifting, BringsADisplacedParticleBackAndLeavesSurfacesAlone) {
  TestMethod m = plain_method();
  m.integrator = Integrator::kick_drift_kick;
  m.kernel = KernelKind::wendland_c2;
  m.smoothing_length = 0.15;
  m.precision = Precision::double_precision;
  m.shifting = ParticleShifting{2.0};
  const Vec2 velocity(1.0, 0.0);
  const Fluid start = lattice_under_way(velocity, {0.0, 0.3 * kShiftedSpacing});
  SolverN<2> solver = solver_for(m, start_from(start), {}, {});
  run_steps(solver, 10);
  const Fluid end = fluid_of(solver.state());
  const auto way = [&](std::size_t i) {
    return Vec2(end.x[i] - start.x[i] - solver.time() * velocity);
  };
  const std::size_t middle = 7 * 15 + 7;
  EXPECT_LT(way(middle).y(), -0.01 * kShiftedSpacing);
  EXPECT_NEAR(way(middle).x(), 0.0, 1e-9 * kShiftedSpacing);
  for (std::size_t column = 0; column < 15; ++column) {
    EXPECT_LT(way(column).norm(), 1e-12) << "lowest row";
    EXPECT_LT(way(14 * 15 + column).norm(), 1e-12) << "highest row";
  }
}

TEST(ParticleShifting, MovesNothingInFluidAtRest) {
  TestMethod m = plain_method();
  m.integrator = Integrator::kick_drift_kick;
  m.shifting = ParticleShifting{2.0};
  const Fluid start = lattice_under_way(Vec2::Zero(), {0.0, 0.3 * kShiftedSpacing});
  SolverN<2> solver = solver_for(m, start_from(start), {}, {});
  run_steps(solver, 3);
  const Fluid end = fluid_of(solver.state());
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_EQ((end.x[i] - start.x[i]).norm(), 0.0);
}

}  // namespace
}  // namespace sluice

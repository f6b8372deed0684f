// Still water stays still, and its pressure is the weight above.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kDx = 0.1;
constexpr double kG = 9.81;
constexpr int kColumns = 16;
constexpr int kRows = 15;
constexpr double kDepth = kRows * kDx;
const Vec2 kCorner(-0.8, -0.7);

TestMethod still_water(Integrator integrator, Precision precision) {
  TestMethod m = plain_method();
  m.gravity = {0.0, -kG};
  m.sound_speed = 10.0 * std::sqrt(2.0 * kG * kDepth);
  m.integrator = integrator;
  m.precision = precision;
  m.viscosity = ArtificialViscosity{};
  m.diffusion = DensityDiffusion{};
  if (integrator == Integrator::kick_drift_kick) {
    m.diffusion->kind = DiffusionKind::fourtakas;
  } else {
    m.reinitialisation = Reinitialisation{20};
  }
  return m;
}

/// rho_0 g times the depth below the surface, Pa.
double weight_above(double y) { return 1000.0 * kG * (kCorner.y() + kDepth - y); }

Fluid column_at_rest(const TestMethod& m) {
  Dice dice(1);
  Fluid fluid = random_block(dice, kCorner, kColumns, kRows, kDx, 0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    fluid.excess[i] = weight_above(fluid.x[i].y()) / (m.sound_speed * m.sound_speed);
  }
  return fluid;
}

/// Largest error of the pressure along a plumb line in the middle, in units of that at the floor,
/// after a fall time.
double worst_pressure_error(const TestMethod& m) {
  const std::vector<Vec2> walls = walls_around(kCorner, kColumns, kRows + 5, kDx);
  SolverN<2> solver = solver_for(m, start_from(column_at_rest(m)), walls, {});
  while (solver.time() < std::sqrt(kDepth / kG)) solver.step();
  EXPECT_EQ(solver.particle_count(), static_cast<std::size_t>(kColumns * kRows));
  // Still: far below sqrt(g H).
  EXPECT_LT(solver.extremes().max_speed, 0.05 * std::sqrt(kG * kDepth));
  EXPECT_NEAR(solver.surface_height_at({0.0, 0.0}).value, kCorner.y() + kDepth, 0.5 * kDx);
  double worst = 0.0;
  for (double y = kCorner.y() + 3.0 * kDx; y < kCorner.y() + kDepth - 3.0 * kDx; y += 0.5 * kDx) {
    const double error = solver.pressure_at({0.0, y}, kDx).value - weight_above(y);
    worst = std::max(worst, std::abs(error) / weight_above(kCorner.y()));
  }
  return worst;
}

TEST(StillWater, KeepsItsPressureWithKickDriftKickAndHydrostaticDiffusion) {
  for (const Precision precision : kPrecisions) {
    EXPECT_LT(worst_pressure_error(still_water(Integrator::kick_drift_kick, precision)), 0.02);
  }
}

TEST(StillWater, KeepsItsPressureForAShortTimeWithThePapersScheme) {
  for (const Precision precision : kPrecisions) {
    EXPECT_LT(worst_pressure_error(still_water(Integrator::modified_leap_frog, precision)), 0.08);
  }
}

TEST(StillWater, PressesOnTheFloorWithItsWeightFromTheFirstStepOn) {
  const TestMethod m = still_water(Integrator::kick_drift_kick, Precision::double_precision);
  const std::vector<Vec2> walls = walls_around(kCorner, kColumns, kRows + 5, kDx);
  const SolverN<2> solver = solver_for(m, start_from(column_at_rest(m)), walls, {});
  const std::vector<double> pressure = solver.wall_pressures();
  int checked = 0;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    // Below the floor, away from the corners: the linear profile goes on into the wall. The heads
    // carry rho_f instead of rho_0, at most 0.5 % more (c = 10 sqrt(2 g H)).
    if (walls[w].y() > kCorner.y() || std::abs(walls[w].x()) > 0.4) continue;
    ++checked;
    EXPECT_NEAR(pressure[w] / weight_above(walls[w].y()), 1.0, 0.005);
  }
  EXPECT_GE(checked, 20);
}

}  // namespace
}  // namespace sluice

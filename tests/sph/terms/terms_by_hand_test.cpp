// Each term alone, with a handful of particles whose sums fit on one line.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kH = 0.1;        // h = dx, m
constexpr double kRho0 = 1000.0;  // kg/m^3
constexpr double kC = 20.0;       // m/s
constexpr double kMass = 10.0;    // rho_0 dx^2, kg/m
constexpr double kRelative = 1e-12;

/// W of the Gaussian at R smoothing lengths, 1/m^2, and the size of its gradient, 1/m^3.
double W(double R) { return std::exp(-R * R) / (std::numbers::pi * kH * kH); }
double grad_W(double R) { return 2.0 * R / kH * W(R); }

#define EXPECT_CLOSE(value, expected) \
  EXPECT_NEAR(value, expected, kRelative* std::abs(expected) + 1e-300)

TEST(PressureTerm, TwoParticlesUnderPressurePushEachOtherApart) {
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), 10.0);
  fluid.add({0.0, 1.5 * kH}, Vec2::Zero(), 25.0);
  const auto rates = rates_at_start(plain_method(), fluid, {});
  // p/rho^2 with p = c^2 times the excess.
  const double push =
      kMass * (400.0 * 10.0 / (1010.0 * 1010.0) + 400.0 * 25.0 / (1025.0 * 1025.0)) * grad_W(1.5);
  EXPECT_EQ(rates.acceleration[0].x(), 0.0);
  EXPECT_CLOSE(rates.acceleration[0].y(), -push);
  EXPECT_CLOSE(rates.acceleration[1].y(), push);
  EXPECT_EQ(rates.density[0], 0.0);
  EXPECT_EQ(rates.density[1], 0.0);
}

TEST(PressureTerm, NegativePressurePullsTogetherForThereIsNoClampInTheFluid) {
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), -10.0);
  fluid.add({kH, 0.0}, Vec2::Zero(), -10.0);
  const auto rates = rates_at_start(plain_method(), fluid, {});
  EXPECT_CLOSE(rates.acceleration[0].x(), kMass * 2.0 * 4000.0 / (990.0 * 990.0) * grad_W(1.0));
}

TEST(PressureTerm, AParticleInTheMiddleOfACrossFeelsNothing) {
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), 30.0);
  for (const Vec2& arm : {Vec2(kH, 0.0), Vec2(-kH, 0.0), Vec2(0.0, kH), Vec2(0.0, -kH)}) {
    fluid.add(arm, Vec2::Zero(), 12.0);
  }
  const auto rates = rates_at_start(plain_method(), fluid, {});
  EXPECT_NEAR(rates.acceleration[0].norm(), 0.0, 1e-12 * rates.acceleration[1].norm());
}

TEST(ContinuityTerm, ApproachRaisesTheDensityOfBothByTheirVolumes) {
  Fluid fluid;
  fluid.add({0.0, 0.0}, {3.0, 0.0}, 10.0);
  fluid.add({kH, 0.0}, {-1.0, 0.0}, 25.0);
  const auto rates = rates_at_start(plain_method(), fluid, {});
  EXPECT_CLOSE(rates.density[0], 1010.0 * kMass / 1025.0 * 4.0 * grad_W(1.0));
  EXPECT_CLOSE(rates.density[1], 1025.0 * kMass / 1010.0 * 4.0 * grad_W(1.0));
}

TEST(ContinuityTerm, MotionPastEachOtherChangesNoDensity) {
  Fluid fluid;
  fluid.add({0.0, 0.0}, {0.0, 3.0}, 10.0);
  fluid.add({kH, 0.0}, {0.0, -1.0}, 25.0);
  const auto rates = rates_at_start(plain_method(), fluid, {});
  EXPECT_EQ(rates.density[0], 0.0);
  EXPECT_EQ(rates.density[1], 0.0);
}

TEST(ContinuityTerm, WallsTakePartAtRest) {
  Fluid fluid;
  fluid.add({0.0, 0.5 * kH}, {0.5, -2.0}, 0.0);
  const auto rates = rates_at_start(plain_method(), fluid, {{0.0, -0.5 * kH}});
  EXPECT_CLOSE(rates.density[0], kRho0 * kMass / kRho0 * 2.0 * grad_W(1.0));
}

TEST(DiffusionTerm, MolteniColagrossiIsFourDeltaCOverHTimesTheVolumeAverage) {
  TestMethod m = plain_method();
  m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.1};
  m.gravity = {0.0, -9.81};  // which this term does not know
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), 10.0);
  fluid.add({0.6 * kH, 0.8 * kH}, Vec2::Zero(), 25.0);
  const auto rates = rates_at_start(m, fluid, {});
  EXPECT_CLOSE(rates.density[0], 4.0 * 0.1 * kC / kH * 15.0 * W(1.0) * kMass / 1025.0);
  EXPECT_CLOSE(rates.density[1], -4.0 * 0.1 * kC / kH * 15.0 * W(1.0) * kMass / 1010.0);
}

TEST(DiffusionTerm, FourtakasLeavesAHydrostaticPairAlone) {
  TestMethod m = plain_method();
  m.gravity = {0.0, -9.81};
  m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
  // p = rho_0 g depth: the lower one is denser by rho_0 g h/c^2.
  const double difference = kRho0 * 9.81 * kH / (kC * kC);
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), 5.0 + difference);
  fluid.add({0.0, kH}, Vec2::Zero(), 5.0);
  const double size = 4.0 * 0.1 * kC / kH * difference * W(1.0) * kMass / kRho0;
  const auto rates = rates_at_start(m, fluid, {});
  EXPECT_NEAR(rates.density[0], 0.0, 1e-11 * size);
  EXPECT_NEAR(rates.density[1], 0.0, 1e-11 * size);
}

TEST(DiffusionTerm, FourtakasDiffusesWhatIsNotHydrostatic) {
  TestMethod m = plain_method();
  m.gravity = {0.0, -9.81};
  m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
  const double hydrostatic = kRho0 * 9.81 * kH / (kC * kC);
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), 5.0);
  fluid.add({0.0, kH}, Vec2::Zero(), 5.0);
  const auto rates = rates_at_start(m, fluid, {});
  // Equal densities: the lower one lacks the hydrostatic difference and gains.
  EXPECT_NEAR(rates.density[0] / (4.0 * 0.1 * kC / kH * hydrostatic * W(1.0) * kMass / 1005.0), 1.0,
              1e-11);
}

TEST(DiffusionTerm, FourtakasWithoutGravityIsMolteniColagrossi) {
  Dice dice(5);
  const Fluid fluid = random_block(dice, {-0.5, -0.5}, 8, 8, kH, 0.2, 1.0, 20.0);
  TestMethod m = plain_method();
  m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.1};
  const auto one = rates_at_start(m, fluid, {});
  m.diffusion->kind = DiffusionKind::fourtakas;
  const auto other = rates_at_start(m, fluid, {});
  EXPECT_EQ(one.density, other.density);
}

TEST(ViscosityTerm, ActsOnApproachWithTheMeanDensity) {
  TestMethod m = plain_method();
  m.viscosity = ArtificialViscosity{0.02, 0.01};
  Fluid fluid;
  fluid.add({0.0, 0.0}, {3.0, 0.0}, 0.0);
  fluid.add({kH, 0.0}, {-1.0, 0.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {});
  // Pi = alpha c h/rho * 4 h/(h^2 + eps h^2) = alpha c 4/(1.01 rho)
  const double pi = 0.02 * kC * 4.0 / (1.01 * kRho0);
  EXPECT_CLOSE(rates.acceleration[0].x(), -kMass * pi * grad_W(1.0));
  EXPECT_CLOSE(rates.acceleration[1].x(), kMass * pi * grad_W(1.0));
}

TEST(ViscosityTerm, AddsTheSquareOfTheApproachAtImpacts) {
  TestMethod m = plain_method();
  m.viscosity = ArtificialViscosity{0.02, 0.01, 0.5};
  Fluid fluid;
  fluid.add({0.0, 0.0}, {3.0, 0.0}, 0.0);
  fluid.add({kH, 0.0}, {-1.0, 0.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {});
  const double mu = 4.0 / 1.01;
  const double pi = (0.02 * kC * mu + 0.5 * mu * mu) / kRho0;
  EXPECT_CLOSE(rates.acceleration[0].x(), -kMass * pi * grad_W(1.0));
  EXPECT_CLOSE(rates.acceleration[1].x(), kMass * pi * grad_W(1.0));
}

TEST(ViscosityTerm, DoesNotActOnReceding) {
  TestMethod m = plain_method();
  m.viscosity = ArtificialViscosity{0.02, 0.01, 0.5};
  Fluid fluid;
  fluid.add({0.0, 0.0}, {-3.0, 1.0}, 0.0);
  fluid.add({kH, 0.0}, {1.0, -1.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {});
  EXPECT_EQ(rates.acceleration[0].norm(), 0.0);
  EXPECT_EQ(rates.acceleration[1].norm(), 0.0);
}

TEST(ViscosityTerm, IsNotSummedAgainstWalls) {
  TestMethod m = plain_method();
  m.viscosity = ArtificialViscosity{0.02, 0.01};
  Fluid fluid;
  fluid.add({0.0, 0.5 * kH}, {0.0, -2.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {{0.0, -0.5 * kH}});
  EXPECT_EQ(rates.acceleration[0].norm(), 0.0);
}

TEST(WallArtificialViscosityTerm, ActsAgainstWallsOnly) {
  TestMethod m = plain_method();
  m.wall_artificial_viscosity = WallArtificialViscosity{0.05, 0.02};
  Fluid fluid;
  fluid.add({0.0, 0.5 * kH}, {1.0, -2.0}, 0.0);
  fluid.add({1.0, 1.0}, {1.0, 0.0}, 0.0);
  fluid.add({1.0 + kH, 1.0}, {-1.0, 0.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {{0.0, -0.5 * kH}});
  const double pi = 0.05 * kC * 2.0 / (1.02 * kRho0);
  EXPECT_CLOSE(rates.acceleration[0].y(), kMass * pi * grad_W(1.0));
  EXPECT_EQ(rates.acceleration[0].x(), 0.0);
  EXPECT_EQ(rates.acceleration[1].norm(), 0.0);
  EXPECT_EQ(rates.acceleration[2].norm(), 0.0);
}

TEST(LaminarViscosityTerm, DragsAPairTogetherAndAParticleToRestAtAWall) {
  TestMethod m = plain_method();
  m.laminar_viscosity = LaminarViscosity{0.3};
  Fluid fluid;
  fluid.add({0.0, 0.0}, {3.0, 1.0}, 0.0);
  fluid.add({kH, 0.0}, {-1.0, 1.0}, 0.0);
  fluid.add({0.0, 1.0 + 0.5 * kH}, {2.0, -5.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {{0.0, 1.0 - 0.5 * kH}});
  // 2 nu V (x_ij . grad W)/|x_ij|^2 v_ij with V = h^2, |x_ij| = h and x_ij . grad W < 0.
  const double drag = 2.0 * 0.3 * kH * grad_W(1.0);
  EXPECT_CLOSE(rates.acceleration[0].x(), -4.0 * drag);
  EXPECT_CLOSE(rates.acceleration[1].x(), 4.0 * drag);
  EXPECT_EQ(rates.acceleration[0].y(), 0.0);
  EXPECT_CLOSE(rates.acceleration[2].x(), -2.0 * drag);
  EXPECT_CLOSE(rates.acceleration[2].y(), 5.0 * drag);
}

TEST(LaminarViscosityTerm, SlowsAParabolicProfileByTwiceNu) {
  // nu d2u/dy2 = -2 nu for u = -y^2; on a lattice of dx = h/1.5 the sum is that to 2 %.
  TestMethod m = plain_method();
  m.kernel = KernelKind::wendland_c2;
  m.spacing = m.smoothing_length / 1.5;
  m.laminar_viscosity = LaminarViscosity{0.3};
  Fluid fluid;
  for (int row = -6; row <= 6; ++row) {
    for (int column = -6; column <= 6; ++column) {
      const Vec2 place = m.spacing * Vec2(column, row);
      fluid.add(place, {-place.y() * place.y(), 0.0}, 0.0);
    }
  }
  const Vec2 middle = rates_at_start(m, fluid, {}).acceleration[fluid.size() / 2];
  EXPECT_NEAR(middle.x(), -2.0 * 0.3, 0.02 * 2.0 * 0.3);
  EXPECT_NEAR(middle.y(), 0.0, 1e-9);
}

TEST(WallShearTerm, ActsAgainstWallsOnly) {
  TestMethod m = plain_method();
  m.wall_shear = WallShear{0.1};
  Fluid fluid;
  fluid.add({1.0, 1.0}, {1.0, 0.0}, 0.0);
  fluid.add({1.0 + kH, 1.0}, {-1.0, 3.0}, 0.0);
  const auto rates = rates_at_start(m, fluid, {{0.0, 0.0}});
  EXPECT_EQ(rates.acceleration[0].norm(), 0.0);
  EXPECT_EQ(rates.acceleration[1].norm(), 0.0);
}

/// Stress on a layer of fluid that slides along a wall at `speed`, from one column of particles.
double stress_at_wall(const TestMethod& m, double speed) {
  Fluid fluid;
  std::vector<Vec2> walls;
  for (int row = 0; row < 5; ++row) {
    for (int column = -5; column <= 5; ++column) {
      const Vec2 place = m.spacing * Vec2(column, row + 0.5);
      fluid.add(place, {speed, 0.0}, 0.0);
      walls.emplace_back(place.x(), -place.y());
    }
  }
  const auto rates = rates_at_start(m, fluid, walls);
  double force = 0.0;
  for (std::size_t i = 5; i < fluid.size(); i += 11) {
    force -= m.particle_mass() * rates.acceleration[i].x();
    EXPECT_EQ(rates.acceleration[i].y(), 0.0);
  }
  return force / m.spacing;
}

TEST(WallShearTerm, PutsTheStressOfASkinFrictionOnFluidThatSlidesAlongAWall) {
  for (const KernelKind kernel : {KernelKind::truncated_gaussian, KernelKind::wendland_c2}) {
    for (const double spacing : {kH / 1.5, kH / 1.2}) {
      TestMethod m = plain_method();
      m.kernel = kernel;
      m.spacing = spacing;
      m.wall_shear = WallShear{0.1};
      for (const double speed : {0.5, 3.0}) {
        const double pressure_term = 0.1 / 2.0 * kRho0 * speed * speed;
        EXPECT_NEAR(stress_at_wall(m, speed), pressure_term, 1e-12 * pressure_term);
      }
    }
  }
}

/// Wall pressures at the start.
std::vector<double> wall_pressures(TestMethod m, const Fluid& fluid,
                                   const std::vector<Vec2>& walls) {
  m.integrator = Integrator::kick_drift_kick;
  return solver_for(m, start_from(fluid), walls, {}).wall_pressures();
}

TEST(WallPressureTerm, AddsTheHeadFromTheParticleToTheWall) {
  TestMethod m = plain_method();
  m.gravity = {0.0, -9.81};
  Fluid fluid;
  fluid.add({0.0, 0.5 * kH}, Vec2::Zero(), 2.0);
  const auto p = wall_pressures(m, fluid, {{0.0, -0.5 * kH}, {0.3 * kH, 0.5 * kH}});
  EXPECT_CLOSE(p[0], 400.0 * 2.0 + 1002.0 * 9.81 * kH);
  EXPECT_CLOSE(p[1], 400.0 * 2.0);
}

TEST(WallPressureTerm, WeighsItsNeighboursByTheKernel) {
  Fluid fluid;
  fluid.add({kH, 0.0}, Vec2::Zero(), 2.0);
  fluid.add({-2.0 * kH, 0.0}, Vec2::Zero(), 8.0);
  const auto p = wall_pressures(plain_method(), fluid, {{0.0, 0.0}});
  const double w1 = std::exp(-1.0);
  const double w2 = std::exp(-4.0);
  EXPECT_CLOSE(p[0], (800.0 * w1 + 3200.0 * w2) / (w1 + w2));
}

TEST(WallPressureTerm, IsNegativeUnlessClamped) {
  TestMethod m = plain_method();
  Fluid fluid;
  fluid.add({kH, 0.0}, Vec2::Zero(), -2.0);
  EXPECT_CLOSE(wall_pressures(m, fluid, {{0.0, 0.0}})[0], -800.0);
  m.wall_pressure = WallPressure::clamped;
  EXPECT_EQ(wall_pressures(m, fluid, {{0.0, 0.0}})[0], 0.0);
}

TEST(WallPressureTerm, PushesTheFluidWithTheDensityOfTheStateEquation) {
  Fluid fluid;
  fluid.add({0.0, 0.5 * kH}, Vec2::Zero(), 2.0);
  const auto rates = rates_at_start(plain_method(), fluid, {{0.0, -0.5 * kH}});
  // The wall takes the particle's pressure and so its density.
  EXPECT_CLOSE(rates.acceleration[0].y(), kMass * 2.0 * 800.0 / (1002.0 * 1002.0) * grad_W(1.0));
}

TEST(ReinitialisationTerm, MovesBothTimeLevelsByTheSameIncrement) {
  TestMethod m = plain_method();
  m.reinitialisation = Reinitialisation{20};
  Fluid fluid;
  fluid.add({0.0, 0.0}, Vec2::Zero(), 10.0);
  fluid.add({kH, 0.0}, Vec2::Zero(), 25.0);
  SolverStateN<2> state = start_from(fluid);
  ParticlesN<2>& p = state.particles;
  state.step = 20;
  state.time_step = 1e-4;
  p.velocity_half[0] = p.velocity_half[1] = {0.0, 0.0};
  p.density_excess_half = {9.0, 27.0};
  p.position_sorted[0] = p.position[0];
  p.position_sorted[1] = p.position[1];
  SolverN<2> solver = solver_for(m, state, {}, {});
  solver.step();
  // rho = (W0 + W1)/(W0/rho_i + W1/rho_j); nothing moves yet, so the step itself adds nothing.
  const double w = std::exp(-1.0);
  const double first = (1.0 + w) / (1.0 / 1010.0 + w / 1025.0) - kRho0;
  const double second = (1.0 + w) / (1.0 / 1025.0 + w / 1010.0) - kRho0;
  const std::vector<double> half{9.0 + first - 10.0, 27.0 + second - 25.0};
  expect_near(by_id(solver.state(), &ParticlesN<2>::density_excess_half), half, 1e-11,
              "half level");
  expect_near(by_id(solver.state(), &ParticlesN<2>::density_excess), half, 1e-11, "full level");
}

TEST(ReinitialisationTerm, LeavesAnIsolatedParticleAlone) {
  TestMethod m = plain_method();
  m.reinitialisation = Reinitialisation{1};
  Fluid fluid;
  fluid.add({-1.0, -1.0}, {1.0, 0.0}, 7.0);
  for (const Integrator integrator : kIntegrators) {
    m.integrator = integrator;
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    run_steps(solver, 5);
    EXPECT_NEAR(by_id(solver.state(), &ParticlesN<2>::density_excess)[0], 7.0, 1e-12);
  }
}

TEST(AbsentTerms, AFluidAtReferenceDensityAndRestStaysAsItIs) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      TestMethod m = full_method();
      m.gravity.setZero();
      m.integrator = integrator;
      m.precision = precision;
      Dice dice(9);
      const Fluid fluid = random_block(dice, {-0.5, -0.5}, 6, 6, kH, 0.3, 0.0, 0.0);
      SolverN<2> solver =
          solver_for(m, start_from(fluid), walls_around({-0.5, -0.5}, 6, 6, kH), {});
      run_steps(solver, 25);
      const Fluid after = fluid_of(solver.state());
      expect_near(after.x, fluid.x, 0.0, "position");
      expect_near(after.v, fluid.v, 0.0, "velocity");
      expect_near(after.excess, fluid.excess, 0.0, "density");
    }
  }
}

}  // namespace
}  // namespace sluice

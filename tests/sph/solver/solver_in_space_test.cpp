// The engine in three dimensions: it treats all axes alike, loses no momentum, holds water in a
// tank, and gives the same bits whatever the threads and wherever it was stopped.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/space/lattice.hpp"
#include "engine/sph/loops/simd_target.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kSpacing = 0.1;  // m
constexpr int kSteps = 60;        // with several sorts

using Solver3 = SolverN<3>;
using State3 = SolverStateN<3>;

/// A scheme with all that a sum between fluid particles may add to; c = 20 m/s.
MethodN<3> scheme(Integrator integrator) {
  MethodN<3> m;
  m.spacing = kSpacing;
  m.smoothing_length = 0.13;
  m.reference_density = 1000.0;
  m.sound_speed = 20.0;
  m.kernel = KernelKind::wendland_c2;
  m.precision = Precision::double_precision;
  m.integrator = integrator;
  m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.1};
  m.viscosity = ArtificialViscosity{};
  m.laminar_viscosity = LaminarViscosity{0.01};
  m.reinitialisation = Reinitialisation{20};
  if (integrator == Integrator::kick_drift_kick) m.shifting = ParticleShifting{};
  return m;
}

/// A cuboid of 9 x 8 x 7 particles that are out of their places and move; axis k of it lies along
/// axis (k + turn) mod 3.
State3 cuboid(int turn) {
  Dice dice(71);
  State3 state;
  for (int n = 0; n < 9 * 8 * 7; ++n) {
    const std::array<int, 3> cell{n % 9, n / 9 % 8, n / 72};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t along = (axis + static_cast<std::size_t>(turn)) % 3;
      const double place = kSpacing * (cell[axis] - 4 + dice.between(-0.2, 0.2));
      state.particles.position[along].push_back(place);
      state.particles.velocity[along].push_back(dice.between(-0.5, 0.5));
    }
    state.particles.density_excess.push_back(dice.between(-5.0, 5.0));
    state.particles.id.push_back(n);
  }
  return state;
}

Solver3 solver_of(const MethodN<3>& method, const State3& state, const Execution& execution) {
  FlowDomainN<3> domain;
  domain.box = {VecN<3>::Constant(-2.0), VecN<3>::Constant(2.0)};
  return {method, domain, state, {}, execution};
}

State3 after(Solver3 solver, int steps) {
  for (int n = 0; n < steps; ++n) solver.step();
  return solver.state();
}

void expect_same(const State3& a, const State3& b) {
  for (const FieldN<3>& field : FieldList<3>::fields) {
    EXPECT_EQ(field.values.of(a.particles), field.values.of(b.particles)) << field.name;
  }
}

/// Position of each particle by its id.
std::vector<VecN<3>> places_by_id(const State3& state) {
  std::vector<VecN<3>> places(state.particles.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[static_cast<std::size_t>(state.particles.id[i])] = state.particles.position_of(i);
  }
  return places;
}

TEST(SolverInSpace, LosesNoMomentum) {
  for (const Integrator integrator : kIntegrators) {
    MethodN<3> method = scheme(integrator);
    for (const std::string& target : simd_targets()) {
      const State3 start = cuboid(0);
      const State3 end = after(solver_of(method, start, {1, target}), kSteps);
      ASSERT_EQ(end.particles.size(), start.particles.size());
      VecN<3> gained = VecN<3>::Zero();
      for (std::size_t i = 0; i < end.particles.size(); ++i) {
        gained += end.particles.velocity_of(i) - start.particles.velocity_of(i);
      }
      // Of 504 speeds of up to 1 m/s; half levels start where whole ones do.
      EXPECT_LT(gained.norm(), 1e-10) << target << ", " << name_of(integrator);
    }
  }
}

TEST(SolverInSpace, TreatsAllAxesAlike) {
  for (const Integrator integrator : kIntegrators) {
    const MethodN<3> method = scheme(integrator);
    const auto expected = places_by_id(after(solver_of(method, cuboid(0), {}), kSteps));
    for (const int turn : {1, 2}) {
      const auto turned = places_by_id(after(solver_of(method, cuboid(turn), {}), kSteps));
      ASSERT_EQ(turned.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(turned[i][(axis + turn) % 3], expected[i][axis], 1e-8)
              << name_of(integrator) << ", particle " << i;
        }
      }
    }
  }
}

TEST(SolverInSpace, GivesTheSameBitsForAnyThreadsAndAnyStop) {
  for (const Integrator integrator : kIntegrators) {
    const MethodN<3> method = scheme(integrator);
    const State3 expected = after(solver_of(method, cuboid(0), {1, ""}), kSteps);
    expect_same(after(solver_of(method, cuboid(0), {3, ""}), kSteps), expected);
    for (const int stop : {7, 31}) {
      const State3 stopped = after(solver_of(method, cuboid(0), {2, ""}), stop);
      expect_same(after(solver_of(method, stopped, {1, ""}), kSteps - stop), expected);
    }
  }
}

TEST(SolverInSpace, PutsTheSurfaceAndTheDistanceWhereTheyAre) {
  // A cube of a lattice at rest, whose highest row is at 0.3 m.
  State3 state;
  for (int n = 0; n < 9 * 9 * 9; ++n) {
    append(state.particles.position,
           VecN<3>(kSpacing * VecN<3>(n % 9 - 4, n / 9 % 9 - 5, n / 81 - 4)));
    append(state.particles.velocity, VecN<3>(VecN<3>::Zero()));
    state.particles.density_excess.push_back(0.0);
    state.particles.id.push_back(n);
  }
  const Solver3 solver = solver_of(scheme(Integrator::kick_drift_kick), state, {});
  // Half a spacing above the highest row, as for water that fills its cells.
  const Probe surface = solver.surface_height_at({0.02, 0.0, -0.03});
  EXPECT_NEAR(surface.value, 0.35, 0.2 * kSpacing);
  EXPECT_NEAR(solver.pressure_at({0.0, -0.1, 0.0}, 0.13).weight, 1.0, 0.05);
  EXPECT_EQ(solver.pressure_at({0.0, 1.0, 0.0}, 0.13).weight, 0.0);
  EXPECT_NEAR(solver.distance_to_fluid({0.0, 0.0, 0.6}), 0.2, 1e-12);
}

/// Water at rest in an open tank of 8 x 6 x 7 cells whose walls have three layers.
struct StillTank {
  MethodN<3> method;
  FlowDomainN<3> domain;
  State3 state;
  std::vector<VecN<3>> walls;
};

StillTank still_tank(Precision precision) {
  constexpr CellN<3> kSize{8, 6, 7};
  StillTank tank;
  MethodN<3>& m = tank.method;
  m.spacing = kSpacing;
  m.smoothing_length = 1.5 * kSpacing;
  m.reference_density = 1000.0;
  m.sound_speed = 35.0;
  m.gravity = {0.0, -9.81, 0.0};
  m.kernel = KernelKind::wendland_c2;
  m.precision = precision;
  m.integrator = Integrator::kick_drift_kick;
  m.courant = 1.0;
  m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
  m.viscosity = ArtificialViscosity{.alpha = 0.02, .epsilon = 0.01, .beta = 0.5};
  m.wall_shear = WallShear{0.01};
  m.wall_pressure = WallPressure::clamped;
  m.shifting = ParticleShifting{2.0};
  tank.domain.box = {VecN<3>::Constant(-0.5), VecN<3>(1.3, 2.0, 1.2)};
  for_each_cell<3>({-3, -3, -3}, {10, 5, 9}, [&](const CellN<3>& cell) {
    const VecN<3> place = kSpacing * (as_vector<3>(cell).array() + 0.5).matrix();
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inside = inside && cell[axis] >= 0 && cell[axis] < kSize[axis];
    }
    if (!inside) {
      tank.walls.push_back(place);
      return;
    }
    ParticlesN<3>& p = tank.state.particles;
    p.id.push_back(static_cast<double>(p.size()));
    append(p.position, place);
    append(p.velocity, filled_vec<3>(0.0));
    const double depth = kSpacing * static_cast<double>(kSize[1]) - place.y();
    p.density_excess.push_back(1000.0 * 9.81 * depth / (35.0 * 35.0));
  });
  return tank;
}

TEST(SolverInSpace, HoldsStillWaterWithItsPressure) {
  for (const Precision precision : kPrecisions) {
    const StillTank tank = still_tank(precision);
    Solver3 solver(tank.method, tank.domain, tank.state, tank.walls, {});
    for (int n = 0; n < 400; ++n) solver.step();
    EXPECT_EQ(solver.particle_count(), tank.state.particles.size()) << name_of(precision);
    EXPECT_LT(solver.extremes().max_speed, 0.1) << name_of(precision);
    const double depth = 0.4;
    const Probe pressure =
        solver.pressure_at({0.4, 0.6 - depth, 0.35}, tank.method.smoothing_length);
    EXPECT_NEAR(pressure.value, 1000.0 * 9.81 * depth, 0.05 * 1000.0 * 9.81 * 0.6)
        << name_of(precision);
  }
}

TEST(SolverInSpace, InATankGivesTheSameBitsForAnyThreadsAndAnyStopOnEachTarget) {
  constexpr int kTankSteps = 60;
  for (const Precision precision : kPrecisions) {
    StillTank tank = still_tank(precision);
    // The lowest two rows are pushed, so that particles change their rows.
    for (std::size_t i = 0; i < tank.state.particles.size(); ++i) {
      if (tank.state.particles.position[1][i] < 0.2) tank.state.particles.velocity[2][i] = 2.0;
    }
    for (const std::string& target : simd_targets()) {
      const auto made = [&](const State3& from, int threads) {
        return Solver3(tank.method, tank.domain, from, tank.walls, {threads, target});
      };
      const State3 expected = after(made(tank.state, 1), kTankSteps);
      expect_same(after(made(tank.state, 2), kTankSteps), expected);
      const State3 stopped = after(made(tank.state, 2), 23);
      expect_same(after(made(stopped, 1), kTankSteps - 23), expected);
    }
  }
}

}  // namespace
}  // namespace sluice

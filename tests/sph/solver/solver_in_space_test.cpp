// The engine in three dimensions, of which no run is made yet: it treats all axes alike, loses no
// momentum, and gives the same bits whatever the threads and wherever it was stopped.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/sph/solver/solver_in_space_test.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "engine/sph/loops/sweeps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// The loops of a scheme with all that a sum may add to: eqs. 7 and 8, viscous stress and shifting.
void fill_in_space(Sweeps<double, 3>& out) {
  using Eq7 = Form<DensityDiffusion, 0>;
  using Eq8 = Form<ArtificialViscosity, 0>;
  using Stress = Form<LaminarViscosity, 0>;
  using Shape = WendlandShape;
  fill_updates(out.updates);
  out.density_and_acceleration =
      &sum_rates<Shape, RateSums<3, Sums::both, false, Eq7, Eq8, Stress>, double, 3>;
  out.density = &sum_rates<Shape, RateSums<3, Sums::density, false, Eq7>, double, 3>;
  out.density_and_shift = &sum_rates<Shape, RateSums<3, Sums::density, true, Eq7>, double, 3>;
  out.acceleration =
      &sum_rates<Shape, RateSums<3, Sums::acceleration, false, Eq8, Stress>, double, 3>;
  out.wall_pressure = &sum_wall_pressure<Shape, double, 3>;
  out.reinitialise = &sum_reinitialisation<Shape, double, 3>;
  out.updates.sum_around = &sum_around<Shape, 3>;
  out.search = &search_boxes<3>;
  out.prune = &prune_list<double, 3>;
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "engine/sph/method/removed-inl.hpp"
#include "engine/sph/pairs/grid-inl.hpp"
#include "engine/sph/pairs/layout-inl.hpp"
#include "engine/sph/solver/engine-inl.hpp"
#include "engine/sph/solver/solver-inl.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {

HWY_EXPORT(fill_in_space);

template <>
Sweeps<double, 3> select_sweeps<double, 3>(const MethodN<3>&, const std::string& target) {
  Sweeps<double, 3> sweeps;
  with_simd_target(target, [&] { HWY_DYNAMIC_DISPATCH(fill_in_space)(sweeps); });
  return sweeps;
}
template <>
Sweeps<float, 3> select_sweeps<float, 3>(const MethodN<3>&, const std::string&) {
  return {};  // all here is in double precision
}

// clang-format off
template <>
struct FieldList<3> {
  using P = ParticlesN<3>;
  static constexpr Role state = Role::state;
  static constexpr std::array fields{
      FieldN<3>{"x", "m", "", state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 0}},
      FieldN<3>{"y", "m", "", state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 1}},
      FieldN<3>{"z", "m", "", state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position, 2}},
      FieldN<3>{"vx", "m/s", "", state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 0}},
      FieldN<3>{"vy", "m/s", "", state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 1}},
      FieldN<3>{"vz", "m/s", "", state, CarriedBy::every_scheme, EmptySlot::zero, {&P::velocity, 2}},
      FieldN<3>{"density_excess", "kg/m^3", "", state, CarriedBy::every_scheme, EmptySlot::zero, &P::density_excess},
      FieldN<3>{"vx_half", "m/s", "", state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 0}},
      FieldN<3>{"vy_half", "m/s", "", state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 1}},
      FieldN<3>{"vz_half", "m/s", "", state, CarriedBy::modified_leap_frog, EmptySlot::zero, {&P::velocity_half, 2}},
      FieldN<3>{"density_excess_half", "kg/m^3", "", state, CarriedBy::modified_leap_frog, EmptySlot::zero, &P::density_excess_half},
      FieldN<3>{"ax", "m/s^2", "", state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 0}},
      FieldN<3>{"ay", "m/s^2", "", state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 1}},
      FieldN<3>{"az", "m/s^2", "", state, CarriedBy::kick_drift_kick, EmptySlot::zero, {&P::acceleration, 2}},
      FieldN<3>{"x_sorted", "m", "", state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 0}},
      FieldN<3>{"y_sorted", "m", "", state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 1}},
      FieldN<3>{"z_sorted", "m", "", state, CarriedBy::every_scheme, EmptySlot::nowhere, {&P::position_sorted, 2}},
      FieldN<3>{"id", "1", "", state, CarriedBy::every_scheme, EmptySlot::nobody, &P::id},
  };
};
// clang-format on

namespace {

constexpr double kSpacing = 0.1;  // m
constexpr int kSteps = 60;        // with several sorts

using Solver3 = SolverN<3>;
using State3 = SolverStateN<3>;

/// A scheme with the terms of fill_in_space(); c = 20 m/s.
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

}  // namespace
}  // namespace sluice
#endif

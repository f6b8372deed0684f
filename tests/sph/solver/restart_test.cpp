// The promise of exact restart: same method and SIMD target, any threads, any interruptions, same
// bits.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr int kColumns = 34;
constexpr int kRows = 26;
const Vec2 kCorner(-1.7, -1.6);

TestMethod method_of(Integrator integrator, Precision precision) {
  TestMethod m = full_method();
  m.integrator = integrator;
  m.precision = precision;
  m.domain.box = {{-2.0, -2.0}, {2.0, 1.2}};
  m.domain.wall_top = 1.0;
  if (integrator == Integrator::kick_drift_kick) m.shifting = ParticleShifting{2.0};
  return m;
}

/// Violent enough to sort, splash and leave the domain within 60 steps.
Fluid splash() {
  Dice dice(77);
  Fluid fluid = random_block(dice, kCorner, kColumns, kRows, 0.1, 0.1, 1.5, 10.0);
  for (std::size_t i = 0; i < fluid.size(); i += 97) fluid.v[i] = {3.0, 12.0};
  for (int k = 0; k < 6; ++k) fluid.add({-1.0 + 0.4 * k, 1.1}, {0.0, 3.0 + 2.0 * k}, 0.0);
  return fluid;
}

std::vector<Vec2> tank() { return walls_around(kCorner, kColumns, kRows, 0.1); }

struct Whole {
  SolverStateN<2> end;
  std::vector<std::uint64_t> sorted_at;  ///< steps in which a sort took place
};

Whole uninterrupted(const TestMethod& m, std::uint64_t steps) {
  SolverN<2> solver = solver_for(m, start_from(splash()), tank(), {});
  Whole run;
  for (std::uint64_t n = 0; n < steps; ++n) {
    const auto sorts = solver.sort_count();
    solver.step();
    if (solver.sort_count() != sorts) run.sorted_at.push_back(n);
  }
  run.end = solver.state();
  return run;
}

/// Stops before each of the given steps and goes on in a new solver, with 1, 2, 3 and 8 threads in
/// turn.
SolverStateN<2> in_parts(const TestMethod& m, std::uint64_t steps,
                         std::vector<std::uint64_t> stops) {
  std::sort(stops.begin(), stops.end());
  stops.push_back(steps);
  constexpr int kThreads[] = {1, 2, 3, 8};
  SolverStateN<2> state = start_from(splash());
  std::size_t part = 0;
  for (const std::uint64_t stop : stops) {
    SolverN<2> solver = solver_for(m, state, tank(), {kThreads[part++ % 4], ""});
    while (solver.step_count() < stop) solver.step();
    state = solver.state();
  }
  return state;
}

class ThreadsAndRestart : public ::testing::TestWithParam<std::tuple<Integrator, Precision>> {
 protected:
  [[nodiscard]] static TestMethod method() {
    return method_of(std::get<0>(GetParam()), std::get<1>(GetParam()));
  }
};

TEST_P(ThreadsAndRestart, TheSplashSortsAndLosesParticlesElseItProvesLittle) {
  const Whole run = uninterrupted(method(), 60);
  EXPECT_GT(run.sorted_at.size(), 2U);
  EXPECT_LT(run.sorted_at.size(), 30U);
  EXPECT_GT(run.end.removed.size(), 0U);
}

TEST_P(ThreadsAndRestart, AnyNumberOfThreadsGivesTheSameBits) {
  const TestMethod m = method();
  const SolverStateN<2> expected = uninterrupted(m, 30).end;
  for (const int threads : {2, 3, 8}) {
    SolverN<2> solver = solver_for(m, start_from(splash()), tank(), {threads, ""});
    run_steps(solver, 30);
    expect_same_bits(solver.state(), expected, std::to_string(threads) + " threads");
  }
}

TEST_P(ThreadsAndRestart, AStopAtReinitialisationsAndSortsGivesTheSameBits) {
  const TestMethod m = method();
  const Whole run = uninterrupted(m, 60);
  std::vector<std::uint64_t> stops{0, 1, 2, 19, 20, 21, 39, 40, 41, 60};
  for (const std::uint64_t sorted : run.sorted_at) {
    stops.insert(stops.end(), {sorted > 0 ? sorted - 1 : 0, sorted, sorted + 1});
  }
  for (const std::uint64_t stop : stops) {
    const std::uint64_t at = std::min<std::uint64_t>(stop, 60);
    expect_same_bits(in_parts(m, 60, {at}), run.end, "stop before step " + std::to_string(at));
  }
}

TEST_P(ThreadsAndRestart, AStopAfterEveryStepGivesTheSameBits) {
  const TestMethod m = method();
  std::vector<std::uint64_t> all(60);
  std::iota(all.begin(), all.end(), 0U);
  expect_same_bits(in_parts(m, 60, all), uninterrupted(m, 60).end, "60 stops");
}

TEST_P(ThreadsAndRestart, StopsAtRandomStepsGiveTheSameBits) {
  const TestMethod m = method();
  const SolverStateN<2> expected = uninterrupted(m, 60).end;
  Dice dice(12);
  for (int trial = 0; trial < 6; ++trial) {
    std::vector<std::uint64_t> stops;
    for (std::size_t k = 1 + dice.below(5); k > 0; --k) stops.push_back(dice.below(61));
    expect_same_bits(in_parts(m, 60, stops), expected, "trial " + std::to_string(trial));
  }
}

/// The tank's right wall goes up by about half of its height within 60 steps.
TestMethod lifting(TestMethod m) {
  m.laminar_viscosity = LaminarViscosity{0.01};
  m.wall_artificial_viscosity.reset();
  m.domain.gate = GateMotionN<2>{{{1.7, -1.6}, {2.0, 1.0}}, 15.0};
  return m;
}

TEST_P(ThreadsAndRestart, AStopWhileAWallIsLiftedGivesTheSameBits) {
  const TestMethod m = lifting(method());
  const Whole run = uninterrupted(m, 60);
  const double edge = -1.6 + 15.0 * run.end.time;
  EXPECT_GT(edge, -1.0);
  EXPECT_LT(edge, 1.0);
  std::vector<std::uint64_t> all(60);
  std::iota(all.begin(), all.end(), 0U);
  expect_same_bits(in_parts(m, 60, all), run.end, "60 stops");
}

TEST_P(ThreadsAndRestart, TakingTheStateChangesNothing) {
  const TestMethod m = method();
  SolverN<2> watched = solver_for(m, start_from(splash()), tank(), {});
  for (int n = 0; n < 30; ++n) {
    expect_same_bits(watched.state(), watched.state(), "taken twice");
    static_cast<void>(watched.energy());
    static_cast<void>(watched.pressure_at({0.0, -1.0}, 0.12));
    static_cast<void>(watched.surface_height_at({0.0, 0.0}));
    static_cast<void>(watched.wall_pressures());
    watched.step();
  }
  expect_same_bits(watched.state(), uninterrupted(m, 30).end, "watched at every step");
}

TEST_P(ThreadsAndRestart, AStateGivenToASolverComesBackAsItWas) {
  const TestMethod m = method();
  for (const int steps : {1, 7, 20, 33}) {
    SolverN<2> solver = solver_for(m, start_from(splash()), tank(), {});
    run_steps(solver, steps);
    const SolverStateN<2> taken = solver.state();
    const SolverN<2> next = solver_for(m, taken, tank(), {2, ""});
    expect_same_bits(next.state(), taken, "after " + std::to_string(steps) + " steps");
    EXPECT_EQ(next.particle_count(), taken.particles.size());
    EXPECT_EQ(next.step_count(), taken.step);
    EXPECT_EQ(next.time(), taken.time);
    EXPECT_EQ(next.time_step(), taken.time_step);
  }
}

TEST_P(ThreadsAndRestart, WhatReadersSeeDoesNotDependOnAStop) {
  const TestMethod m = method();
  SolverN<2> solver = solver_for(m, start_from(splash()), tank(), {});
  run_steps(solver, 33);
  const SolverN<2> next = solver_for(m, solver.state(), tank(), {});
  for (double x = -1.5; x < 1.7; x += 0.31) {
    EXPECT_EQ(next.surface_height_at({x, 0.0}).value, solver.surface_height_at({x, 0.0}).value);
    const Vec2 point(x, -1.3);
    EXPECT_EQ(next.pressure_at(point, 0.12).value, solver.pressure_at(point, 0.12).value);
    EXPECT_EQ(next.pressure_at(point, 0.12).weight, solver.pressure_at(point, 0.12).weight);
    EXPECT_EQ(next.distance_to_fluid(point), solver.distance_to_fluid(point));
  }
  EXPECT_EQ(next.energy().total(), solver.energy().total());
  EXPECT_EQ(next.surge_front().value, solver.surge_front().value);
  EXPECT_EQ(next.extremes().max_speed, solver.extremes().max_speed);
  EXPECT_EQ(next.extremes().max_neighbours, solver.extremes().max_neighbours);
  EXPECT_EQ(next.extremes().min_density_excess, solver.extremes().min_density_excess);
  EXPECT_EQ(next.extremes().max_density_excess, solver.extremes().max_density_excess);
}

/// Hands the same particles over in another order.
SolverStateN<2> shuffled(const SolverStateN<2>& state, std::uint64_t seed) {
  std::vector<std::size_t> order(state.particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Dice dice(seed);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[dice.below(k)]);
  SolverStateN<2> other = state;
  for (const FieldN<2>& field : FieldList<2>::fields) {
    const auto& from = field.values.of(state.particles);
    auto& to = field.values.of(other.particles);
    for (std::size_t k = 0; k < from.size(); ++k) to[k] = from[order[k]];
  }
  return other;
}

TEST_P(ThreadsAndRestart, TheOrderInWhichParticlesAreGivenChangesNoBit) {
  const TestMethod m = method();
  const SolverStateN<2> expected = uninterrupted(m, 25).end;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SolverN<2> solver = solver_for(m, shuffled(start_from(splash()), seed), tank(), {});
    run_steps(solver, 25);
    expect_same_bits(solver.state(), expected, "order " + std::to_string(seed));
  }
}

TEST_P(ThreadsAndRestart, CoincidentParticlesAreOrderedByTheirIds) {
  const TestMethod m = method();
  Dice dice(13);
  Fluid fluid = random_block(dice, {-0.3, -0.3}, 6, 6, 0.1, 0.1, 1.0, 10.0);
  for (int k = 0; k < 7; ++k) {
    fluid.add(fluid.x[20], dice.in_box({-1, -1}, {1, 1}), dice.between(-10, 10));
  }
  SolverN<2> expected = solver_for(m, start_from(fluid), {}, {});
  run_steps(expected, 3);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SolverN<2> solver = solver_for(m, shuffled(start_from(fluid), seed), {}, {});
    run_steps(solver, 3);
    expect_same_bits(solver.state(), expected.state(), "order " + std::to_string(seed));
  }
}

TEST_P(ThreadsAndRestart, TheOrderOfTheWallsMovesOnlyTheirPressures) {
  const TestMethod m = method();
  std::vector<Vec2> reversed = tank();
  std::reverse(reversed.begin(), reversed.end());
  SolverN<2> one = solver_for(m, start_from(splash()), tank(), {});
  SolverN<2> other = solver_for(m, start_from(splash()), reversed, {});
  run_steps(one, 10);
  run_steps(other, 10);
  expect_same_bits(one.state(), other.state(), "walls reversed");
  std::vector<double> pressures = other.wall_pressures();
  std::reverse(pressures.begin(), pressures.end());
  EXPECT_EQ(one.wall_pressures(), pressures);
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, ThreadsAndRestart,
    ::testing::Combine(::testing::ValuesIn(kIntegrators), ::testing::ValuesIn(kPrecisions)),
    [](const auto& scheme) {
      const bool leap_frog = std::get<0>(scheme.param) == Integrator::modified_leap_frog;
      return std::string(leap_frog ? "LeapFrog" : "KickDriftKick") +
             (std::get<1>(scheme.param) == Precision::mixed ? "Mixed" : "Double");
    });

/// Any small fluid, any stop: what the fixed scenes above do not think of.
RC_GTEST_PROP(RestartProperty, AnySmallFluidGoesOnWithTheSameBits, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 40);
  const auto steps = *rc::gen::inRange(1, 45);
  const auto stop = *rc::gen::inRange(0, steps + 1);
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000000);
  TestMethod m =
      method_of(*rc::gen::element(Integrator::modified_leap_frog, Integrator::kick_drift_kick),
                *rc::gen::element(Precision::mixed, Precision::double_precision));
  m.kernel = *rc::gen::element(KernelKind::truncated_gaussian, KernelKind::wendland_c2);
  m.reinitialisation->interval = *rc::gen::inRange(1, 25);
  Dice dice(seed);
  Fluid fluid;
  for (std::size_t i = 0; i < count; ++i) {
    fluid.add(dice.in_box({-0.5, -0.5}, {0.5, 0.5}), dice.in_box({-9, -9}, {9, 9}),
              dice.between(-20, 20));
    if (dice.below(5) == 0) fluid.x.back() = fluid.x.front();  // coincident
  }
  std::vector<Vec2> walls;
  for (std::size_t k = dice.below(30); k > 0; --k) walls.push_back(dice.in_box({-1, -1}, {1, 1}));

  SolverN<2> whole = solver_for(m, start_from(fluid), walls, {});
  run_steps(whole, steps);
  SolverN<2> first = solver_for(m, start_from(fluid), walls, {2, ""});
  run_steps(first, stop);
  SolverN<2> second = solver_for(m, first.state(), walls, {});
  run_steps(second, steps - stop);
  const SolverStateN<2> a = whole.state();
  const SolverStateN<2> b = second.state();
  for (const FieldN<2>& field : FieldList<2>::fields) {
    const bool same = field.values.of(a.particles) == field.values.of(b.particles);
    RC_ASSERT(same);
  }
  RC_ASSERT(a.time == b.time);
  RC_ASSERT(a.removed.size() == b.removed.size());
}

}  // namespace
}  // namespace sluice

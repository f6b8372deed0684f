// Particles that became what the scheme cannot hold: out of all sums at once, and booked.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "engine/sph/method/removed.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kBad = 44;

TestMethod method_of(Integrator integrator, Precision precision) {
  TestMethod m = full_method();
  m.integrator = integrator;
  m.precision = precision;
  return m;
}

Fluid block() {
  Dice dice(91);
  return random_block(dice, {-0.5, -0.5}, 10, 10, 0.1, 0.1, 0.5, 10.0);
}

/// The state without one particle.
SolverStateN<2> without(SolverStateN<2> state, std::size_t index) {
  for (const FieldN<2>& field : FieldList<2>::fields) {
    std::vector<double>& values = field.values.of(state.particles);
    if (!values.empty()) values.erase(values.begin() + static_cast<std::ptrdiff_t>(index));
  }
  return state;
}

struct Fault {
  FieldMember<ParticlesN<2>, Values, ParticlesN<2>::Axes> field;
  double value;
  RemovalCause cause;
};
const Fault kFaults[] = {
    {&ParticlesN<2>::density_excess, 301.0, RemovalCause::too_dense},
    {&ParticlesN<2>::density_excess, -301.0, RemovalCause::too_thin},
    {{&ParticlesN<2>::velocity, 0}, 20.1, RemovalCause::too_fast},
    {{&ParticlesN<2>::velocity, 1}, -1e200, RemovalCause::too_fast},
    {{&ParticlesN<2>::position, 0}, kNan, RemovalCause::not_finite},
    {{&ParticlesN<2>::position, 1}, -kInfinity, RemovalCause::not_finite},
    {{&ParticlesN<2>::velocity, 0}, kNan, RemovalCause::not_finite},
    {&ParticlesN<2>::density_excess, kInfinity, RemovalCause::not_finite},
};

TEST(Exclusion, OfOneParticleAtTheStartLeavesTheOthersAsIfItHadNeverBeen) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      const TestMethod m = method_of(integrator, precision);
      const SolverStateN<2> good = start_from(block());
      SolverN<2> expected = solver_for(m, without(good, kBad), {}, {});
      run_steps(expected, 40);
      for (const Fault& fault : kFaults) {
        SolverStateN<2> bad = good;
        fault.field.of(bad.particles)[kBad] = fault.value;
        SolverN<2> solver = solver_for(m, bad, {}, {});
        ASSERT_EQ(solver.removed().size(), 1U);
        EXPECT_EQ(solver.removed()[0].id, static_cast<double>(kBad));
        EXPECT_EQ(solver.removed()[0].cause, fault.cause) << fault.value;
        EXPECT_EQ(solver.particle_count(), 99U);
        run_steps(solver, 40);
        SolverStateN<2> seen = solver.state();
        EXPECT_EQ(seen.removed.size(), 1U);
        seen.removed.clear();
        expect_same_bits(seen, expected.state(), std::string(to_string(fault.cause)));
      }
    }
  }
}

/// A state under way in which one particle has just gone wrong: what its half steps make of it is
/// wrong at the end of the next step.
SolverStateN<2> gone_wrong(const TestMethod& m, std::size_t steps) {
  SolverN<2> solver = solver_for(m, start_from(block()), {}, {});
  while (solver.step_count() < steps) solver.step();
  SolverStateN<2> state = solver.state();
  ParticlesN<2>& p = state.particles;
  for (Values* values : {&p.density_excess, &p.density_excess_half}) {
    if (!values->empty()) (*values)[kBad] = 299.0;
  }
  for (Values* values : {&p.velocity[0], &p.velocity_half[0]}) {
    if (!values->empty()) (*values)[kBad] = 19.5;
  }
  return state;
}

TEST(Exclusion, UnderWayIsTheSameForAnyThreadsStopAndTarget) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      const TestMethod m = method_of(integrator, precision);
      const SolverStateN<2> start = gone_wrong(m, 7);
      for (const std::string& target : simd_targets()) {
        SolverN<2> whole = solver_for(m, start, {}, {1, target});
        run_steps(whole, 60);
        ASSERT_GT(whole.removed().size(), 0U) << "nobody excluded: this test proves nothing";
        EXPECT_LT(whole.removed().size(), 20U);
        EXPECT_TRUE(is_exclusion(whole.removed()[0].cause));
        const std::uint64_t at = whole.removed()[0].step;
        EXPECT_GT(at, 7U) << "excluded when it was loaded";
        for (const std::uint64_t stop : {at - 1, at, at + 1}) {
          for (const int threads : {2, 3, 8}) {
            SolverN<2> first = solver_for(m, start, {}, {threads, target});
            while (first.step_count() < stop) first.step();
            SolverN<2> second = solver_for(m, first.state(), {}, {1, target});
            EXPECT_EQ(second.extremes().max_speed, first.extremes().max_speed);
            EXPECT_EQ(second.extremes().max_density_excess, first.extremes().max_density_excess);
            EXPECT_EQ(second.extremes().max_x, first.extremes().max_x);
            while (second.step_count() < whole.step_count()) second.step();
            expect_same_bits(second.state(), whole.state(), target);
          }
        }
      }
    }
  }
}

TEST(Exclusion, TakesTheExtremesOfTheOthers) {
  for (const Integrator integrator : kIntegrators) {
    const TestMethod m = method_of(integrator, Precision::double_precision);
    SolverN<2> solver = solver_for(m, gone_wrong(m, 7), {}, {});
    const auto bound = [&] {
      return solver.extremes().max_speed <= m.sound_speed &&
             std::abs(solver.extremes().max_density_excess) <= m.most_density_excess();
    };
    for (int n = 0; n < 60; ++n) {
      solver.step();
      EXPECT_TRUE(bound()) << "step " << solver.step_count();
      EXPECT_GE(solver.time_step(), m.least_time_step());
      const SolverStateN<2> state = solver.state();
      double fastest = 0.0;
      for (std::size_t i = 0; i < state.particles.size(); ++i) {
        fastest = std::max(fastest, state.particles.velocity_of(i).norm());
      }
      EXPECT_DOUBLE_EQ(solver.extremes().max_speed, fastest);
    }
    EXPECT_GT(solver.removed().size(), 0U);
  }
}

TEST(Exclusion, DoesNotShortenTheStepForAParticleThatIsThrownAbout) {
  // 0.25 sqrt(h/a) would be a thousandth of h/c.
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = plain_method();
    m.integrator = integrator;
    m.gravity = {0.0, -6.25e4 * m.sound_speed * m.sound_speed / m.smoothing_length};
    Fluid fluid;
    fluid.add({0.0, 0.0});
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    run_steps(solver, 2);
    EXPECT_DOUBLE_EQ(m.least_time_step(), 0.05 * m.smoothing_length / m.sound_speed);
    EXPECT_EQ(solver.particle_count(), 0U);
    ASSERT_EQ(solver.removed().size(), 1U);
    EXPECT_EQ(solver.removed()[0].cause, RemovalCause::too_fast);
  }
}

TEST(Exclusion, BooksMassMomentumAndEnergy) {
  TestMethod m = plain_method();
  m.gravity = {2.0, -3.0};
  SolverStateN<2> state = start_from(block());
  ParticlesN<2>& p = state.particles;
  p.density_excess[kBad] = 400.0;
  p.velocity[0][kBad] = 3.0;
  p.velocity[1][kBad] = -4.0;
  const Vec2 place = p.position_of(kBad);
  const SolverN<2> solver = solver_for(m, state, {}, {});
  ASSERT_EQ(solver.removed().size(), 1U);
  Departed departed;
  departed.add(method_as<kAnyDim>(m), removed_as<kAnyDim>(solver.removed()[0]));
  const double mass = 1000.0 * 0.1 * 0.1;
  EXPECT_EQ(departed.count, 1U);
  EXPECT_DOUBLE_EQ(departed.mass, mass);
  EXPECT_DOUBLE_EQ(departed.momentum.x(), 3.0 * mass);
  EXPECT_DOUBLE_EQ(departed.momentum.y(), -4.0 * mass);
  EXPECT_DOUBLE_EQ(departed.energy.kinetic, 12.5 * mass);
  EXPECT_DOUBLE_EQ(departed.energy.potential, -mass * (2.0 * place.x() - 3.0 * place.y()));
  // c^2 (ln 1.4 + 1/1.4 - 1)
  EXPECT_NEAR(departed.energy.internal, mass * 400.0 * (std::log(1.4) + 1.0 / 1.4 - 1.0), 1e-9);
}

TEST(Exclusion, KeepsNoNumberThatIsNone) {
  SolverStateN<2> state = start_from(block());
  state.particles.position[0][kBad] = kNan;
  state.particles.velocity[0][kBad] = kInfinity;
  state.particles.density_excess[kBad] = kNan;
  const SolverN<2> solver = solver_for(plain_method(), state, {}, {});
  ASSERT_EQ(solver.removed().size(), 1U);
  Departed departed;
  departed.add(method_as<kAnyDim>(plain_method()), removed_as<kAnyDim>(solver.removed()[0]));
  EXPECT_TRUE(std::isfinite(departed.energy.total()));
  EXPECT_TRUE(departed.momentum.allFinite());
}

TEST(Solids, TakeWhoIsDeepInThemForALeakWithinFourCrossings) {
  for (const Integrator integrator : kIntegrators) {
    TestMethod m = plain_method();
    m.integrator = integrator;
    m.domain.in_solid = [](const Vec2& place, double) { return place.x() > 0.5; };
    Fluid fluid;
    fluid.add({0.0, 0.0}, {10.0, 0.0});
    fluid.add({-1.0, 0.0}, {-1.0, 0.0});
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    while (solver.removed().empty() && solver.step_count() < 200) solver.step();
    ASSERT_EQ(solver.removed().size(), 1U);
    EXPECT_EQ(solver.removed()[0].id, 0.0);
    EXPECT_EQ(solver.removed()[0].cause, RemovalCause::leaked);
    EXPECT_GT(solver.removed()[0].position.x(), 0.5);
    EXPECT_LE(solver.removed()[0].position.x(), 0.5 + 10.0 * 4.0 * 0.1 / 20.0);
  }
}

TEST(Solids, TheWallsOfATankAreOutsideOfItsRoom) {
  TestMethod m = plain_method();
  m.domain.room = {{-1.0, -1.0}, {1.0, kInfinity}};
  m.domain.wall_top = 0.5;
  m.domain.walls_reach = 0.4;
  m.domain.rim.min[0] = -1.2;
  m.domain.rim.max[0] = 1.2;
  EXPECT_TRUE(m.domain.keeps({0.0, 0.0}));
  EXPECT_FALSE(m.domain.keeps({1.1, 0.0}));
  EXPECT_FALSE(m.domain.keeps({0.0, -1.1}));
  EXPECT_TRUE(m.domain.keeps({1.1, 0.6})) << "over the wall, before its middle";
  EXPECT_TRUE(m.domain.keeps({1.1, 0.45})) << "it lies on the wall";
  EXPECT_FALSE(m.domain.keeps({1.3, 0.6}));
  EXPECT_FALSE(m.domain.keeps({1.3, 0.45})) << "it has run over the wall";
  for (const Integrator integrator : kIntegrators) {
    m.integrator = integrator;
    Fluid fluid;
    for (const Vec2& place :
         {Vec2(0.0, 0.0), Vec2(1.1, 0.0), Vec2(0.0, -1.1), Vec2(1.1, 0.6), Vec2(1.3, 0.45)}) {
      fluid.add(place);
    }
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    ASSERT_EQ(solver.removed().size(), 3U);
    for (const RemovedParticleN<2>& each : solver.removed()) {
      EXPECT_EQ(each.cause, each.id == 4.0 ? RemovalCause::overtopped : RemovalCause::leaked);
    }
  }
}

}  // namespace
}  // namespace sluice

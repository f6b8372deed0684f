// No pair within the support is ever missed: the engine's rates against all pairs, step after step,
// where lists are old, particles fast, rows and origin cells end. A missed pair at the very edge of
// the support changes a rate by 1e-4 of a summand, far above the tolerances here.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "tests/sph/plain_sums.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

constexpr double kH = 0.1;

TestMethod pair_method(Precision precision) {
  TestMethod m = full_method();
  m.smoothing_length = kH;
  m.reinitialisation.reset();
  m.precision = precision;
  return m;
}

/// Rates of `steps` steps of the leap-frog against all pairs.
void expect_all_pairs(const TestMethod& m, const Fluid& start, const std::vector<Vec2>& walls,
                      int steps, const std::string& target, const std::string& what) {
  // Mixed precision resolves 3e-5 h where a domain has several origins, and better in a small one.
  const bool vast = m.domain.box.size().x() > 1024.0 * kH;
  const double single = vast ? 1e-4 : 1e-5;
  const double eps = m.precision == Precision::mixed ? single : 1e-10;
  SolverN<2> solver = solver_for(m, start_from(start), walls, {1, target});
  for (int n = 0; n < steps; ++n) {
    const Fluid fluid = fluid_of(solver.state());
    const PlainRates expected = plain_rates(m, fluid, walls, plain_wall_pressures(m, fluid, walls));
    const FluidRates seen = rates_of_next_step(solver);
    const std::string where =
        what + ", " + name_of(m.precision) + ", " + target + ", step " + std::to_string(n);
    expect_near(seen.acceleration, expected.acceleration, eps * expected.acceleration_size,
                where + ": acceleration");
    expect_near(seen.density, expected.density, eps * expected.density_size,
                where + ": density rate");
    if (::testing::Test::HasFailure()) return;
  }
}

void expect_all_pairs_in_both(TestMethod m, const Fluid& fluid, const std::vector<Vec2>& walls,
                              int steps, const std::string& what) {
  for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
    m.precision = precision;
    for (const std::string& target : simd_targets()) {
      expect_all_pairs(m, fluid, walls, steps, target, what);
    }
  }
}

TEST(Neighbours, AreAllFoundWhileAJetFliesThroughABlock) {
  Dice dice(41);
  Fluid fluid = random_block(dice, {-0.8, -0.8}, 16, 10, kH, 0.2, 1.0, 10.0);
  // Faster than sound: particles that no path is fast enough for.
  for (int k = 0; k < 6; ++k) fluid.add({-1.5 + 0.0973 * k, -0.2}, {25.0, 1.0}, 0.0);
  expect_all_pairs_in_both(pair_method(Precision::mixed), fluid, {}, 40, "jet");
}

TEST(Neighbours, AreAllFoundBesideWallsOverManySorts) {
  Dice dice(42);
  const Fluid fluid = random_block(dice, {-0.8, -0.8}, 16, 12, kH, 0.2, 3.0, 10.0);
  expect_all_pairs_in_both(pair_method(Precision::mixed), fluid,
                           walls_around({-0.8, -0.8}, 16, 12, kH), 130, "tank");
}

TEST(Neighbours, AreAllFoundWhereParticlesCrowd) {
  Dice dice(43);
  Fluid fluid;
  for (int k = 0; k < 60; ++k) fluid.add(dice.in_box({0.0, 0.0}, {0.2, 0.2}), {0.0, 0.0}, 0.0);
  for (int k = 0; k < 60; ++k) fluid.add(dice.in_box({-1, -1}, {1, 1}), {0.0, 0.0}, 1.0);
  // Few steps: it blows up, and where densities pass through zero viscosity has no rounding bound.
  expect_all_pairs_in_both(pair_method(Precision::mixed), fluid, {}, 6, "crowd");
}

TEST(Neighbours, AreAllFoundWhereParticlesCoincide) {
  Dice dice(44);
  Fluid fluid = random_block(dice, {-0.3, -0.3}, 6, 6, kH, 0.1, 1.0, 10.0);
  for (std::size_t k = 0; k < 6; ++k) fluid.add(fluid.x[0], Vec2::Zero(), 1.0);
  fluid.add(fluid.x[7], fluid.v[7], 3.0);
  expect_all_pairs_in_both(pair_method(Precision::mixed), fluid, {}, 1, "coincident");
}

TEST(Neighbours, AreAllFoundInOneRowAndInOneColumn) {
  Fluid row;
  Fluid column;
  for (int k = 0; k < 30; ++k) {
    // Not at whole numbers of h, where rounding decides which side of the cut-off a pair is on.
    const double place = -1.5 + 0.97 * kH * k;
    row.add({place, 0.0}, {0.1 * k, 0.0}, 0.3 * k);
    column.add({0.0, place}, {0.0, 0.1 * k}, 0.3 * k);
  }
  expect_all_pairs_in_both(pair_method(Precision::mixed), row, {}, 10, "row");
  expect_all_pairs_in_both(pair_method(Precision::mixed), column, {}, 10, "column");
}

TEST(Neighbours, AreAllFoundAtTheEdgesOfCells) {
  // On the lattice of twice the spacing that starts at the domain's corner, and one rounding
  // beside it.
  Fluid fluid;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double x = -1.8 + 2.0 * kH * i;
      const double y = -1.8 + 2.0 * kH * j;
      fluid.add({i % 2 == 0 ? x : std::nextafter(x, -9.0), j % 2 == 0 ? y : std::nextafter(y, 9.0)},
                {0.1 * j, -0.1 * i}, 0.1 * i);
    }
  }
  expect_all_pairs_in_both(pair_method(Precision::mixed), fluid, {}, 10, "edges");
}

TEST(Neighbours, AreAllFoundWhereParticlesLieFarApart) {
  Fluid fluid;
  for (int i = 0; i < 5; ++i) {
    const Vec2 place(-1.9 + 0.9 * i, 1.8 - 0.8 * i);
    fluid.add(place, {1.0, 0.0}, 1.0);
    if (i % 2 == 0) fluid.add(place + Vec2(0.29, 0.0), {-1.0, 0.0}, 2.0);
  }
  expect_all_pairs_in_both(pair_method(Precision::mixed), fluid, {}, 10, "far apart");
}

/// 3000 h wide: single-precision positions have several origins.
TestMethod vast_method(Precision precision) {
  TestMethod m = pair_method(precision);
  m.domain.box = {{-150.0, -150.0}, {150.0, 150.0}};
  return m;
}

TEST(Neighbours, AreThoseOfBeforeBesideAParticleFarOutsideTheDomain) {
  Dice dice(48);
  const Fluid fluid = random_block(dice, {-0.8, -0.8}, 16, 10, kH, 0.2, 1.0, 10.0);
  Fluid more = fluid;
  more.add({-4000.0 * kH, -0.75}, {0.0, 0.0}, 0.0);
  for (const Precision precision : {Precision::double_precision, Precision::mixed}) {
    for (const std::string& target : simd_targets()) {
      const TestMethod m = pair_method(precision);
      SolverN<2> alone = solver_for(m, start_from(fluid), {}, {1, target});
      SolverN<2> beside = solver_for(m, start_from(more), {}, {1, target});
      alone.step();
      beside.step();
      const Fluid expected = fluid_of(alone.state());
      const Fluid seen = fluid_of(beside.state());
      ASSERT_EQ(seen.size(), expected.size()) << "what is outside is retired";
      const double eps = precision == Precision::mixed ? 1e-6 : 1e-12;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_NEAR((seen.v[i] - expected.v[i]).norm(), 0.0, eps) << target << " " << i;
      }
    }
  }
}

TEST(Neighbours, AreAllFoundAcrossTheOriginCellsOfAVastDomain) {
  Dice dice(46);
  // 512 h is 51.2 m: patches that straddle each of these edges, corners among them.
  Fluid fluid;
  std::vector<Vec2> walls;
  const double edge = 51.2;
  for (const Vec2& center : {Vec2(edge, edge), Vec2(0.6, edge), Vec2(2.0 * edge, 0.5 * edge),
                             Vec2(5.0 * edge, 5.0 * edge), Vec2(130.0, 170.0), Vec2(3.0, 4.0)}) {
    const Vec2 place = Vec2(-150.0, -150.0) + center;
    for (int k = 0; k < 30; ++k) {
      const Vec2 x = place + dice.in_box({-0.4, -0.4}, {0.4, 0.4});
      fluid.add(x, dice.in_box({-2, -2}, {2, 2}), dice.between(-10, 10));
    }
    for (int k = 0; k < 10; ++k) walls.push_back(place + dice.in_box({-0.5, -0.5}, {0.5, 0.5}));
  }
  TestMethod m = vast_method(Precision::mixed);
  expect_all_pairs_in_both(m, fluid, walls, 12, "vast domain");
  m.kernel = KernelKind::wendland_c2;
  expect_all_pairs_in_both(m, fluid, walls, 12, "vast domain, Wendland");
}

TEST(Neighbours, AreAllFoundInALongChannelFarFromTheOrigin) {
  // h is 0.1 m: the far end is 1e4 to 1e7 smoothing lengths away.
  for (const double far : {1e3, 1e4, 1e5, 1e6}) {
    Dice dice(47);
    const Fluid fluid = random_block(dice, {far, 0.0}, 8, 8, kH, 0.3, 3.0, 10.0);
    TestMethod m = pair_method(Precision::double_precision);
    m.diffusion->kind = DiffusionKind::molteni_colagrossi;
    m.domain.box = {{-1.0, -1.0}, {far + 3.0, 3.0}};
    const std::string what = "channel of " + std::to_string(far) + " m";
    // Positions resolve 1e-10 m or better here.
    SolverN<2> solver = solver_for(m, start_from(fluid), {}, {});
    for (int n = 0; n < 30; ++n) {
      const Fluid now = fluid_of(solver.state());
      const PlainRates expected = plain_rates(m, now, {}, {});
      const FluidRates seen = rates_of_next_step(solver);
      expect_near(seen.acceleration, expected.acceleration, 1e-8 * expected.acceleration_size,
                  what + ", step " + std::to_string(n));
      if (HasFailure()) break;
    }
  }
}

TEST(Neighbours, TheBoundOfTheirNumberIsNotBelowTheTruth) {
  Fluid fluid;
  Dice dice(48);
  for (int k = 0; k < 300; ++k) fluid.add(dice.in_box({0, 0}, {0.1, 0.1}));
  const SolverN<2> crowd = solver_for(pair_method(Precision::mixed), start_from(fluid), {}, {});
  EXPECT_GE(crowd.extremes().max_neighbours, 300U);

  const Fluid block = random_block(dice, {-1.0, -1.0}, 20, 20, kH, 0.0, 0.0, 0.0);
  const SolverN<2> even = solver_for(pair_method(Precision::mixed), start_from(block), {}, {});
  // 9 pi = 28.3 lattice points lie within 3 h.
  EXPECT_EQ(even.extremes().max_neighbours, 0U);
}

}  // namespace
}  // namespace sluice

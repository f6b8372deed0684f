#include "engine/sph/loops/simd_target.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

Fluid block() {
  Dice dice(81);
  return random_block(dice, {-1.0, -1.0}, 16, 14, 0.1, 0.2, 1.0, 10.0);
}

TEST(SimdTargets, AreNamedOnceEach) {
  std::vector<std::string> names = simd_targets();
  ASSERT_FALSE(names.empty());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST(SimdTargets, TheBestIsTakenUnlessAnotherIsNamed) {
  for (const Precision precision : kPrecisions) {
    TestMethod m = full_method();
    m.precision = precision;
    EXPECT_EQ(solver_for(m, start_from(block()), {}, {}).simd_target(), simd_targets().front());
    for (const std::string& name : simd_targets()) {
      EXPECT_EQ(solver_for(m, start_from(block()), {}, {1, name}).simd_target(), name);
    }
    EXPECT_EQ(solver_for(m, start_from(block()), {}, {}).simd_target(), simd_targets().front())
        << "a forced target outlived its solver";
  }
}

TEST(SimdTargets, DifferOnlyInRounding) {
  for (const Integrator integrator : kIntegrators) {
    for (const Precision precision : kPrecisions) {
      TestMethod m = full_method();
      m.integrator = integrator;
      m.precision = precision;
      SolverN<2> best = solver_for(m, start_from(block()), {}, {});
      run_steps(best, 25);
      const Fluid expected = fluid_of(best.state());
      const double eps = precision == Precision::mixed ? 1e-4 : 1e-11;
      for (const std::string& name : simd_targets()) {
        SolverN<2> solver = solver_for(m, start_from(block()), {}, {1, name});
        run_steps(solver, 25);
        const Fluid fluid = fluid_of(solver.state());
        expect_near(fluid.x, expected.x, eps * 0.1, name + ": position");
        expect_near(fluid.v, expected.v, eps * 20.0, name + ": velocity");
        expect_near(fluid.excess, expected.excess, eps * 20.0, name + ": density");
      }
    }
  }
}

TEST(SimdTargets, AnUnknownNameIsRefusedWithTheListOfKnownOnes) {
  for (const std::string bad : {"AVX9", "avx2", "SCALAR-ish", " "}) {
    try {
      const SolverN<2> solver = solver_for(full_method(), start_from(block()), {}, {1, bad});
      FAIL() << "accepted \"" << bad << '"';
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(bad), std::string::npos) << text;
      for (const std::string& name : simd_targets()) {
        EXPECT_NE(text.find(name), std::string::npos) << text;
      }
    }
  }
}

TEST(SimdTargets, ThreadsMayChooseAtTheSameTime) {
  const auto names = simd_targets();
  std::vector<std::string> seen(12);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    threads.emplace_back([&, k] {
      const SolverN<2> solver =
          solver_for(full_method(), start_from(block()), {}, {1, names[k % names.size()]});
      seen[k] = solver.simd_target();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k], names[k % names.size()]);
}

}  // namespace
}  // namespace sluice

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/run/simulation.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"
#include "tests/run/scenes.hpp"

namespace sluice {
namespace {

using testing::small_dam_break;
using testing::SmallScene;

constexpr std::array kThreads{1, 2, 3, 8};

/// Digest of everything, then of each series.
std::vector<std::string> digests(const Simulation& simulation) {
  std::vector<std::string> all{physics_digest(simulation.checkpoint())};
  for (const Series& series : split(simulation.samples())) all.push_back(series_digest(series));
  return all;
}

/// What a process that starts again sees: the bytes of a file.
Checkpoint through_file(const Checkpoint& checkpoint) {
  return decode_checkpoint(encode_checkpoint(checkpoint));
}

Simulation resumed(const Simulation& simulation, int threads) {
  return Simulation(simulation.scene(), {threads, ""}, through_file(simulation.checkpoint()));
}

void run_to_end(Simulation& simulation) {
  while (!simulation.finished()) simulation.step();
}

/// A run with interruptions after each of `steps`, the thread count changing at each.
std::vector<std::string> run_interrupted(const Scene& scene, const std::set<std::uint64_t>& steps) {
  Simulation simulation(scene, {1, ""});
  std::size_t part = 0;
  for (;;) {
    if (steps.contains(simulation.solver().step_count())) {
      simulation = resumed(simulation, kThreads[++part % kThreads.size()]);
    }
    if (simulation.finished()) return digests(simulation);
    simulation.step();
  }
}

struct Reference {
  std::vector<std::string> digests;
  std::uint64_t steps = 0;
  std::vector<std::uint64_t> sorting_steps;
};

Reference run_uninterrupted(const Scene& scene) {
  Simulation simulation(scene, {1, ""});
  Reference reference;
  std::uint64_t sorts = simulation.solver().sort_count();
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.solver().sort_count() == sorts) continue;
    sorts = simulation.solver().sort_count();
    reference.sorting_steps.push_back(simulation.solver().step_count());
  }
  reference.digests = digests(simulation);
  reference.steps = simulation.solver().step_count();
  return reference;
}

/// Steps at which something periodic is about to happen or just did, and random ones.
std::set<std::uint64_t> steps_to_interrupt(const Reference& reference, std::size_t count) {
  std::set<std::uint64_t> steps{0, 1, 19, 20, 39, 21, reference.steps};
  for (std::size_t i = 0; i < std::min<std::size_t>(4, reference.sorting_steps.size()); ++i) {
    steps.insert(reference.sorting_steps[i]);
    steps.insert(reference.sorting_steps[i] - 1);
  }
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::uint64_t> any(0, reference.steps);
  while (steps.size() < count) steps.insert(any(random));
  return steps;
}

class ExactRestart : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  [[nodiscard]] static Scene scene() {
    SmallScene choice;
    choice.integrator = std::get<0>(GetParam());
    choice.precision = std::get<1>(GetParam());
    choice.courant = choice.integrator == "kick_drift_kick" ? 0.5 : 0.25;
    return small_dam_break(choice);
  }
};

TEST_P(ExactRestart, GivesTheSameBitsAfterInterruptionsAtAnyStepWithAnyNumberOfThreads) {
  const Reference reference = run_uninterrupted(scene());
  ASSERT_GE(reference.sorting_steps.size(), 2U);
  EXPECT_EQ(run_interrupted(scene(), steps_to_interrupt(reference, 25)), reference.digests);
}

TEST_P(ExactRestart, GivesTheSameBitsWithAnyNumberOfThreadsFromTheStart) {
  const Reference reference = run_uninterrupted(scene());
  for (const int threads : {2, 3, 8}) {
    Simulation simulation(scene(), {threads, ""});
    run_to_end(simulation);
    EXPECT_EQ(digests(simulation), reference.digests) << threads << " threads";
  }
}

TEST_P(ExactRestart, SurvivesAChainOfFiftyInterruptions) {
  const Reference reference = run_uninterrupted(scene());
  std::set<std::uint64_t> steps;
  for (std::uint64_t i = 0; i < 50; ++i) steps.insert(i * reference.steps / 50);
  ASSERT_EQ(steps.size(), 50U);
  EXPECT_EQ(run_interrupted(scene(), steps), reference.digests);
}

TEST_P(ExactRestart, TakingACheckpointChangesNothingInTheRun) {
  const Reference reference = run_uninterrupted(scene());
  Simulation simulation(scene(), {1, ""});
  while (!simulation.finished()) {
    simulation.step();
    (void)simulation.checkpoint();
    (void)simulation.violation();
  }
  EXPECT_EQ(digests(simulation), reference.digests);
}

TEST_P(ExactRestart, ExtendingARunAfterItsEndIsExact) {
  Scene first = scene();
  const Scene whole = first;
  first.end_time = 0.37 * whole.end_time;
  Simulation simulation(first, {1, ""});
  run_to_end(simulation);
  Simulation extended(whole, {2, ""}, through_file(simulation.checkpoint()));
  EXPECT_FALSE(extended.finished());
  run_to_end(extended);
  EXPECT_EQ(digests(extended), run_uninterrupted(whole).digests);
}

TEST_P(ExactRestart, TellsRunsApartThatDifferInOneParticleByAMillionthOfASpacing) {
  Simulation simulation(scene(), {1, ""});
  for (int step = 0; step < 30; ++step) simulation.step();
  Checkpoint kept = simulation.checkpoint();
  kept.solver.particles.position[0].back() += 1e-6 * scene().method.spacing;
  Simulation nudged(scene(), {1, ""}, kept);
  run_to_end(nudged);
  EXPECT_NE(digests(nudged).front(), run_uninterrupted(scene()).digests.front());
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, ExactRestart,
    ::testing::Combine(::testing::Values("modified_leap_frog", "kick_drift_kick"),
                       ::testing::Values("mixed", "double")),
    [](const auto& tested) { return std::get<0>(tested.param) + "_" + std::get<1>(tested.param); });

}  // namespace
}  // namespace sluice

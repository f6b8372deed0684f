#include "engine/run/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/store/disk/errors.hpp"
#include "tests/run/scenes.hpp"

namespace sluice {
namespace {

using testing::small_dam_break;
using testing::SmallScene;

Series series_named(const Simulation& simulation, const std::string& name) {
  for (const Series& series : split(simulation.samples())) {
    if (series.name == name) return series;
  }
  throw std::out_of_range(name);
}

TEST(Simulation, SamplesStepZeroAndThenOnceAtOrAfterEachMultipleOfTheInterval) {
  Simulation simulation(small_dam_break(), {1, ""});
  EXPECT_EQ(series_named(simulation, "front").size(), 1U);
  std::vector<double> times{0.0};
  while (!simulation.finished()) {
    simulation.step();
    times.push_back(simulation.solver().time());
  }
  const Series front = series_named(simulation, "front");
  for (std::size_t k = 0; k < front.size(); ++k) {
    const double due = static_cast<double>(k) * 0.001;
    EXPECT_EQ(front.time[k], *std::lower_bound(times.begin(), times.end(), due));
  }
  EXPECT_EQ(series_named(simulation, "energy").time, times);
}

TEST(Simulation, DurationsAddUpToTheTimeCovered) {
  Simulation simulation(small_dam_break(), {1, ""});
  while (!simulation.finished()) simulation.step();
  for (const Series& series : split(simulation.samples())) {
    double sum = 0.0;
    for (const double duration : series.duration) sum += duration;
    ASSERT_GT(series.size(), 0U) << series.name;
    EXPECT_NEAR(sum, series.time.back() - series.time.front(), 1e-12) << series.name;
  }
}

TEST(Simulation, ADrySensorHasNoValueRatherThanZero) {
  const Simulation simulation(small_dam_break(), {1, ""});
  const Series pressure = series_named(simulation, "P");
  ASSERT_EQ(pressure.size(), 1U);
  EXPECT_TRUE(std::isnan(pressure.values[0]));
  EXPECT_EQ(pressure.weight[0], 0.0);
}

TEST(Simulation, TheColumnIsAsHighAtTheStartAsTheSceneSays) {
  const Simulation simulation(small_dam_break(), {1, ""});
  EXPECT_NEAR(series_named(simulation, "column").values.at(0), 0.15, 0.0075);
  EXPECT_NEAR(series_named(simulation, "front").values.at(0), 0.15, 1e-12);
}

TEST(Simulation, ArrivalIsOneSampleWhenTheFluidIsThere) {
  Simulation simulation(small_dam_break(), {1, ""});
  while (!simulation.finished()) {
    const bool seen = series_named(simulation, "arrival").size() > 0;
    simulation.step();
    const bool sees = series_named(simulation, "arrival").size() > 0;
    if (!seen && sees) {
      EXPECT_LE(simulation.solver().distance_to_fluid(Vec2(0.4, 0.01)), 1.5 * 0.0075);
      EXPECT_EQ(series_named(simulation, "arrival").values[0], simulation.solver().time());
    }
  }
  EXPECT_EQ(series_named(simulation, "arrival").size(), 1U);
}

TEST(Simulation, EndsAtTheFirstStepAtOrAfterTheEndTime) {
  Simulation simulation(small_dam_break(), {1, ""});
  double before = 0.0;
  while (!simulation.finished()) {
    before = simulation.solver().time();
    simulation.step();
  }
  EXPECT_LT(before, 0.2);
  EXPECT_GE(simulation.solver().time(), 0.2);
}

TEST(Simulation, FramesGoOnCountingAfterARestart) {
  SmallScene choice;
  choice.frames = true;
  const Scene scene = small_dam_break(choice);
  std::vector<std::uint64_t> indices;
  Simulation simulation(scene, {1, ""});
  while (!simulation.finished()) {
    if (const auto index = simulation.due_snapshot()) {
      indices.push_back(*index);
      simulation.snapshot_written();
      EXPECT_FALSE(simulation.due_snapshot());
      simulation = Simulation(scene, {1, ""}, simulation.checkpoint());
    }
    simulation.step();
  }
  ASSERT_GE(indices.size(), 20U);
  for (std::size_t k = 0; k < indices.size(); ++k) EXPECT_EQ(indices[k], k);
}

TEST(Simulation, AFrameThatWasNotWrittenBeforeTheCheckpointIsDueAfterIt) {
  SmallScene choice;
  choice.frames = true;
  const Scene scene = small_dam_break(choice);
  const Simulation simulation(scene, {1, ""});
  const Simulation resumed(scene, {1, ""}, simulation.checkpoint());
  EXPECT_EQ(resumed.due_snapshot(), 0U);
}

TEST(Simulation, RefusesACheckpointOfAnotherScene) {
  const Simulation simulation(small_dam_break(), {1, ""});
  SmallScene other;
  other.courant = 0.2;
  try {
    const Simulation wrong(small_dam_break(other), {1, ""}, simulation.checkpoint());
    FAIL() << "a checkpoint of another scene was taken";
  } catch (const StorageError& error) {
    EXPECT_EQ(error.fault(), StorageFault::wrong_scene);
  }
}

TEST(Simulation, SaysThatTheBitsMayDifferAfterAnotherBuildAndNeverForgetsIt) {
  const Scene scene = small_dam_break();
  Checkpoint foreign = Simulation(scene, {1, ""}).checkpoint();
  EXPECT_TRUE(Simulation(scene, {1, ""}, foreign).bit_exact());
  foreign.build = "another";
  const Simulation resumed(scene, {1, ""}, foreign);
  EXPECT_FALSE(resumed.bit_exact());
  EXPECT_FALSE(Simulation(scene, {1, ""}, resumed.checkpoint()).bit_exact());
}

TEST(Simulation, FailsWithADiagnosisWhenTheSchemeIsUnstable) {
  SmallScene unstable;
  unstable.courant = 2.0;
  unstable.viscous = false;
  unstable.end_time = 2.0;
  Simulation simulation(small_dam_break(unstable), {1, ""});
  try {
    while (!simulation.finished()) simulation.step();
    FAIL() << "a Courant number of 2 without damping is far beyond the stable limit";
  } catch (const NumericalFailure& failure) {
    EXPECT_EQ(failure.diagnosis().step, simulation.solver().step_count());
    EXPECT_FALSE(failure.diagnosis().reason.empty());
    EXPECT_FALSE(failure.diagnosis().suggestion.empty());
  }
  EXPECT_THROW((void)simulation.checkpoint(), std::logic_error);
  EXPECT_THROW(simulation.step(), std::logic_error);
}

TEST(Simulation, FailsAtTheSameStepHoweverOftenItIsResumed) {
  SmallScene unstable;
  unstable.courant = 2.0;
  unstable.viscous = false;
  unstable.end_time = 2.0;
  const Scene scene = small_dam_break(unstable);
  const auto failing_step = [&](std::uint64_t resume_every) {
    Simulation simulation(scene, {1, ""});
    try {
      while (!simulation.finished()) {
        simulation.step();
        if (simulation.solver().step_count() % resume_every != 0) continue;
        simulation = Simulation(scene, {1, ""}, simulation.checkpoint());
      }
    } catch (const NumericalFailure& failure) {
      return failure.diagnosis().step;
    }
    return std::uint64_t{0};
  };
  const std::uint64_t straight = failing_step(1u << 30);
  EXPECT_GT(straight, 0U);
  EXPECT_EQ(failing_step(7), straight);
}

TEST(Simulation, AnOverflowingTankIsNoFailure) {
  // Particles that leave over the rim are counted apart from those that pass through a wall.
  Simulation simulation(small_dam_break(), {1, ""});
  while (!simulation.finished()) simulation.step();
  EXPECT_EQ(simulation.overtopped() + simulation.leaked(), simulation.solver().removed_count());
}

}  // namespace
}  // namespace sluice

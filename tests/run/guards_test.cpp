#include "engine/run/guards.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sluice {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Method paper_method() {
  Method method;
  method.spacing = 0.003;
  method.smoothing_length = 0.003;
  method.reference_density = 1000.0;
  method.sound_speed = 24.0;
  method.gravity = {0.0, -9.81};
  return method;
}

/// A step that no guard objects to.
StepFacts calm() {
  StepFacts facts;
  facts.step = 40;
  facts.time = 0.1;
  facts.time_step = 0.25 * 0.003 / 24.0;
  facts.extremes.max_speed = 2.0;
  facts.extremes.min_density_excess = -10.0;
  facts.extremes.max_density_excess = 20.0;
  facts.extremes.max_neighbours = 40;
  facts.initial_particles = 20000;
  facts.energy = 100.0;
  facts.baselines.initial_energy = 100.0;
  facts.baselines.energy_scale = 50.0;
  facts.suspect_id = [](Suspect suspect) {
    return suspect == Suspect::fastest ? 17.0 : suspect == Suspect::densest ? 18.0 : 19.0;
  };
  return facts;
}

std::optional<Diagnosis> failure(const StepFacts& facts) {
  return first_breach(failing_guards(), GuardLimits::for_method(paper_method()), facts);
}
std::optional<Diagnosis> warning(const StepFacts& facts) {
  return first_breach(warning_guards(), GuardLimits::for_method(paper_method()), facts);
}

/// The first failing guard's reason; "" when none objects.
std::string reason(const StepFacts& facts) {
  const auto diagnosis = failure(facts);
  return diagnosis ? diagnosis->reason : "";
}

TEST(Guards, LetACalmStepPass) {
  EXPECT_EQ(reason(calm()), "");
  EXPECT_FALSE(warning(calm()));
}

TEST(Guards, StopWhatIsNotFinite) {
  StepFacts facts = calm();
  facts.extremes.finite = false;
  EXPECT_NE(reason(facts).find("not finite"), std::string::npos);
}

TEST(Guards, StopANanThatNoFlagReported) {
  for (double Extremes::*member :
       {&Extremes::max_speed, &Extremes::min_density_excess, &Extremes::max_density_excess}) {
    StepFacts facts = calm();
    facts.extremes.*member = kNan;
    EXPECT_TRUE(failure(facts));
  }
  StepFacts facts = calm();
  facts.energy = kNan;
  EXPECT_TRUE(failure(facts));
  facts = calm();
  facts.time_step = kNan;
  EXPECT_TRUE(failure(facts));
}

TEST(Guards, HoldTheDensityRatioBetweenSevenAndThirteenTenths) {
  StepFacts facts = calm();
  facts.extremes.max_density_excess = 299.0;
  facts.extremes.min_density_excess = -299.0;
  EXPECT_FALSE(failure(facts));
  facts.extremes.max_density_excess = 301.0;
  EXPECT_NE(reason(facts).find("too high"), std::string::npos);
  facts = calm();
  facts.extremes.min_density_excess = -301.0;
  EXPECT_NE(reason(facts).find("too low"), std::string::npos);
}

TEST(Guards, WarnAboveThreeTenthsOfTheSoundSpeedAndStopAboveIt) {
  StepFacts facts = calm();
  facts.extremes.max_speed = 0.31 * 24.0;
  EXPECT_FALSE(failure(facts));
  EXPECT_TRUE(warning(facts));
  facts.extremes.max_speed = 24.1;
  const auto diagnosis = failure(facts);
  ASSERT_TRUE(diagnosis);
  EXPECT_DOUBLE_EQ(diagnosis->value, 24.1);
  EXPECT_DOUBLE_EQ(diagnosis->limit, 24.0);
  EXPECT_EQ(diagnosis->particle, 17.0);
  EXPECT_EQ(diagnosis->step, 40U);
  EXPECT_FALSE(diagnosis->suggestion.empty());
}

TEST(Guards, StopATimeStepBelowATwentiethOfTheSoundCrossing) {
  StepFacts facts = calm();
  facts.time_step = 0.049 * 0.003 / 24.0;
  EXPECT_NE(reason(facts).find("collapsed"), std::string::npos);
  facts.time_step = 0.051 * 0.003 / 24.0;
  EXPECT_FALSE(failure(facts));
}

TEST(Guards, DoNotBlameASmallCourantNumberForASmallStep) {
  Method method = paper_method();
  method.courant = 0.04;
  StepFacts facts = calm();
  facts.time_step = 0.04 * 0.003 / 24.0;
  EXPECT_FALSE(first_breach(failing_guards(), GuardLimits::for_method(method), facts));
}

TEST(Guards, HaveNoOpinionOnTheStepBeforeTheFirst) {
  StepFacts facts = calm();
  facts.step = 0;
  facts.time_step = 0.0;
  EXPECT_FALSE(failure(facts));
}

TEST(Guards, WarnAtOneLeakInAThousandAndStopAtOneInAHundred) {
  StepFacts facts = calm();
  facts.leaked = 20;
  EXPECT_FALSE(warning(facts));
  facts.leaked = 21;
  EXPECT_TRUE(warning(facts));
  facts.leaked = 200;
  EXPECT_FALSE(failure(facts));
  facts.leaked = 201;
  EXPECT_TRUE(failure(facts));
}

TEST(Guards, StopAnEnergyThatGrewByMoreThanFivePercentOfItsScale) {
  StepFacts facts = calm();
  facts.energy = 102.4;
  EXPECT_FALSE(failure(facts));
  facts.energy = 102.6;
  EXPECT_NE(reason(facts).find("energy"), std::string::npos);
  facts.energy.reset();
  EXPECT_FALSE(failure(facts));
}

TEST(Guards, StopClumpsButAllowAWiderSupportItsNeighbours) {
  StepFacts facts = calm();
  facts.extremes.max_neighbours = 201;
  EXPECT_TRUE(failure(facts));
  Method wide = paper_method();
  wide.smoothing_length = 2.0 * wide.spacing;
  EXPECT_FALSE(first_breach(failing_guards(), GuardLimits::for_method(wide), facts));
}

TEST(EnergyScale, OfAColumnIsItsPotentialEnergyAboveItsFoot) {
  SolverState state;
  // Two particles 1 m apart, the lower 5 m above y = 0: lifted by 1 m together.
  state.particles.x = {0.0, 0.0};
  state.particles.y = {5.0, 6.0};
  Energy energy;
  const Method method = paper_method();
  energy.potential = method.particle_mass() * 9.81 * 11.0;
  const GuardBaselines base = initial_baselines(method, state, energy);
  EXPECT_NEAR(base.energy_scale, method.particle_mass() * 9.81 * 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(base.initial_energy, energy.total());
  EXPECT_DOUBLE_EQ(base.initial_mass, 2.0 * method.particle_mass());
}

TEST(EnergyScale, OfAFluidAtRestWithoutGravityIsNotZero) {
  SolverState state;
  state.particles.x = {0.0};
  state.particles.y = {0.0};
  Method method = paper_method();
  method.gravity = Vec::Zero();
  const GuardBaselines base = initial_baselines(method, state, Energy{});
  EXPECT_DOUBLE_EQ(base.energy_scale, 0.5 * method.particle_mass() * 0.24 * 0.24);
}

TEST(Diagnosis, NamesTheParticleOfTheDensityThatIsWrong) {
  StepFacts facts = calm();
  facts.extremes.max_density_excess = 400.0;
  EXPECT_EQ(failure(facts)->particle, 18.0);
  facts = calm();
  facts.extremes.min_density_excess = -400.0;
  EXPECT_EQ(failure(facts)->particle, 19.0);
}

TEST(Diagnosis, TellsStepTimeParticleValueLimitAndWhatToDo) {
  StepFacts facts = calm();
  facts.extremes.max_speed = 30.0;
  const std::string text = NumericalFailure(*failure(facts)).what();
  for (const char* part : {"step 40", "t = 0.1 s", "particle 17", "30", "24", "courant"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
}

}  // namespace
}  // namespace sluice

#include "engine/run/guards.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/run/advice.hpp"

namespace sluice {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Method paper_method() {
  Method method;
  method.spacing = 0.003;
  method.smoothing_length = 0.003;
  method.reference_density = 1000.0;
  method.sound_speed = 24.0;
  method.gravity = Vec2(0.0, -9.81);
  return method;
}

/// A step that no guard objects to.
StepFacts calm() {
  StepFacts facts;
  facts.step = 40;
  facts.time = 0.1;
  facts.extremes.max_speed = 2.0;
  facts.extremes.min_density_excess = -10.0;
  facts.extremes.max_density_excess = 20.0;
  facts.extremes.max_neighbours = 40;
  facts.initial_particles = 20000;
  facts.particles = 20000;
  facts.energy = Energy{40.0, 60.0, 0.0};
  facts.baselines.initial_mass = 180.0;
  facts.baselines.initial_energy = 100.0;
  facts.baselines.energy_scale = 50.0;
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

void set(StepFacts& facts, RemovalCause cause, std::size_t count) {
  facts.removed[static_cast<std::size_t>(cause)] = count;
}

TEST(Guards, StopAnEnergyThatIsNoNumber) {
  for (double Energy::*part : {&Energy::kinetic, &Energy::potential, &Energy::internal}) {
    StepFacts facts = calm();
    (*facts.energy).*part = kNan;
    EXPECT_TRUE(failure(facts));
  }
}

TEST(Guards, LetAHalfPercentBeExcludedAndStopAtMore) {
  StepFacts facts = calm();
  set(facts, RemovalCause::too_dense, 60);
  set(facts, RemovalCause::too_fast, 40);
  EXPECT_FALSE(failure(facts));
  set(facts, RemovalCause::not_finite, 1);
  const auto diagnosis = failure(facts);
  ASSERT_TRUE(diagnosis);
  EXPECT_EQ(diagnosis->value, 101.0);
  EXPECT_EQ(diagnosis->limit, 100.0);
  EXPECT_NE(diagnosis->reason.find("60 too dense"), std::string::npos) << diagnosis->reason;
  EXPECT_NE(diagnosis->reason.find("40 too fast"), std::string::npos) << diagnosis->reason;
}

TEST(Guards, StopMoreThanOneInAThousandExcludedWhileSoundCrossesTheFluid) {
  StepFacts facts = calm();
  set(facts, RemovalCause::too_thin, 21);
  facts.excluded_at_once = 20;
  EXPECT_FALSE(failure(facts));
  facts.excluded_at_once = 21;
  EXPECT_TRUE(failure(facts));
  // 180 kg/m of 1000 kg/m^3 are 0.18 m^2.
  const GuardLimits limits = GuardLimits::for_method(paper_method());
  EXPECT_NEAR(limits.crossing_time(facts.baselines), std::sqrt(0.18) / 24.0, 1e-15);
}

TEST(Guards, DoNotEndASmallRunForAHandful) {
  EXPECT_EQ(GuardLimits::most_of(0.005, 20000.0), 100.0);
  EXPECT_EQ(GuardLimits::most_of(0.001, 400.0), 8.0);
  EXPECT_EQ(GuardLimits::most_of(0.005, 40.0), 4.0);
  EXPECT_LT(GuardLimits::most_of(0.005, 1.0), 1.0) << "its only particle";
}

TEST(Guards, StopAFluidWhoseMeanSpeedIsHalfOfTheSoundSpeed) {
  StepFacts facts = calm();
  const double mass = 20000.0 * 1000.0 * 0.003 * 0.003;
  facts.baselines.initial_energy = 0.5 * mass * 144.0;
  facts.energy = Energy{0.5 * mass * 11.9 * 11.9, 0.0, 0.0};
  EXPECT_FALSE(failure(facts));
  facts.energy = Energy{0.5 * mass * 12.1 * 12.1, 0.0, 0.0};
  EXPECT_NE(reason(facts).find("mean speed"), std::string::npos);
}

TEST(Guards, StopAFluidWhoseMeanDensityIsHalfOfWhatOneMayBeOff) {
  StepFacts facts = calm();
  const double mass = 20000.0 * 1000.0 * 0.003 * 0.003;
  const auto internal = [&](double s) { return 0.5 * mass * 24.0 * 24.0 * s * s; };
  facts.baselines.initial_energy = internal(0.15);
  facts.energy = Energy{0.0, 0.0, internal(0.149)};
  EXPECT_FALSE(failure(facts));
  facts.energy = Energy{0.0, 0.0, internal(0.151)};
  EXPECT_NE(reason(facts).find("mean density"), std::string::npos);
}

TEST(Guards, WarnAboveThreeTenthsOfTheSoundSpeed) {
  StepFacts facts = calm();
  facts.extremes.max_speed = 0.29 * 24.0;
  EXPECT_FALSE(warning(facts));
  facts.extremes.max_speed = 0.31 * 24.0;
  EXPECT_FALSE(failure(facts));
  EXPECT_TRUE(warning(facts));
}

TEST(Guards, WarnOfMoreThanOneExcludedInTenThousand) {
  StepFacts facts = calm();
  set(facts, RemovalCause::too_dense, 2);
  EXPECT_FALSE(warning(facts));
  set(facts, RemovalCause::too_dense, 3);
  EXPECT_TRUE(warning(facts));
}

TEST(Guards, WarnAtOneLeakInAThousandAndStopAtOneInAHundred) {
  StepFacts facts = calm();
  set(facts, RemovalCause::leaked, 20);
  EXPECT_FALSE(warning(facts));
  set(facts, RemovalCause::leaked, 21);
  EXPECT_TRUE(warning(facts));
  set(facts, RemovalCause::leaked, 200);
  EXPECT_FALSE(failure(facts));
  set(facts, RemovalCause::leaked, 201);
  EXPECT_TRUE(failure(facts));
}

TEST(Guards, StopAnEnergyThatGrewByMoreThanFivePercentOfItsScale) {
  StepFacts facts = calm();
  facts.energy->potential = 62.4;
  EXPECT_FALSE(failure(facts));
  facts.energy->potential = 62.6;
  EXPECT_NE(reason(facts).find("energy"), std::string::npos);
  facts.energy.reset();
  EXPECT_FALSE(failure(facts));
}

TEST(Guards, CountWhatLeftWithTheEnergyOfTheFluid) {
  StepFacts facts = calm();
  // Particles at a negative height left: the others have more than all had.
  facts.energy->potential = 160.0;
  facts.energy_that_left = -100.0;
  EXPECT_FALSE(failure(facts));
  facts.energy_that_left = 3.0;
  facts.energy->potential = 60.0;
  EXPECT_NE(reason(facts).find("energy"), std::string::npos);
}

TEST(EnergyThatLeft, IsAllOfALeakButThePotentialEnergyAloneOfAnExclusion) {
  const Method method = paper_method();
  RemovedParticle removed;
  removed.position.y() = -2.0;
  removed.velocity.x() = 3.0;
  removed.cause = RemovalCause::leaked;
  const double mass = method.particle_mass();
  EXPECT_DOUBLE_EQ(energy_that_left(method, removed), mass * (4.5 - 2.0 * 9.81));
  removed.cause = RemovalCause::too_fast;
  EXPECT_DOUBLE_EQ(energy_that_left(method, removed), -mass * 2.0 * 9.81);
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
  // Two particles 1 m apart, the lower 5 m above y = 0: lifted by 1 m together, and each by half a
  // spacing above the foot.
  state.particles.position[0] = {0.0, 0.0};
  state.particles.position[1] = {5.0, 6.0};
  Energy energy;
  const Method method = paper_method();
  energy.potential = method.particle_mass() * 9.81 * 11.0;
  const GuardBaselines base = initial_baselines(method, state, energy);
  EXPECT_NEAR(base.energy_scale, method.particle_mass() * 9.81 * (1.0 + method.spacing), 1e-12);
  EXPECT_DOUBLE_EQ(base.initial_energy, energy.total());
  EXPECT_DOUBLE_EQ(base.initial_mass, 2.0 * method.particle_mass());
}

TEST(EnergyScale, OfAFluidAtRestWithoutGravityIsNotZero) {
  SolverState state;
  state.particles.position[0] = {0.0};
  state.particles.position[1] = {0.0};
  Method method = paper_method();
  method.gravity = Vec2::Zero();
  const GuardBaselines base = initial_baselines(method, state, Energy{});
  EXPECT_DOUBLE_EQ(base.energy_scale, 0.5 * method.particle_mass() * 0.24 * 0.24);
}

TEST(Diagnosis, TellsStepTimeValueLimitAndWhatToDo) {
  StepFacts facts = calm();
  set(facts, RemovalCause::too_fast, 300);
  const std::string text = NumericalFailure(*failure(facts)).what();
  for (const char* part : {"step 40", "t = 0.1 s", "300", "100", "too fast", "sound_speed"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
}

bool advises(const std::string& advice, const char* what) {
  return advice.find(what) != std::string::npos;
}

TEST(Advice, IsOfWhatTheSceneLacks) {
  Method bare = paper_method();
  bare.courant = 0.1;
  EXPECT_TRUE(advises(advice_to_steady(bare), "kick_drift_kick"));
  EXPECT_TRUE(advises(advice_to_steady(bare), "artificial_viscosity"));
  EXPECT_TRUE(advises(advice_to_steady(bare), "density_diffusion"));
  EXPECT_FALSE(advises(advice_to_conserve(bare), "molteni_colagrossi"));
  EXPECT_TRUE(advises(advice_to_hold(bare), "clamped"));

  Method full = bare;
  full.kernel = KernelKind::wendland_c2;
  full.smoothing_length = 1.5 * full.spacing;
  full.integrator = Integrator::kick_drift_kick;
  full.viscosity = ArtificialViscosity{0.02, 0.01, 0.5};
  full.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
  full.wall_pressure = WallPressure::clamped;
  full.courant = 1.0;
  for (const char* had : {"kick_drift_kick", "viscosity", "diffusion", "courant", "clamped"}) {
    EXPECT_FALSE(advises(advice_to_steady(full), had)) << had;
    EXPECT_FALSE(advises(advice_to_conserve(full), had)) << had;
    EXPECT_FALSE(advises(advice_to_hold(full), had)) << had;
  }
  full.diffusion->kind = DiffusionKind::molteni_colagrossi;
  EXPECT_TRUE(advises(advice_to_conserve(full), "molteni_colagrossi"));
  full.courant = 3.0;
  EXPECT_TRUE(advises(advice_to_steady(full), "lower numerics.courant from 3 to "));
}

}  // namespace
}  // namespace sluice

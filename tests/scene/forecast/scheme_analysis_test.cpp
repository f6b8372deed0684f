// Analyses that are kept answer as new ones do.

#include "engine/scene/forecast/scheme_analysis.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace sluice {
namespace {

Method paper_method() {
  Method m;
  m.spacing = 0.01;
  m.smoothing_length = 0.01;
  m.sound_speed = 20.0;
  m.reference_density = 1000.0;
  m.viscosity = ArtificialViscosity{};
  m.diffusion = DensityDiffusion{};
  return m;
}

/// Schemes that differ from the first in one of the numbers that the analysis depends on.
std::vector<Method> schemes() {
  std::vector<Method> all(9, paper_method());
  all[1].integrator = Integrator::kick_drift_kick;
  all[2].kernel = KernelKind::wendland_c2;
  all[3].smoothing_length = 0.012;
  all[4].viscosity->alpha = 0.1;
  all[5].viscosity->epsilon = 0.1;
  all[6].diffusion->delta = 0.2;
  all[7].diffusion.reset();
  all[8].laminar_viscosity = LaminarViscosity{.nu = 0.01};
  return all;
}

void expect_as_new(const Method& m) {
  const auto kept = analyse_scheme(m);
  const LatticeStability fresh(method_as<2>(m), Surface::free);
  for (const double courant : {0.1, 0.9, 0.1}) {
    EXPECT_EQ(kept->spectral_radius(courant), fresh.spectral_radius(courant));
  }
  const CourantLimits limits = courant_limits(method_as<2>(m), Surface::free);
  EXPECT_EQ(kept->limits().scheme, limits.scheme);
  EXPECT_EQ(kept->limits().sound, limits.sound);
  EXPECT_EQ(kept->limits().viscosity, limits.viscosity);
  EXPECT_EQ(kept->limits().diffusion, limits.diffusion);
}

TEST(SchemeAnalysis, ThatIsKeptAnswersAsANewOneWhicheverWasAskedForBefore) {
  for (int round = 0; round < 2; ++round) {
    for (const Method& m : schemes()) expect_as_new(m);
  }
}

TEST(SchemeAnalysis, IsSharedByMethodsOfOneSchemeWhateverTheirScale) {
  Method other = paper_method();
  other.spacing = other.smoothing_length = 0.5;
  other.sound_speed = 3.0;
  other.courant = 0.1;
  EXPECT_EQ(analyse_scheme(paper_method()), analyse_scheme(other));
}

TEST(SchemeAnalysis, OfTooManySchemesIsForgottenAndMadeAgain) {
  const auto first = analyse_scheme(paper_method());
  Method m = paper_method();
  for (int n = 1; n <= 40; ++n) {
    m.viscosity->alpha = 0.001 * n;
    (void)analyse_scheme(m);
  }
  EXPECT_NE(analyse_scheme(paper_method()), first);
  expect_as_new(paper_method());
}

TEST(SchemeAnalysisThreads, GetTheSameAnswers) {
  const double expected =
      LatticeStability(method_as<2>(paper_method()), Surface::free).spectral_radius(0.25);
  std::vector<std::thread> threads;
  for (int n = 0; n < 4; ++n) {
    threads.emplace_back([&] {
      for (const Method& m : schemes()) (void)analyse_scheme(m)->spectral_radius(0.3);
      EXPECT_EQ(analyse_scheme(paper_method())->spectral_radius(0.25), expected);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace sluice

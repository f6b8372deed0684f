// The limits of the linear analysis against particles that are stepped: noise on a lattice dies out
// below a limit and grows above it, as fast as the analysis says.

#include <gtest/gtest.h>

#include "engine/sph/stability/von_neumann.hpp"
#include "tests/space/dimensions.hpp"
#include "tests/sph/stability/bare_method.hpp"
#include "tests/sph/stability/linear_lattice.hpp"

namespace sluice {
namespace {

/// Waves of a length of eight spacings over a whole number: all are among those of the analysis.
constexpr int kSize = 8;
constexpr int kLayers = 6;
constexpr int kSteps = 400;

template <int Dim>
std::vector<MethodN<Dim>> schemes() {
  MethodN<Dim> paper = damped_method<Dim>(Integrator::modified_leap_frog);
  MethodN<Dim> recommended = damped_method<Dim>(Integrator::kick_drift_kick);
  recommended.kernel = KernelKind::wendland_c2;
  recommended.smoothing_length = 0.15;
  return {paper, recommended};
}

template <int Dim>
void expect_growth_of(const MethodN<Dim>& method, Surface surface, double share_of_limit) {
  const LatticeStabilityN<Dim> analysis(method, surface);
  const double courant = share_of_limit * analysis.courant_limit();
  LinearLattice<Dim> lattice(method, kSize, surface == Surface::free ? kLayers : 0);
  const double expected = analysis.spectral_radius(courant) - 1.0;
  const double seen = lattice.growth(courant, kSteps) - 1.0;
  if (share_of_limit < 1.0) {
    EXPECT_LE(expected, LatticeStability::kTolerance);
    EXPECT_LT(seen, 1e-3) << "noise dies out";
    return;
  }
  EXPECT_GT(expected, 0.01);
  // The fastest wave of the analysis may lie between those of so few particles.
  EXPECT_LT(seen, 1.01 * expected);
  EXPECT_GT(seen, 0.6 * expected);
}

template <class Dimension>
class LatticeGrowth : public ::testing::Test {};
TYPED_TEST_SUITE(LatticeGrowth, testing::Dimensions);

TYPED_TEST(LatticeGrowth, IsThatOfTheAnalysisInTheBulk) {
  for (const auto& method : schemes<TypeParam::value>()) {
    expect_growth_of(method, Surface::none, 0.97);
    expect_growth_of(method, Surface::none, 1.1);
  }
}

TYPED_TEST(LatticeGrowth, IsThatOfTheAnalysisInASheetWithTwoFreeSurfaces) {
  for (const auto& method : schemes<TypeParam::value>()) {
    expect_growth_of(method, Surface::free, 0.97);
    expect_growth_of(method, Surface::free, 1.1);
  }
}

}  // namespace
}  // namespace sluice

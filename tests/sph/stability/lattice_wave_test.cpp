// Single waves of the linear analysis against what the continuum and the lattice's symmetry say.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/space/lattice.hpp"
#include "engine/sph/stability/brillouin_zone.hpp"
#include "engine/sph/stability/von_neumann.hpp"
#include "tests/space/dimensions.hpp"
#include "tests/sph/stability/bare_method.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

template <int Dim>
VecN<Dim> along(int axis, double k) {
  return k * VecN<Dim>::Unit(axis);
}

template <class Dimension>
class LatticeWaves : public ::testing::Test {};
TYPED_TEST_SUITE(LatticeWaves, testing::Dimensions);

TYPED_TEST(LatticeWaves, ThatAreLongTravelAtTheSpeedOfSoundAndAreDampedAsInTheContinuum) {
  // Density diffuses with delta c h. Eq. 8 between all pairs is a viscosity of alpha c h/(2 (d +
  // 2)), alpha c h/8 in the plane and /10 in space (Monaghan 2005), which damps twice more along
  // the wave; half of the pairs count.
  constexpr int kD = TypeParam::value;
  using Tensor = Eigen::Matrix<double, kD, kD>;
  MethodN<kD> m = damped_method<kD>(Integrator::kick_drift_kick);
  m.viscosity->epsilon = 0.0;
  const double delta = m.diffusion->delta;
  const VecN<kD> k = 0.01 * VecN<kD>::LinSpaced(1.0, 2.0);
  const double k_sq = k.squaredNorm();
  for (const double h : {2.0, 3.0}) {  // wide, so that sums are integrals
    m.smoothing_length = h * m.spacing;
    const LatticeStabilityN<kD> analysis(m, Surface::none);
    const LatticeWaveN<kD> wave = analysis.wave(k);
    EXPECT_LT((wave.gradient - k).norm(), 0.005 * k.norm());
    EXPECT_NEAR(wave.diffusion, delta * k_sq, 0.005 * delta * k_sq);
    const double shear = 0.5 * m.viscosity->alpha / (2.0 * (kD + 2));
    const Tensor damping = shear * (k_sq * Tensor::Identity() + 2.0 * k * k.transpose());
    EXPECT_TRUE(wave.damping.isApprox(damping, 0.01));
  }
  m.viscosity.reset();
  m.laminar_viscosity = LaminarViscosity{0.01};
  const double nu = 0.01 / (m.sound_speed * m.smoothing_length);
  const Tensor damping = LatticeStabilityN<kD>(m, Surface::none).wave(k).damping;
  EXPECT_TRUE(damping.isApprox(nu * k_sq * Tensor::Identity(), 0.005));
}

TYPED_TEST(LatticeWaves, AlongAnAxisMoveParticlesAlongItAlone) {
  constexpr int kD = TypeParam::value;
  const LatticeStabilityN<kD> analysis(damped_method<kD>(Integrator::kick_drift_kick),
                                       Surface::none);
  for (const double k : {0.1, 1.0, 2.0, std::numbers::pi}) {
    const LatticeWaveN<kD> first = analysis.wave(along<kD>(0, k));
    EXPECT_LT((first.gradient - along<kD>(0, first.gradient[0])).norm(), 1e-14);
    EXPECT_TRUE(first.damping.isDiagonal(1e-14));
    for (int axis = 1; axis < kD; ++axis) {
      const LatticeWaveN<kD> other = analysis.wave(along<kD>(axis, k));
      EXPECT_NEAR(other.gradient[axis], first.gradient[0], 1e-14);
      EXPECT_NEAR(other.diffusion, first.diffusion, 1e-14);
      EXPECT_NEAR(other.damping(axis, axis), first.damping(0, 0), 1e-14);
      EXPECT_NEAR(other.damping(0, 0), first.damping(axis, axis), 1e-14);
    }
  }
}

/// Sorted by imaginary and real part.
std::vector<double> sorted_parts(const std::vector<std::complex<double>>& rates) {
  std::vector<double> parts;
  for (const auto& rate : rates) parts.push_back(rate.real());
  std::ranges::sort(parts);
  for (const auto& rate : rates) parts.push_back(rate.imag());
  std::ranges::sort(parts.begin() + static_cast<std::ptrdiff_t>(rates.size()), parts.end());
  return parts;
}

TYPED_TEST(LatticeWaves, LeftOutBySymmetryHaveTheRatesOfTheirImages) {
  constexpr int kD = TypeParam::value;
  MethodN<kD> m = damped_method<kD>(Integrator::modified_leap_frog);
  m.kernel = KernelKind::wendland_c2;
  m.smoothing_length = 0.15;
  const LatticeStabilityN<kD> analysis(m, Surface::none);
  const double step = std::numbers::pi * m.smoothing_length / m.spacing / 4;
  for_each_cell<kD>(shifted<kD>({}, -4), shifted<kD>({}, 4), [&](const CellN<kD>& cell) {
    CellN<kD> image = cell;
    for (std::int64_t& number : image) number = std::abs(number);
    std::ranges::sort(image, std::ranges::greater());
    const auto rates = sorted_parts(analysis.wave(step * as_vector<kD>(cell)).rates);
    const auto expected = sorted_parts(analysis.wave(step * as_vector<kD>(image)).rates);
    ASSERT_EQ(rates.size(), 2U * (kD + 1));
    for (std::size_t n = 0; n < rates.size(); ++n) EXPECT_NEAR(rates[n], expected[n], 1e-7);
  });
}

TYPED_TEST(LatticeWaves, OfTheZoneHaveAnImageEachAmongThoseLookedAt) {
  constexpr int kD = TypeParam::value;
  std::vector<CellN<kD>> looked_at;
  for_each_wave<kD>(3, [&](const CellN<kD>& cell) { looked_at.push_back(cell); });
  EXPECT_EQ(looked_at.size(), kD == 2 ? 10U : 20U);  // of 4 numbers d with repetition
  for_each_cell<kD>(shifted<kD>({}, -3), shifted<kD>({}, 3), [&](CellN<kD> cell) {
    for (std::int64_t& number : cell) number = std::abs(number);
    std::ranges::sort(cell, std::ranges::greater());
    EXPECT_EQ(std::ranges::count(looked_at, cell), 1);
  });
}

TEST(LatticeWavesInSpace, AlongTheFloorAreThoseOfAPlaneWhoseKernelIsSummedOverTheThirdAxis) {
  // The truncated Gaussian is a product of one of each axis: rows along z add to one, but for what
  // the cut takes.
  const LatticeStabilityN<3> space(damped_method<3>(Integrator::kick_drift_kick), Surface::none);
  const LatticeStabilityN<2> plane(damped_method<2>(Integrator::kick_drift_kick), Surface::none);
  for (const auto& [x, y] : {std::pair(0.3, 0.1), std::pair(2.0, 0.0), std::pair(3.0, 2.5)}) {
    const LatticeWaveN<3> in_space = space.wave({x, y, 0.0});
    const LatticeWaveN<2> in_plane = plane.wave({x, y});
    EXPECT_LT((in_space.gradient.head<2>() - in_plane.gradient).norm(), 0.005);
    EXPECT_NEAR(in_space.diffusion, in_plane.diffusion, 0.005 * in_plane.diffusion);
  }
}

}  // namespace
}  // namespace sluice

// What particle shifting takes for a surface, on lattices that end at a flat one.

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/space/lattice.hpp"
#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/terms/particle_shifting.hpp"
#include "tests/space/dimensions.hpp"

namespace sluice {
namespace {

constexpr int kInside = 5;  // layers above a particle, no fewer than the kernels here reach

/// Trace of sum_j V_j slope X_ij X_ij of a particle with so many layers of others above it and a
/// lattice without end below; h in spacings.
template <int Dim>
double trace_below(int layers_above, KernelKind kernel, double h) {
  CellN<Dim> farthest;
  farthest.fill(kInside);
  CellN<Dim> opposite;
  opposite.fill(-kInside);
  farthest[kUpAxis] = layers_above;
  double trace = 0.0;
  for_each_cell<Dim>(opposite, farthest, [&](const CellN<Dim>& cell) {
    const double r_sq = as_vector<Dim>(cell).squaredNorm() / (h * h);
    if (r_sq == 0.0) return;
    trace += cell_measure<Dim>(1.0 / h) * kernel_slope<Dim>(kernel, r_sq) * r_sq;
  });
  return trace;
}

template <int Dim>
double share_shifted(double trace) {
  constexpr double kSurface = ParticleShifting::kSurfaceTrace<Dim>;
  return std::clamp((trace - kSurface) / (ParticleShifting::kInsideTrace<Dim> - kSurface), 0.0,
                    1.0);
}

template <class Dimension>
class ShiftingBounds : public ::testing::Test {};
TYPED_TEST_SUITE(ShiftingBounds, testing::Dimensions);

TYPED_TEST(ShiftingBounds, LeaveTheFirstRowAloneAndTakeHalfOfTheSecondWithTheWideKernel) {
  constexpr int kD = TypeParam::value;
  const auto share = [](int layers_above) {
    return share_shifted<kD>(trace_below<kD>(layers_above, KernelKind::wendland_c2, 1.5));
  };
  EXPECT_EQ(share(0), 0.0);
  EXPECT_NEAR(share(1), 0.5, 0.05);
  EXPECT_EQ(share(2), 1.0);
  EXPECT_EQ(share(kInside), 1.0);
}

TYPED_TEST(ShiftingBounds, LeaveTheFirstRowAloneAndTakeMostOfTheSecondWithNarrowKernels) {
  constexpr int kD = TypeParam::value;
  for (const auto& [kernel, h] :
       {std::pair(KernelKind::wendland_c2, 1.2), std::pair(KernelKind::truncated_gaussian, 1.0)}) {
    EXPECT_EQ(share_shifted<kD>(trace_below<kD>(0, kernel, h)), 0.0);
    EXPECT_GT(share_shifted<kD>(trace_below<kD>(1, kernel, h)), 0.8);
    EXPECT_EQ(share_shifted<kD>(trace_below<kD>(2, kernel, h)), 1.0);
  }
}

TYPED_TEST(ShiftingBounds, AreFarFromTheFirstRow) {
  // A surface that is not flat has more or fewer neighbours.
  constexpr int kD = TypeParam::value;
  for (const KernelKind kernel : {KernelKind::wendland_c2, KernelKind::truncated_gaussian}) {
    for (const double h : {1.0, 1.2, 1.5}) {
      EXPECT_LT(trace_below<kD>(0, kernel, h), ParticleShifting::kSurfaceTrace<kD> - 0.4) << h;
    }
  }
}

TYPED_TEST(ShiftingBounds, AreMetInsideByEveryKernelThatReachesTwoSpacings) {
  constexpr int kD = TypeParam::value;
  for (int n = 0; n <= 10; ++n) {
    const double h = 1.0 + 0.05 * n;
    for (const KernelKind kernel : {KernelKind::wendland_c2, KernelKind::truncated_gaussian}) {
      EXPECT_EQ(share_shifted<kD>(trace_below<kD>(kInside, kernel, h)), 1.0) << h;
    }
  }
}

TEST(ShiftingBoundsInThePlane, AreThoseThatRunsWereMadeWith) {
  EXPECT_EQ(ParticleShifting::kSurfaceTrace<2>, 1.75);
  EXPECT_EQ(ParticleShifting::kInsideTrace<2>, 1.9);
}

TEST(ShiftingBoundsInSpace, AreAsFarFromTheTraceInsideInSpaceBecauseTheSecondRowLacksAsMuch) {
  const auto lacking = []<int Dim>(std::integral_constant<int, Dim>) {
    return SpaceTraits<Dim>::trace_inside - trace_below<Dim>(1, KernelKind::wendland_c2, 1.5);
  };
  EXPECT_NEAR(lacking(std::integral_constant<int, 2>()), 0.179, 0.001);
  EXPECT_NEAR(lacking(std::integral_constant<int, 3>()), 0.172, 0.001);
}

}  // namespace
}  // namespace sluice

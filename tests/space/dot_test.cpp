// The dot product of the pair sums, on every SIMD target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/space/dot_test.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "engine/space/dot-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// a . b of one vector in each lane; whether the target's multiply-add rounds once.
template <std::size_t Dim>
bool dot_of(const double* a, const double* b, double* result) {
  const hn::CappedTag<double, 1> d;
  std::array<hn::Vec<decltype(d)>, Dim> one, other;
  for (std::size_t k = 0; k < Dim; ++k) {
    one[k] = hn::Set(d, a[k]);
    other[k] = hn::Set(d, b[k]);
  }
  hn::StoreU(dot(one, other), d, result);
  return HWY_NATIVE_FMA;
}

bool dot_in_plane(const double* a, const double* b, double* result) {
  return dot_of<2>(a, b, result);
}
bool dot_in_space(const double* a, const double* b, double* result) {
  return dot_of<3>(a, b, result);
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/sph/loops/simd_target.hpp"

namespace sluice {

HWY_EXPORT(dot_in_plane);
HWY_EXPORT(dot_in_space);

namespace {

// Of such numbers every order of the sum has other last bits.
constexpr double kA[] = {0.1, 1.0 / 3.0, 0.7};
constexpr double kB[] = {1.0 / 7.0, 0.3, 1.0 / 9.0};

double multiply_add(bool fused, double a, double b, double c) {
  return fused ? std::fma(a, b, c) : a * b + c;
}

TEST(Dot, FoldsFromTheLastAxisInThePlane) {
  for (const std::string& target : simd_targets()) {
    double result = 0.0;
    bool fused = false;
    with_simd_target(target, [&] { fused = HWY_DYNAMIC_DISPATCH(dot_in_plane)(kA, kB, &result); });
    EXPECT_EQ(result, multiply_add(fused, kA[0], kB[0], kA[1] * kB[1])) << target;
  }
}

TEST(Dot, FoldsFromTheLastAxisInSpace) {
  for (const std::string& target : simd_targets()) {
    double result = 0.0;
    bool fused = false;
    with_simd_target(target, [&] { fused = HWY_DYNAMIC_DISPATCH(dot_in_space)(kA, kB, &result); });
    const double of_y_and_z = multiply_add(fused, kA[1], kB[1], kA[2] * kB[2]);
    EXPECT_EQ(result, multiply_add(fused, kA[0], kB[0], of_y_and_z)) << target;
  }
}

}  // namespace
}  // namespace sluice
#endif

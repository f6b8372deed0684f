// The vector forms of the kernels, on every SIMD target, against the scalar ones.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/sph/kernel/kernel_shapes_test.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <cstddef>

#include "engine/sph/kernel/kernel-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// `count` values of R^2, a multiple of 16, to values and slopes.
template <class Shape, typename T>
void evaluate(const T* r_sq, std::size_t count, T* value, T* slope) {
  const hn::CappedTag<T, 16> d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const auto q = hn::LoadU(d, r_sq + k);
    hn::StoreU(Shape::value(d, q), d, value + k);
    hn::StoreU(Shape::slope(d, q), d, slope + k);
  }
}

void gaussian_float(const float* q, std::size_t n, float* value, float* slope) {
  evaluate<GaussianShape>(q, n, value, slope);
}
void gaussian_double(const double* q, std::size_t n, double* value, double* slope) {
  evaluate<GaussianShape>(q, n, value, slope);
}
void wendland_float(const float* q, std::size_t n, float* value, float* slope) {
  evaluate<WendlandShape>(q, n, value, slope);
}
void wendland_double(const double* q, std::size_t n, double* value, double* slope) {
  evaluate<WendlandShape>(q, n, value, slope);
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"

namespace sluice {

HWY_EXPORT(gaussian_float);
HWY_EXPORT(gaussian_double);
HWY_EXPORT(wendland_float);
HWY_EXPORT(wendland_double);

namespace {

/// R^2 from 0 to 16: on a grid, and on both sides of both cut-offs.
template <typename T>
std::vector<T> squared_distances() {
  std::vector<T> q;
  for (int k = 0; k <= 32000; ++k) q.push_back(static_cast<T>(16.0 * k / 32000.0));
  for (const T edge : {T{4}, T{9}}) {
    q.insert(q.end(), {std::nextafter(edge, T{0}), edge, std::nextafter(edge, T{100})});
  }
  for (const double far : {1e2, 1e4, 1e16, 1e30}) q.push_back(static_cast<T>(far));
  while (q.size() % 16 != 0) q.push_back(T{0});
  return q;
}

template <class Kernel, typename T, class Evaluate>
void expect_shape_of(const Evaluate& evaluate, double tolerance) {
  const std::vector<T> q = squared_distances<T>();
  for (const std::string& target : simd_targets()) {
    std::vector<T> value(q.size());
    std::vector<T> slope(q.size());
    with_simd_target(target, [&] { evaluate(q.data(), q.size(), value.data(), slope.data()); });
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto r_sq = static_cast<double>(q[k]);
      const auto v = static_cast<double>(value[k]);
      const auto s = static_cast<double>(slope[k]);
      ASSERT_NEAR(v, Kernel::value(r_sq) / Kernel::value_scale, tolerance) << target << ' ' << r_sq;
      ASSERT_NEAR(s, Kernel::slope(r_sq) / Kernel::slope_scale, tolerance) << target << ' ' << r_sq;
      if (r_sq >= Kernel::support * Kernel::support) {
        ASSERT_EQ(v, 0.0) << target << ": beyond the support at R^2 = " << r_sq;
        ASSERT_EQ(s, 0.0) << target << ": beyond the support at R^2 = " << r_sq;
      }
    }
  }
}

// Tolerances: what ExpEighth states, and for Wendland a few units in the last place of 1.
TEST(KernelShapes, TheGaussianInSinglePrecisionIsTheScalarOneToNineTenMillionths) {
  expect_shape_of<TruncatedGaussianN<2>, float>(
      [](auto... a) {
        HWY_DYNAMIC_DISPATCH(gaussian_float)
        (a...);
      },
      9e-7);
}

TEST(KernelShapes, TheGaussianInDoublePrecisionIsTheScalarOneToRounding) {
  expect_shape_of<TruncatedGaussianN<2>, double>(
      [](auto... a) {
        HWY_DYNAMIC_DISPATCH(gaussian_double)
        (a...);
      },
      3e-14);
}

TEST(KernelShapes, WendlandInSinglePrecisionIsTheScalarOneToRounding) {
  expect_shape_of<WendlandC2N<2>, float>(
      [](auto... a) {
        HWY_DYNAMIC_DISPATCH(wendland_float)
        (a...);
      },
      1e-6);
}

TEST(KernelShapes, WendlandInDoublePrecisionIsTheScalarOneToRounding) {
  expect_shape_of<WendlandC2N<2>, double>(
      [](auto... a) {
        HWY_DYNAMIC_DISPATCH(wendland_double)
        (a...);
      },
      2e-15);
}

}  // namespace
}  // namespace sluice
#endif

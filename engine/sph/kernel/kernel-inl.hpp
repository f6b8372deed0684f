// Vector forms of the smoothing functions in kernel.hpp. Included once per SIMD target.

#if defined(SLUICE_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_KERNEL_INL
#undef SLUICE_KERNEL_INL
#else
#define SLUICE_KERNEL_INL
#endif

#include <hwy/highway.h>

#include "engine/sph/kernel/kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Coefficients c_k of a polynomial for exp(-q/8) on 0 <= q <= 9, lowest first (Chebyshev
/// interpolation). Its eighth power is exp(-q) to 9e-7 in single and 3e-14 in double precision,
/// absolute, the largest value being 1.
template <typename T>
struct ExpEighth;
template <>
struct ExpEighth<float> {
  static constexpr float c[] = {0.9999999659088038F,     -0.12499962822256415F,
                                0.0078118339320090496F,  -0.00032506990277789811F,
                                1.0025442390601973e-05F, -2.2914170350436292e-07F,
                                3.048798705048816e-09F};
};
template <>
struct ExpEighth<double> {
  static constexpr double c[] = {
      0.99999999999999745,     -0.1249999999999595,     0.0078124999998578325,
      -0.00032552083312591536, 1.0172525882757654e-05,  -2.5431307969293749e-07,
      5.298170841474967e-09,   -9.4607081114760012e-11, 1.4779074581753267e-12,
      -2.0504470285311124e-14, 2.5500412579570462e-16,  -2.7882916631974012e-18,
      2.1624249926660841e-20};
};

/// eq. 6 without its constants: exp(-R^2) for R < 3, else exactly 0. W and grad W share it.
struct GaussianShape {
  using Scalar = TruncatedGaussianN<2>;

  template <class D, class V>
  static HWY_INLINE V slope(D d, V r_sq) {
    using T = hn::TFromD<D>;
    constexpr auto& c = ExpEighth<T>::c;
    constexpr int degree = static_cast<int>(std::size(c)) - 1;
    V p = hn::Set(d, c[degree]);
    for (int k = degree - 1; k >= 0; --k) p = hn::MulAdd(p, r_sq, hn::Set(d, c[k]));
    p = p * p;
    p = p * p;
    p = p * p;
    return hn::IfThenElseZero(r_sq < hn::Set(d, T{9}), p);
  }
  template <class D, class V>
  static HWY_INLINE V value(D d, V r_sq) {
    return slope(d, r_sq);
  }
};

/// Wendland C2 without its constants; zero from R = 2 on by the clamp of 1 - R/2.
struct WendlandShape {
  using Scalar = WendlandC2N<2>;

  template <class D, class V>
  static HWY_INLINE V slope(D d, V r_sq) {
    const V rest = remainder(d, hn::Sqrt(r_sq));
    return rest * rest * rest;
  }
  template <class D, class V>
  static HWY_INLINE V value(D d, V r_sq) {
    using T = hn::TFromD<D>;
    const V r = hn::Sqrt(r_sq);
    const V rest_sq = remainder(d, r) * remainder(d, r);
    return rest_sq * rest_sq * hn::MulAdd(hn::Set(d, T{2}), r, hn::Set(d, T{1}));
  }

 private:
  template <class D, class V>
  static HWY_INLINE V remainder(D d, V r) {
    using T = hn::TFromD<D>;
    return hn::Max(hn::NegMulAdd(hn::Set(d, T{0.5}), r, hn::Set(d, T{1})), hn::Zero(d));
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

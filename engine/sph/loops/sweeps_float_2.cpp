#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/sph/loops/sweeps_float_2.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "engine/sph/loops/sweeps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

void fill_float_2(const MethodN<2>& method, Sweeps<float, 2>& out) { fill(method, out); }

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "engine/sph/loops/simd_target.hpp"

namespace sluice {

HWY_EXPORT(fill_float_2);

template <>
Sweeps<float, 2> select_sweeps<float, 2>(const MethodN<2>& method, const std::string& target) {
  Sweeps<float, 2> sweeps;
  with_simd_target(target, [&] { HWY_DYNAMIC_DISPATCH(fill_float_2)(method, sweeps); });
  return sweeps;
}

}  // namespace sluice
#endif

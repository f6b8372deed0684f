// Wall pressure. Its summand is compiled once per SIMD target.

#ifndef SLUICE_SPH_TERMS_WALL_PRESSURE
#define SLUICE_SPH_TERMS_WALL_PRESSURE

namespace sluice {

/// Pressure of dummy particles, eq. 9. Walls always have one: it is a choice, not a term that a
/// method may leave out.
enum class WallPressure {
  extrapolated,  ///< as printed: may be negative
  clamped,       ///< not below zero
};

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// eq. 9: (sum_f p_f W + sum_f rho_f f . (x_w - x_f) W) / sum_f W. Summand before W, in units of
/// rho_0 c^2.
template <typename T, int Dim>
struct WallPressureSummand {
  std::array<T, Dim> gravity;  ///< f h/c^2

  template <class D, class V>
  HWY_INLINE V summand(D d, const std::array<V, Dim>& x_wf, V excess_f) const {
    const V head =
        dot(array_of<Dim>([&](auto axis) HWY_ATTR { return hn::Set(d, gravity[axis]); }), x_wf);
    return hn::MulAdd(hn::Set(d, T{1}) + excess_f, head, excess_f);
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

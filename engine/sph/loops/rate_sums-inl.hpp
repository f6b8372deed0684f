// Which rates a loop over pairs sums, and of which terms. Included once per SIMD target.

#if defined(SLUICE_RATE_SUMS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_RATE_SUMS_INL
#undef SLUICE_RATE_SUMS_INL
#else
#define SLUICE_RATE_SUMS_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <tuple>
#include <type_traits>

#include "engine/sph/loops/pair_loop-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A term that a loop sums, in one of its forms.
template <class Summed, int kSummand>
struct Form {
  using Term = Summed;
  static constexpr int kForm = kSummand;
};

/// Which rates a loop sums, and of which terms.
enum class Sums { density, acceleration, both };
template <int Dim, Sums kSums, bool kShifting, class... Forms>
struct RateSums {
  static_assert(!kShifting || kSums == Sums::density);
  static constexpr bool density = kSums != Sums::acceleration;
  static constexpr bool acceleration = kSums != Sums::density;
  static constexpr bool shifting = kShifting;
  static constexpr SumBlocks<Dim> blocks = shifting        ? kDensityAndShiftingSums<Dim>
                                           : !acceleration ? kDensitySums<Dim>
                                           : !density      ? kAccelerationSums<Dim>
                                                           : kRateSums<Dim>;
  template <RateOf kRate>
  static constexpr bool sums = kRate == RateOf::density ? density : acceleration;
  template <class Term, int kForm>
  using With = RateSums<Dim, kSums, kShifting, Forms..., Form<Term, kForm>>;

  /// The terms against one kind of neighbours. They add one after the other, in their order.
  template <Neighbours kJ, typename T>
  struct Terms {
    static constexpr bool mutual = kJ == Neighbours::fluid;
    using D = typename Blocks<T>::D;
    template <class F>
    using SummandOf = std::conditional_t<F::Term::kSummation.over(kJ),
                                         Summand<typename F::Term, F::kForm>, NoSummand>;
    template <class F>
    using ConstantsOf = typename F::Term::template Constants<T>;

    RateConstants<T> constants;

    template <class V, class J>
    HWY_INLINE V add_exchange(V sum, [[maybe_unused]] const PairI<V, Dim>& i,
                              [[maybe_unused]] const J& j) const {
      ((sum = SummandOf<Forms>::add_exchange(D(), std::get<ConstantsOf<Forms>>(constants), sum, i,
                                             j)),
       ...);
      return sum;
    }
    template <class V, class J>
    HWY_INLINE V add_along(V sum, [[maybe_unused]] const PairGeometry<V, Dim>& pair,
                           [[maybe_unused]] const PairI<V, Dim>& i,
                           [[maybe_unused]] const J& j) const {
      ((sum = SummandOf<Forms>::add_along(D(), std::get<ConstantsOf<Forms>>(constants), sum, pair,
                                          i, j)),
       ...);
      return sum;
    }
    template <class V>
    HWY_INLINE V add_component(V sum, [[maybe_unused]] V g, [[maybe_unused]] const PairI<V, Dim>& i,
                               [[maybe_unused]] V velocity_i, [[maybe_unused]] V velocity_j) const {
      ((sum = SummandOf<Forms>::add_component(D(), std::get<ConstantsOf<Forms>>(constants), sum, g,
                                              i, velocity_i, velocity_j)),
       ...);
      return sum;
    }
  };
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

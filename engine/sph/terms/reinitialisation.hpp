// Shepard density reinitialisation. Its summand is compiled once per SIMD target.

#ifndef SLUICE_SPH_TERMS_REINITIALISATION
#define SLUICE_SPH_TERMS_REINITIALISATION

#include <optional>
#include <string_view>
#include <tuple>

#include "engine/sph/terms/parameter.hpp"
#include "engine/sph/terms/term.hpp"

namespace sluice {

/// Shepard density reinitialisation, eq. 10: rho_i = sum_j m_j W / sum_j (m_j/rho_j) W. With equal
/// masses the excess of that quotient over rho_0 is sum s_j V_j W / sum V_j W, which keeps the
/// digits.
///
/// It corrects the state: `loops/reinitialisation-inl.hpp` sums it in a sweep of its own.
struct Reinitialisation {
  int interval = 20;  ///< steps from one to the next

  static constexpr TermText kText{.key = "reinitialisation",
                                  .about = "density reinitialisation, eq. 10",
                                  .plan = "eq. 10, every {interval} steps",
                                  .plan_without = "eq. 10"};
  static constexpr std::tuple kParameters{Number{"interval", &Reinitialisation::interval,
                                                 "steps from one reinitialisation to the next",
                                                 from(1, 1e6)}};
  [[nodiscard]] std::string_view in_report() const {
    return "reinitialisation every {interval} steps";
  }
};

template <>
struct InMethod<Reinitialisation> {
  std::optional<Reinitialisation> reinitialisation;
};

}  // namespace sluice

#endif

#ifdef SLUICE_SUMMANDS

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// Summands before W.
struct ShepardSummands {
  template <class V>
  static HWY_INLINE V numerator(V excess_j, V volume_j) {
    return excess_j * volume_j;
  }
};

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

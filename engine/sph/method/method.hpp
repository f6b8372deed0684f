#pragma once

#include <algorithm>

#include "engine/sph/kernel/discretisation.hpp"
#include "engine/sph/terms/list.hpp"
#include "engine/sph/terms/wall_pressure.hpp"

namespace sluice {

/// Time integration scheme.
enum class Integrator {
  modified_leap_frog,  ///< eqs. 13-17, the paper's
  kick_drift_kick,     ///< Adami et al. 2012: larger stable steps
};

/// Arithmetic of the pair sums. The particles' state is kept in double either way.
enum class Precision { mixed, double_precision };

/// What a method chooses beside its discretisation.
/// Each term of terms/list.hpp is an optional member. An empty one is left out: its sum is not
/// computed, its fields are not allocated.
struct SchemeChoices : OptionalTerms<AllTerms> {
  Integrator integrator = Integrator::modified_leap_frog;
  Precision precision = Precision::mixed;
  double courant = 0.25;  ///< C of eq. 18
  WallPressure wall_pressure = WallPressure::extrapolated;
};

/// The scheme and its constants: with a FlowDomain all that the solver must know besides the
/// particles.
template <int Dim>
struct MethodN : DiscretisationN<Dim>, SchemeChoices {
  /// A particle is excluded whose density is farther than this from rho_0, over rho_0.
  static constexpr double kDensityLeeway = 0.3;
  [[nodiscard]] double most_density_excess() const {
    return kDensityLeeway * this->reference_density;
  }

  /// No step is shorter, s: 0.05 h/c, in proportion less for a Courant number below the paper's
  /// 0.25. Only an acceleration of more than 25 c^2/h asks for less, and a particle that has it is
  /// faster than sound after such a step, and excluded: it does not hold up all others.
  [[nodiscard]] double least_time_step() const {
    return 0.05 * std::min(1.0, courant / 0.25) * this->smoothing_length / this->sound_speed;
  }
};

using Method = MethodN<kAnyDim>;

/// The same method for another type of vectors, of as many dimensions.
template <int To, int From>
[[nodiscard]] MethodN<To> method_as(const MethodN<From>& method) {
  MethodN<To> result;
  static_cast<DiscretisationNumbers&>(result) = method;
  static_cast<SchemeChoices&>(result) = method;
  result.gravity = method.gravity;
  return result;
}

}  // namespace sluice

#pragma once

#include <string>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// What linear analysis says of a run before it starts.
enum class Outlook {
  stable,    ///< no wave grows at rest
  growing,   ///< some wave grows, but not by kRuinousDecades in this run: impacts may hide it
  unstable,  ///< some wave grows from rounding to the size of the flow: the run cannot succeed
};
[[nodiscard]] std::string_view to_string(Outlook outlook);

/// Powers of ten between the rounding of the sums (1e-7) and flow at a tenth of the sound speed.
inline constexpr double kRuinousDecades = 6.0;

/// What is left of the limit where particles are out of their lattice by half their distance, as
/// they are in an impact; the analysis is of a lattice at rest. Measured by the case
/// limits-in-disorder of `sluice stability`: 0.65 for modified_leap_frog and 0.66 for
/// kick_drift_kick with the truncated Gaussian, h = dx; for Wendland C2 0.62 at h = 1.2 dx and 0.74
/// at 1.5 dx, in between as a straight line. 0.62, the least of them, for what was not measured.
[[nodiscard]] double disorder_share(const Method& method);

/// Whether the Courant number is above that share of the limit, in about a millisecond.
[[nodiscard]] bool is_beyond_flow_limit(const Scene& scene);

/// The Courant number of a scene beside the largest stable ones (von_neumann.hpp). A step at rest
/// is C h/c long; flow makes it shorter by c/(c + |v|).
struct StabilityPrediction {
  Outlook outlook = Outlook::stable;
  double courant = 0.0;          ///< numerics.courant
  double courant_limit = 0.0;    ///< of the scheme; 0: no step is stable
  double flow_limit = 0.0;       ///< disorder_share() of it
  double margin = 0.0;           ///< courant_limit / courant - 1; negative: waves grow
  double growth_per_step = 0.0;  ///< of the fastest wave at rest: spectral radius - 1, at least 0
  double growth_decades = 0.0;   ///< log10 of its growth over the estimated steps
  double sound_limit = 0.0;      ///< Courant number up to which parts alone are stable: pressure
  double viscosity_limit = 0.0;  ///< waves, eq. 8, eq. 7
  double diffusion_limit = 0.0;
  double force_limit = 0.0;  ///< c/h times 0.25 sqrt(h/|f|): fluid that falls makes no longer steps
};

/// The outlook alone, in about a millisecond; nothing to speak of for a scheme that was looked at
/// before (scheme_analysis.hpp).
[[nodiscard]] Outlook stability_outlook(const Scene& scene);

/// All of it: limits are searched for, which takes some ten milliseconds for a new scheme.
[[nodiscard]] StabilityPrediction predict_stability(const Scene& scene);

/// "Courant number 1 of at most 2.12 for particles at rest: stable, margin 112 %; at most 1.31
/// where they are thrown about".
[[nodiscard]] std::string stability_text(const StabilityPrediction& prediction);
/// One JSON object, keys as the members. A limit that does not exist is null.
[[nodiscard]] std::string stability_json(const StabilityPrediction& prediction);

}  // namespace sluice

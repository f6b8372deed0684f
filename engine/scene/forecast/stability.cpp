#include "engine/scene/forecast/stability.hpp"
#include "engine/scene/geometry/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/scene/forecast/scheme_analysis.hpp"
#include "engine/scene/forecast/workload.hpp"

namespace sluice {
namespace {

/// Log10 of the growth of the fastest wave over a run. The run's steps are at least as many as
/// steps at rest would be; the fluid may move from the start, which shortens them.
double decades(const Scene& scene, const SchemeAnalysis& analysis) {
  const Method& m = scene.method;
  double speed = 0.0;
  for (const FluidRegion& region : scene.fluid) speed = std::max(speed, greatest_speed(region));
  const double courant = m.courant * m.sound_speed / (m.sound_speed + speed);
  const double steps = scene.end_time * m.sound_speed / (courant * m.smoothing_length);
  const double growth = std::log10(analysis.spectral_radius(courant));
  return growth > LatticeStability::kTolerance ? steps * growth : 0.0;
}

Outlook outlook_of(double growth_decades) {
  if (growth_decades >= kRuinousDecades) return Outlook::unstable;
  return growth_decades > 0.0 ? Outlook::growing : Outlook::stable;
}

nlohmann::ordered_json limit_json(double limit) {
  if (limit < LatticeStability::kMostCourant) return limit;
  return nullptr;
}

}  // namespace

std::string_view to_string(Outlook outlook) {
  switch (outlook) {
    case Outlook::stable:
      return "stable";
    case Outlook::growing:
      return "growing";
    case Outlook::unstable:
      return "unstable";
  }
  return "";
}

double disorder_share(const Method& method) {
  constexpr double kLeast = 0.62;
  const double ratio = method.smoothing_length / method.spacing;
  if (method.integrator == Integrator::modified_leap_frog) {
    return method.kernel == KernelKind::truncated_gaussian && ratio <= 1.0 ? 0.65 : kLeast;
  }
  if (method.kernel == KernelKind::truncated_gaussian) return ratio <= 1.0 ? 0.66 : kLeast;
  return std::lerp(kLeast, 0.74, std::clamp((ratio - 1.2) / 0.3, 0.0, 1.0));
}

bool is_beyond_flow_limit(const Scene& scene) {
  const Method& m = scene.method;
  const double radius = analyse_scheme(m)->spectral_radius(m.courant / disorder_share(m));
  return radius - 1.0 > LatticeStability::kTolerance;
}

Outlook stability_outlook(const Scene& scene) {
  return outlook_of(decades(scene, *analyse_scheme(scene.method)));
}

StabilityPrediction predict_stability(const Scene& scene) {
  const Method& m = scene.method;
  const auto analysis = analyse_scheme(m);
  const CourantLimits limits = analysis->limits();
  StabilityPrediction p;
  p.courant = m.courant;
  p.courant_limit = limits.scheme;
  p.flow_limit = disorder_share(m) * limits.scheme;
  p.margin = limits.scheme / m.courant - 1.0;
  const double growth = analysis->spectral_radius(m.courant) - 1.0;
  p.growth_per_step = growth > LatticeStability::kTolerance ? growth : 0.0;
  p.growth_decades = decades(scene, *analysis);
  p.outlook = outlook_of(p.growth_decades);
  p.sound_limit = limits.sound;
  p.viscosity_limit = limits.viscosity;
  p.diffusion_limit = limits.diffusion;
  const double force_step = force_time_step(m);
  p.force_limit =
      std::min(force_step * m.sound_speed / m.smoothing_length, LatticeStability::kMostCourant);
  return p;
}

std::string stability_text(const StabilityPrediction& p) {
  const std::string limit =
      p.courant_limit > 0.0 ? fmt::format("at most {:.3g} for particles at rest", p.courant_limit)
                            : "none that is stable";
  std::string text = fmt::format("Courant number {:.3g} of {}: ", p.courant, limit);
  if (p.outlook == Outlook::stable) {
    text += fmt::format("stable, margin {:.0f} %", 100.0 * p.margin);
    if (p.courant <= p.flow_limit) return text;
    return text + fmt::format("; where an impact throws them about it may fail above {:.3g}",
                              p.flow_limit);
  }
  return text + fmt::format("{}, errors at rest grow by 10^{:.2g} over the run",
                            to_string(p.outlook), p.growth_decades);
}

std::string stability_json(const StabilityPrediction& p) {
  return nlohmann::ordered_json{{"outlook", to_string(p.outlook)},
                                {"courant", p.courant},
                                {"courant_limit", p.courant_limit},
                                {"flow_limit", p.flow_limit},
                                {"margin", p.margin},
                                {"growth_per_step", p.growth_per_step},
                                {"growth_decades", p.growth_decades},
                                {"sound_limit", limit_json(p.sound_limit)},
                                {"viscosity_limit", limit_json(p.viscosity_limit)},
                                {"diffusion_limit", limit_json(p.diffusion_limit)},
                                {"force_limit", limit_json(p.force_limit)}}
      .dump();
}

}  // namespace sluice

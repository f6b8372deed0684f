#include "engine/run/advice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "engine/scene/forecast/scheme_analysis.hpp"
#include "engine/scene/forecast/stability.hpp"

namespace sluice {
namespace {

using Steps = std::vector<std::string>;

/// "a, b, or c"
std::string either(const Steps& steps) {
  std::string text;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0) text += i + 1 < steps.size() ? ", " : ", or ";
    text += steps[i];
  }
  return text;
}

/// Down to two digits, so that what is advised is within the limit.
double rounded_down(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit + 1e-9) * unit;
}

void add_smaller_courant(const Method& method, Steps& steps) {
  const double limit = analyse_scheme(method)->limits().scheme;
  if (limit <= 0.0 || method.courant <= limit) return;
  steps.push_back(fmt::format("lower numerics.courant from {:g} to {:g}, what these terms allow",
                              method.courant, rounded_down(disorder_share(method) * limit)));
}

void add_missing_terms(const Method& method, Steps& steps) {
  if (method.integrator != Integrator::kick_drift_kick) {
    steps.emplace_back("use the integrator kick_drift_kick");
  }
  if (!method.viscosity || method.viscosity->alpha <= 0.0) {
    steps.emplace_back("add numerics.artificial_viscosity");
  } else if (method.viscosity->beta <= 0.0) {
    steps.emplace_back("add beta to numerics.artificial_viscosity, which stops collisions");
  }
  if (!method.diffusion) steps.emplace_back("add numerics.density_diffusion");
}

void add_clamp(const Method& method, Steps& steps) {
  if (method.wall_pressure == WallPressure::extrapolated) {
    steps.emplace_back("set numerics.wall_pressure to clamped");
  }
}

void add_sound_speed(const Method& method, Steps& steps) {
  steps.push_back(fmt::format("raise material.sound_speed above {:.4g} m/s", method.sound_speed));
}

}  // namespace

std::string advice_to_steady(const Method& method) {
  Steps steps;
  add_smaller_courant(method, steps);
  add_missing_terms(method, steps);
  add_sound_speed(method, steps);
  return either(steps);
}

std::string advice_to_stiffen(const Method& method) {
  Steps steps;
  add_sound_speed(method, steps);
  steps.emplace_back("lower the speeds and depths that the scene begins with");
  return either(steps);
}

std::string advice_to_hold(const Method& method) {
  Steps steps;
  add_clamp(method, steps);
  add_smaller_courant(method, steps);
  steps.emplace_back("make what they pass at least four spacings thick");
  steps.emplace_back("widen the domain where they leave over its edge");
  return either(steps);
}

std::string advice_to_conserve(const Method& method) {
  Steps steps;
  const bool lifts =
      method.diffusion && method.diffusion->kind == DiffusionKind::molteni_colagrossi;
  if (lifts && method.gravity.norm() > 0.0) {
    steps.emplace_back(
        "where it grew slowly, use the density diffusion fourtakas: molteni_colagrossi lifts "
        "fluid at rest");
  }
  add_smaller_courant(method, steps);
  add_missing_terms(method, steps);
  add_sound_speed(method, steps);
  return either(steps);
}

}  // namespace sluice

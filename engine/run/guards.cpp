#include "engine/run/guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/sph/crowding.hpp"

namespace sluice {
namespace {

using Finding = std::optional<Breach>;

constexpr std::string_view kSmallerStep =
    "lower numerics.courant, or use the kick_drift_kick integrator with artificial viscosity and "
    "density diffusion";

constexpr std::string_view kSlowerFlow =
    "raise material.sound_speed where the flow itself is that fast, else lower numerics.courant, "
    "or use the kick_drift_kick integrator with artificial viscosity and density diffusion";

Finding not_finite(const GuardLimits&, const StepFacts& facts) {
  const bool finite = facts.extremes.finite && std::isfinite(facts.time_step);
  if (finite) return {};
  return Breach{std::numeric_limits<double>::quiet_NaN(), 0.0, kSmallerStep};
}

Finding too_dense(const GuardLimits& limits, const StepFacts& facts) {
  const double ratio = 1.0 + facts.extremes.max_density_excess / limits.reference_density;
  if (ratio <= limits.density_ratio_max) return {};
  return Breach{ratio, limits.density_ratio_max,
                "raise material.sound_speed, or lower numerics.courant"};
}

Finding too_thin(const GuardLimits& limits, const StepFacts& facts) {
  const double ratio = 1.0 + facts.extremes.min_density_excess / limits.reference_density;
  if (ratio >= limits.density_ratio_min) return {};
  return Breach{ratio, limits.density_ratio_min,
                "raise material.sound_speed, or lower numerics.courant"};
}

Finding too_fast(const GuardLimits& limits, const StepFacts& facts) {
  if (facts.extremes.max_speed <= limits.speed) return {};
  return Breach{facts.extremes.max_speed, limits.speed, kSlowerFlow};
}

Finding step_collapsed(const GuardLimits& limits, const StepFacts& facts) {
  if (facts.step == 0 || facts.time_step >= limits.time_step) return {};
  return Breach{facts.time_step, limits.time_step,
                "look for a particle that is thrown about: raise artificial viscosity, or lower "
                "numerics.courant"};
}

Finding escaped(double share, const StepFacts& facts, std::string_view suggestion) {
  const double found =
      static_cast<double>(facts.leaked) / static_cast<double>(facts.initial_particles);
  if (found <= share) return {};
  return Breach{found, share, suggestion};
}

Finding too_many_escaped(const GuardLimits& limits, const StepFacts& facts) {
  return escaped(limits.leaked_share, facts,
                 "clamp numerics.wall_pressure, lower numerics.courant, or widen the domain");
}

Finding energy_grew(const GuardLimits& limits, const StepFacts& facts) {
  if (!facts.energy) return {};
  const GuardBaselines& base = facts.baselines;
  const double growth = (*facts.energy - base.initial_energy) / base.energy_scale;
  if (growth <= limits.energy_growth) return {};
  return Breach{
      growth, limits.energy_growth,
      "when it grew slowly, the density diffusion molteni_colagrossi lifted fluid at rest: "
      "use fourtakas; when it grew fast, lower numerics.courant, or use the "
      "kick_drift_kick integrator with artificial viscosity and density diffusion"};
}

Finding clumped(const GuardLimits& limits, const StepFacts& facts) {
  if (facts.extremes.max_neighbours <= limits.neighbours) return {};
  return Breach{static_cast<double>(facts.extremes.max_neighbours), limits.neighbours,
                "particles clump: raise material.sound_speed, or lower numerics.courant"};
}

Finding fast(const GuardLimits& limits, const StepFacts& facts) {
  if (facts.extremes.max_speed <= limits.speed_warning) return {};
  return Breach{facts.extremes.max_speed, limits.speed_warning,
                "the fluid is no longer weakly compressible: raise material.sound_speed"};
}

Finding some_escaped(const GuardLimits& limits, const StepFacts& facts) {
  return escaped(limits.leaked_share_warning, facts,
                 "clamp numerics.wall_pressure, or lower numerics.courant");
}

// clang-format off
constexpr std::array kFailing{
    Guard{"a particle is not finite", Suspect::fastest, not_finite},
    Guard{"speed above the sound speed (m/s)", Suspect::fastest, too_fast},
    Guard{"density ratio rho/rho_0 too high", Suspect::densest, too_dense},
    Guard{"density ratio rho/rho_0 too low", Suspect::lightest, too_thin},
    Guard{"time step collapsed (s)", Suspect::fastest, step_collapsed},
    Guard{"share of particles that left through a wall or the edge of the domain", {}, too_many_escaped},
    Guard{"energy grew (share of the initial energy)", {}, energy_grew},
    Guard{"neighbours of a particle", {}, clumped},
};
constexpr std::array kWarning{
    Guard{"speed above 0.3 of the sound speed (m/s)", Suspect::fastest, fast},
    Guard{"share of particles that left through a wall or the edge of the domain", {}, some_escaped},
};
// clang-format on

/// Height of a particle against gravity, m; 0 without gravity.
double height_of(const Particles& particles, std::size_t i, const Vec& gravity) {
  const double strength = gravity.norm();
  return strength > 0.0 ? -particles.position(i).dot(gravity) / strength : 0.0;
}

}  // namespace

std::string Diagnosis::text() const {
  std::string who = particle ? fmt::format(", particle {:.0f}", *particle) : "";
  return fmt::format("{} at step {}, t = {:.6g} s{}: found {:.4g}, limit {:.4g}; {}", reason, step,
                     time, who, value, limit, suggestion);
}

NumericalFailure::NumericalFailure(Diagnosis diagnosis)
    : std::runtime_error(diagnosis.text()), diagnosis_(std::move(diagnosis)) {}

GuardLimits GuardLimits::for_method(const Method& method) {
  GuardLimits limits;
  limits.speed = method.sound_speed;
  limits.speed_warning = 0.3 * method.sound_speed;
  const double usual_step = method.smoothing_length / method.sound_speed;
  limits.time_step = 0.05 * usual_step * std::min(1.0, method.courant / 0.25);
  // Fewer are never counted. That is seven times what the paper's support holds; wider supports get
  // the same margin.
  const double in_support = std::numbers::pi * std::pow(method.support() / method.spacing, 2);
  limits.neighbours = std::max<double>(kManyNeighbours, 7.0 * in_support);
  limits.reference_density = method.reference_density;
  return limits;
}

std::span<const Guard> failing_guards() { return kFailing; }
std::span<const Guard> warning_guards() { return kWarning; }

std::optional<Diagnosis> first_breach(std::span<const Guard> guards, const GuardLimits& limits,
                                      const StepFacts& facts) {
  for (const Guard& guard : guards) {
    const Finding breach = guard.breached(limits, facts);
    if (!breach) continue;
    const bool blame = guard.suspect && facts.suspect_id;
    return Diagnosis{
        .reason = std::string(guard.reason),
        .step = facts.step,
        .time = facts.time,
        .particle = blame ? std::optional(facts.suspect_id(*guard.suspect)) : std::nullopt,
        .value = breach->value,
        .limit = breach->limit,
        .suggestion = std::string(breach->suggestion)};
  }
  return {};
}

GuardBaselines initial_baselines(const Method& method, const SolverState& state,
                                 const Energy& energy) {
  const Particles& particles = state.particles;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    lowest = std::min(lowest, height_of(particles, i, method.gravity));
  }
  double lifted = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    lifted += height_of(particles, i, method.gravity) - lowest;
  }
  GuardBaselines base;
  base.initial_mass = static_cast<double>(particles.size()) * method.particle_mass();
  base.initial_energy = energy.total();
  base.highest_energy = energy.total();
  const double brought =
      energy.kinetic + energy.internal + method.particle_mass() * method.gravity.norm() * lifted;
  const double slow = method.sound_speed / 100.0;
  base.energy_scale = std::max(brought, 0.5 * base.initial_mass * slow * slow);
  return base;
}

}  // namespace sluice

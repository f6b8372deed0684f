#include "engine/run/guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/run/advice.hpp"
#include "engine/sph/method/removed.hpp"
#include "engine/sph/stability/neighbour_count.hpp"

namespace sluice {
namespace {

using Finding = std::optional<Breach>;

/// So that a NaN is above every limit.
Finding above(double found, double limit) {
  if (found <= limit) return {};
  return Breach{found, limit};
}

double share_of(std::size_t count, const StepFacts& facts) {
  return static_cast<double>(count) / static_cast<double>(facts.initial_particles);
}

std::size_t leaked_in(const StepFacts& facts) {
  return facts.removed[static_cast<std::size_t>(RemovalCause::leaked)];
}

std::size_t excluded_in(const StepFacts& facts) {
  std::size_t count = 0;
  for (std::size_t cause = 0; cause < kRemovalCauses; ++cause) {
    if (is_exclusion(static_cast<RemovalCause>(cause))) count += facts.removed[cause];
  }
  return count;
}

/// " (30 too dense, 2 too fast)"
std::string kinds_of_excluded(const StepFacts& facts) {
  std::string text;
  for (std::size_t cause = 0; cause < kRemovalCauses; ++cause) {
    const auto kind = static_cast<RemovalCause>(cause);
    if (!is_exclusion(kind) || facts.removed[cause] == 0) continue;
    text +=
        fmt::format("{}{} {}", text.empty() ? " (" : ", ", facts.removed[cause], to_string(kind));
  }
  return text + ")";
}

Finding excluded_above(std::size_t count, double share, const StepFacts& facts) {
  const auto all = static_cast<double>(facts.initial_particles);
  Finding breach = above(static_cast<double>(count), GuardLimits::most_of(share, all));
  if (breach) breach->detail = kinds_of_excluded(facts);
  return breach;
}

Finding many_excluded(const GuardLimits& limits, const StepFacts& facts) {
  return excluded_above(excluded_in(facts), limits.excluded_share, facts);
}

Finding many_excluded_at_once(const GuardLimits& limits, const StepFacts& facts) {
  return excluded_above(facts.excluded_at_once, limits.excluded_share_at_once, facts);
}

/// Root mean square of what a particle of this energy has: of v for v^2/2, and to first order of
/// c (rho - rho_0)/rho_0 for the internal energy.
double root_mean_square(double energy, const GuardLimits& limits, const StepFacts& facts) {
  const double mass = limits.method.particle_mass() * static_cast<double>(facts.particles);
  return mass > 0.0 ? std::sqrt(2.0 * energy / mass) : 0.0;
}

Finding fast_as_a_whole(const GuardLimits& limits, const StepFacts& facts) {
  if (!facts.energy) return {};
  return above(root_mean_square(facts.energy->kinetic, limits, facts), limits.bulk_speed);
}

Finding compressed_as_a_whole(const GuardLimits& limits, const StepFacts& facts) {
  if (!facts.energy) return {};
  const double density =
      root_mean_square(facts.energy->internal, limits, facts) / limits.method.sound_speed;
  return above(density, limits.bulk_density);
}

Finding too_many_escaped(const GuardLimits& limits, const StepFacts& facts) {
  const auto all = static_cast<double>(facts.initial_particles);
  const double most = GuardLimits::most_of(limits.leaked_share, all);
  return above(share_of(leaked_in(facts), facts), most / all);
}

Finding energy_grew(const GuardLimits& limits, const StepFacts& facts) {
  if (!facts.energy) return {};
  const GuardBaselines& base = facts.baselines;
  const double grown = facts.energy->total() + facts.energy_that_left - base.initial_energy;
  return above(grown / base.energy_scale, limits.energy_growth);
}

Finding clumped(const GuardLimits& limits, const StepFacts& facts) {
  return above(facts.extremes.max_neighbours, limits.neighbours);
}

Finding fast(const GuardLimits& limits, const StepFacts& facts) {
  return above(facts.extremes.max_speed, limits.speed_warning);
}

Finding some_escaped(const GuardLimits& limits, const StepFacts& facts) {
  return above(share_of(leaked_in(facts), facts), limits.leaked_share_warning);
}

Finding some_excluded(const GuardLimits& limits, const StepFacts& facts) {
  return above(share_of(excluded_in(facts), facts), limits.excluded_share_warning);
}

// clang-format off
constexpr std::string_view kEscaped = "share of particles that went into or through a solid or over the edge of the domain";
constexpr std::array kFailing{
    Guard{"particles excluded within the time that sound needs across the fluid", many_excluded_at_once, advice_to_steady},
    Guard{"particles excluded since the start", many_excluded, advice_to_steady},
    Guard{"mean speed of the fluid above half of the sound speed (m/s)", fast_as_a_whole, advice_to_stiffen},
    Guard{"mean density of the fluid off rho_0 (share of it)", compressed_as_a_whole, advice_to_stiffen},
    Guard{kEscaped, too_many_escaped, advice_to_hold},
    Guard{"energy grew (share of the initial energy)", energy_grew, advice_to_conserve},
    Guard{"neighbours of a particle, so that particles clump", clumped, advice_to_steady},
};
constexpr std::array kWarning{
    Guard{"speed above 0.3 of the sound speed (m/s)", fast, advice_to_stiffen},
    Guard{kEscaped, some_escaped, advice_to_hold},
    Guard{"share of particles excluded", some_excluded, advice_to_steady},
};
// clang-format on

/// Height of a particle against gravity, m; 0 without gravity.
double height_of(const Particles& particles, std::size_t i, const Vec& gravity) {
  const double strength = gravity.norm();
  return strength > 0.0 ? -particles.position_of(i).dot(gravity) / strength : 0.0;
}

}  // namespace

std::string Diagnosis::text() const {
  return fmt::format("{} at step {}, t = {:.6g} s: found {:.4g}, limit {:.4g}; {}", reason, step,
                     time, value, limit, suggestion);
}

NumericalFailure::NumericalFailure(Diagnosis diagnosis)
    : std::runtime_error(diagnosis.text()), diagnosis_(std::move(diagnosis)) {}

GuardLimits GuardLimits::for_method(const Method& method) {
  GuardLimits limits;
  limits.method = method;
  limits.speed_warning = 0.3 * method.sound_speed;
  limits.bulk_speed = 0.5 * method.sound_speed;
  limits.bulk_density = 0.5 * Method::kDensityLeeway;
  // Fewer are never counted. That is seven times what the paper's support holds; wider supports get
  // the same margin.
  const int dimensions = method.dimensions();
  const double in_support = in_dimensions(
      dimensions, [&]<int Dim>() { return points_within<Dim>(method.support() / method.spacing); });
  limits.neighbours = std::max<double>(many_neighbours(dimensions), 7.0 * in_support);
  return limits;
}

double GuardLimits::most_of(double share, double particles) {
  constexpr double kHandful = 8.0;
  return std::max(share * particles, std::min(kHandful, 0.1 * particles));
}

double GuardLimits::crossing_time(const GuardBaselines& baselines) const {
  const double measure = baselines.initial_mass / method.reference_density;
  return (method.dimensions() == kPlaneDim ? std::sqrt(measure) : std::cbrt(measure)) /
         method.sound_speed;
}

double energy_that_left(const Method& method, const RemovedParticle& removed) {
  const Energy energy = energy_of(method, removed);
  return is_exclusion(removed.cause) ? energy.potential : energy.total();
}

std::span<const Guard> failing_guards() { return kFailing; }
std::span<const Guard> warning_guards() { return kWarning; }

std::optional<Diagnosis> first_breach(std::span<const Guard> guards, const GuardLimits& limits,
                                      const StepFacts& facts) {
  for (const Guard& guard : guards) {
    const Finding breach = guard.breached(limits, facts);
    if (!breach) continue;
    return Diagnosis{.reason = std::string(guard.reason) + breach->detail,
                     .step = facts.step,
                     .time = facts.time,
                     .value = breach->value,
                     .limit = breach->limit,
                     .suggestion = guard.advice(limits.method)};
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
    // A particle's middle is half a spacing above its lower edge: else one row of them had none.
    lifted += height_of(particles, i, method.gravity) - lowest + 0.5 * method.spacing;
  }
  double left = 0.0;
  for (const RemovedParticle& removed : state.removed) left += energy_that_left(method, removed);
  GuardBaselines base;
  base.initial_mass =
      static_cast<double>(particles.size() + state.removed.size()) * method.particle_mass();
  base.initial_energy = energy.total() + left;
  base.highest_energy = base.initial_energy;
  const double brought =
      energy.kinetic + energy.internal + method.particle_mass() * method.gravity.norm() * lifted;
  const double slow = method.sound_speed / 100.0;
  base.energy_scale = std::max(brought, 0.5 * base.initial_mass * slow * slow);
  return base;
}

}  // namespace sluice

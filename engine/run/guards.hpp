#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/sph/solver/solver.hpp"
#include "engine/store/files/checkpoint.hpp"

namespace sluice {

/// Why a run cannot be trusted any more.
struct Diagnosis {
  std::string reason;
  std::uint64_t step = 0;
  double time = 0.0;   ///< s
  double value = 0.0;  ///< what was found, in the unit that `reason` names
  double limit = 0.0;  ///< what was allowed
  std::string suggestion;

  [[nodiscard]] std::string text() const;
};

/// A guard tripped. The state that violates it is never written to a checkpoint.
class NumericalFailure : public std::runtime_error {
 public:
  explicit NumericalFailure(Diagnosis diagnosis);
  [[nodiscard]] const Diagnosis& diagnosis() const { return diagnosis_; }

 private:
  Diagnosis diagnosis_;
};

/// Limits that follow from the method, fixed for a run.
struct GuardLimits {
  double speed_warning = 0.0;  ///< m/s: 0.3 c, where weak compressibility ends to be weak
  double leaked_share = 0.01;
  double leaked_share_warning = 0.001;
  double excluded_share = 0.005;           ///< of the particles, since the start
  double excluded_share_at_once = 0.001;   ///< within the time that sound needs across the fluid
  double excluded_share_warning = 0.0001;  ///< since the start
  double bulk_speed = 0.0;                 ///< m/s: root mean square, half of what one may have
  double bulk_density = 0.0;    ///< of (rho - rho_0)/rho_0: root mean square, half of the same
  double energy_growth = 0.05;  ///< of GuardBaselines::energy_scale
  double neighbours = 0.0;      ///< 200, more where the support itself holds many particles
  Method method;                ///< of which the advice is

  [[nodiscard]] static GuardLimits for_method(const Method& method);

  /// So many of `particles` may be excluded or leak: the share of them, in a small run eight or, in
  /// a tiny one, a tenth of all: a handful says nothing of the fluid as a whole.
  [[nodiscard]] static double most_of(double share, double particles);
  /// Time that sound needs across a square or a cube of the fluid's mass, s.
  [[nodiscard]] double crossing_time(const GuardBaselines& baselines) const;
};

/// What the guards look at after a step.
struct StepFacts {
  std::uint64_t step = 0;
  double time = 0.0;  ///< s
  Extremes extremes;
  /// Particles that left, by cause; overtopping is no failure.
  std::array<std::size_t, kRemovalCauses> removed{};
  std::size_t excluded_at_once = 0;  ///< within the last GuardLimits::crossing_time
  std::size_t initial_particles = 0;
  std::size_t particles = 0;
  std::optional<Energy> energy;   ///< where it was summed
  double energy_that_left = 0.0;  ///< J/m, see energy_that_left()
  GuardBaselines baselines;
};

/// What removed particles took along of the energy that the guard watches, J/m: all that was in
/// those that went over a rim or leaked; of an excluded one the potential energy alone, for its
/// speed or density came from nowhere, and its kind is judged by its number.
[[nodiscard]] double energy_that_left(const Method& method, const RemovedParticle& removed);

/// Energy is summed, and its guard checked, every this many steps.
inline constexpr std::uint64_t kEnergyInterval = 50;

/// One guard: `breached` returns the value found and the limit, or nothing.
struct Breach {
  double value = 0.0;
  double limit = 0.0;
  std::string detail = {};  ///< goes behind the reason
};
struct Guard {
  std::string_view reason;
  std::optional<Breach> (*breached)(const GuardLimits&, const StepFacts&);
  std::string (*advice)(const Method&);  ///< what to do in a scene with these terms
};

/// All guards that end a run, in the order in which they are asked: a cause before its
/// consequences.
[[nodiscard]] std::span<const Guard> failing_guards();
/// Guards that only warn.
[[nodiscard]] std::span<const Guard> warning_guards();

/// The first of `guards` that is breached.
[[nodiscard]] std::optional<Diagnosis> first_breach(std::span<const Guard> guards,
                                                    const GuardLimits& limits,
                                                    const StepFacts& facts);

/// Baselines at the start. The scale of the energy guard is the energy that the fluid brings: what
/// moves, is compressed, or stands above the fluid's lower edge, and at least the kinetic
/// energy at c/100, so that a scene at rest is not judged against rounding.
[[nodiscard]] GuardBaselines initial_baselines(const Method& method, const SolverState& state,
                                               const Energy& energy);

}  // namespace sluice

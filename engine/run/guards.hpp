#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/sph/solver.hpp"
#include "engine/store/checkpoint.hpp"

namespace sluice {

/// Why a run cannot be trusted any more.
struct Diagnosis {
  std::string reason;
  std::uint64_t step = 0;
  double time = 0.0;               ///< s
  std::optional<double> particle;  ///< id, where one particle is to blame
  double value = 0.0;              ///< what was found, in the unit that `reason` names
  double limit = 0.0;              ///< what was allowed
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
  double density_ratio_min = 0.7;  ///< rho / rho_0
  double density_ratio_max = 1.3;
  double speed = 0.0;          ///< m/s: the sound speed c
  double speed_warning = 0.0;  ///< m/s: 0.3 c, where weak compressibility ends to be weak
  double time_step = 0.0;      ///< s: 0.05 h/c, less for a Courant number below the paper's 0.25
  double leaked_share = 0.01;
  double leaked_share_warning = 0.001;
  double energy_growth = 0.05;     ///< of GuardBaselines::energy_scale
  double neighbours = 0.0;         ///< 200, more where the support itself holds many particles
  double reference_density = 0.0;  ///< kg/m^3

  [[nodiscard]] static GuardLimits for_method(const Method& method);
};

/// What the guards look at after a step.
struct StepFacts {
  std::uint64_t step = 0;
  double time = 0.0;       ///< s
  double time_step = 0.0;  ///< s, 0 before the first step
  Extremes extremes;
  std::size_t leaked =
      0;  ///< particles that passed through a wall so far; overtopping is no failure
  std::size_t initial_particles = 0;
  std::optional<double> energy;  ///< J/m, where it was summed
  GuardBaselines baselines;
  std::function<double(Suspect)> suspect_id;  ///< asked only after a breach
};

/// Energy is summed, and its guard checked, every this many steps.
inline constexpr std::uint64_t kEnergyInterval = 50;

/// One guard: `breached` returns the value found, the limit and what to do, or nothing.
struct Breach {
  double value = 0.0;
  double limit = 0.0;
  std::string_view suggestion;
};
struct Guard {
  std::string_view reason;
  std::optional<Suspect> suspect;  ///< the particle to blame, where it is one
  std::optional<Breach> (*breached)(const GuardLimits&, const StepFacts&);
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
/// moves, is compressed, or stands above the fluid's lowest particle, and at least the kinetic
/// energy at c/100, so that a scene at rest is not judged against rounding.
[[nodiscard]] GuardBaselines initial_baselines(const Method& method, const SolverState& state,
                                               const Energy& energy);

}  // namespace sluice

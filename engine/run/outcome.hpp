#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/run/exit_code.hpp"
#include "engine/run/guards.hpp"
#include "engine/run/simulation.hpp"
#include "engine/store/disk/errors.hpp"

namespace sluice {

/// What an attempt cost. Only this attempt: a resumed run counts from its checkpoint on.
struct Account {
  double seconds = 0.0;       ///< wall time from the first step to the last, everything included
  double core_seconds = 0.0;  ///< processor time of all threads in that time
  std::uint64_t steps = 0;
  std::uint64_t particle_steps = 0;
  std::array<double, kPassCount> pass_seconds{};
  double checkpoint_seconds = 0.0;
  double output_seconds = 0.0;  ///< frames and series.h5
  int checkpoints = 0;
  std::uint64_t engine_bytes = 0;  ///< state, pair arrays and lists at the end of the attempt

  /// Fluid-particle steps per second; 0 when nothing ran.
  [[nodiscard]] double rate() const;
};

/// How an attempt ended: what outcome.json holds.
struct Outcome {
  ExitCode exit_code = ExitCode::done;
  std::string reason;  ///< empty when the run is complete
  std::optional<Diagnosis> diagnosis;
  std::string build;
  std::string machine;  ///< processor and number of cores
  std::string simd_target;
  int threads = 1;
  bool bit_exact = true;
  std::uint64_t step = 0;
  double time = 0.0;      ///< s
  double end_time = 0.0;  ///< s
  std::size_t particles = 0;
  std::size_t wall_particles = 0;
  Departed overtopped;
  Departed leaked;
  Departed excluded;
  double energy = 0.0;  ///< of the fluid, J, in the plane per metre of depth
  GuardBaselines extremes;
  double reference_density = 0.0;  ///< kg/m^3
  std::string physics_digest;      ///< SHA-256; empty after a numerical failure
  std::vector<std::pair<std::string, std::string>> series_digests;  ///< sensor, SHA-256
  Account account;

  /// "completed", "stopped" (goes on when run again) or "failed".
  [[nodiscard]] std::string_view state() const;
};

/// What the simulation tells; exit code, reason and account are the caller's.
[[nodiscard]] Outcome describe_simulation(const Simulation& simulation);

[[nodiscard]] nlohmann::ordered_json to_json(const Outcome& outcome);

/// The account for people: figure of merit, passes with their share, digest, what ran it.
[[nodiscard]] std::string summary_text(const Outcome& outcome);

/// The exit code that belongs to a fault before or outside of a run.
[[nodiscard]] ExitCode exit_code_of(StorageFault fault);

}  // namespace sluice

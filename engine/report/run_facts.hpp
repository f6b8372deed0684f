#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/model/scene.hpp"
#include "engine/store/files/series.hpp"

namespace sluice {

struct PassCost {
  std::string name;
  double seconds = 0.0;
  double share = 0.0;
};

/// What outcome.json says, as far as it says it: another version may have written it.
struct RunFacts {
  std::string state;   ///< "" while the run has not ended
  std::string reason;  ///< why it is not complete
  std::string machine, simd_target, build;
  std::optional<double> threads, step, time, particles, wall_particles, overtopped, leaked,
      excluded;
  std::optional<double> seconds;       ///< wall time of the last attempt
  std::optional<double> core_seconds;  ///< of the whole run, see core_seconds_scaled
  bool core_seconds_scaled = false;    ///< the last attempt's cost per step times all steps
  std::optional<double>
      particle_steps_per_second;  ///< of the last attempt, per second of wall time
  std::vector<PassCost> passes;
  std::optional<double> max_speed, min_density_ratio, max_density_ratio, min_time_step,
      max_neighbours;
  std::optional<double> initial_energy, highest_energy, last_energy, energy_scale;
  std::string physics_digest;
  std::vector<std::pair<std::string, std::string>> series_digests;
};

[[nodiscard]] RunFacts run_facts(const nlohmann::ordered_json& outcome);

/// What a run may not make or lose. Energies in J, in the plane per metre of depth; from the first
/// sensor of kind energy, else from the outcome; absent where neither tells.
struct Conservation {
  std::optional<double> first_energy, last_energy, highest_energy;  ///< total
  std::optional<double> energy_scale;  ///< what the fluid brings, see initial_baselines()
  std::optional<double> lost_mass;     ///< share of the fluid that left the domain or passed a wall
};
[[nodiscard]] Conservation conservation_of(const std::vector<Series>& series,
                                           const RunFacts& facts);

}  // namespace sluice

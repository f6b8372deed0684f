#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/store/files/sample_table.hpp"

namespace sluice {

/// What guards compare with, and the extremes that they saw since the start of the run.
struct GuardBaselines {
  double initial_energy = 0.0;           ///< J/m
  double energy_scale = 0.0;             ///< J/m: what a growth is measured against
  double highest_energy = 0.0;           ///< J/m
  double initial_mass = 0.0;             ///< kg/m
  double max_speed_seen = 0.0;           ///< m/s
  double min_density_excess_seen = 0.0;  ///< kg/m^3
  double max_density_excess_seen = 0.0;  ///< kg/m^3
  double min_time_step_seen = 0.0;       ///< s; 0 before the first step
  double max_neighbours_seen = 0.0;      ///< as Extremes::max_neighbours
  friend bool operator==(const GuardBaselines&, const GuardBaselines&) = default;
};

/// The one list of the numbers of GuardBaselines, for files and checks.
struct GuardNumber {
  std::string_view name;
  double GuardBaselines::*member;
};
inline constexpr std::array kGuardNumbers{
    GuardNumber{"initial_energy", &GuardBaselines::initial_energy},
    GuardNumber{"energy_scale", &GuardBaselines::energy_scale},
    GuardNumber{"highest_energy", &GuardBaselines::highest_energy},
    GuardNumber{"initial_mass", &GuardBaselines::initial_mass},
    GuardNumber{"max_speed_seen", &GuardBaselines::max_speed_seen},
    GuardNumber{"min_density_excess_seen", &GuardBaselines::min_density_excess_seen},
    GuardNumber{"max_density_excess_seen", &GuardBaselines::max_density_excess_seen},
    GuardNumber{"min_time_step_seen", &GuardBaselines::min_time_step_seen},
    GuardNumber{"max_neighbours_seen", &GuardBaselines::max_neighbours_seen},
};

/// All that a run is at the end of a step. Two equal checkpoints go on to equal results.
struct Checkpoint {
  std::string scene_hash;   ///< XXH3-128 of the canonical scene text, hexadecimal
  std::string build;        ///< version of the program that wrote it
  std::string simd_target;  ///< SIMD target of the sums
  bool bit_exact = true;    ///< false once a run has gone on with another build or SIMD target
  Integrator integrator = Integrator::modified_leap_frog;
  SolverState solver;
  std::vector<SampleTable> samples;
  GuardBaselines guards;
  std::uint64_t next_snapshot =
      0;  ///< the next frame is due at the first step with time >= next_snapshot * interval
};

}  // namespace sluice

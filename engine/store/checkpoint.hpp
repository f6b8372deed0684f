#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/sph/method.hpp"
#include "engine/sph/particles.hpp"
#include "engine/store/series.hpp"

namespace sluice {

/// What guards compare with.
struct GuardBaselines {
  double initial_energy = 0.0;  ///< J/m
  double energy_scale = 0.0;    ///< J/m: what a growth is measured against
  double highest_energy = 0.0;  ///< J/m
  double initial_mass = 0.0;    ///< kg/m
  double max_speed_seen = 0.0;  ///< m/s
  friend bool operator==(const GuardBaselines&, const GuardBaselines&) = default;
};

/// All that a run is at the end of a step. Two equal checkpoints go on to equal results.
struct Checkpoint {
  std::string scene_hash;   ///< XXH3-128 of the canonical scene text, hexadecimal
  std::string build;        ///< version of the program that wrote it
  std::string simd_target;  ///< SIMD target of the sums
  bool bit_exact = true;    ///< false once a run has gone on with another build or SIMD target
  Integrator integrator = Integrator::modified_leap_frog;
  SolverState solver;
  std::vector<Series> series;
  GuardBaselines guards;
  std::uint64_t next_frame =
      0;  ///< the next frame is due at the first step with time >= next_frame * interval
};

}  // namespace sluice

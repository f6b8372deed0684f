#pragma once

#include <cstdint>
#include <optional>

#include "engine/run/exit_code.hpp"
#include "engine/run/outcome.hpp"
#include "engine/run/reporter.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {

/// When checkpoints are written while a run goes on. One at the end, and at a stop, always is.
enum class CheckpointPolicy {
  by_cost,      ///< checkpoint_interval() of the measured cost
  every_steps,  ///< RunOptions::checkpoint_steps
  at_end_only,
};

struct RunOptions {
  Execution execution;
  CheckpointPolicy checkpoints = CheckpointPolicy::by_cost;
  std::uint64_t checkpoint_steps = 1;            ///< for every_steps
  std::optional<std::uint64_t> stop_after_step;  ///< stop as if asked to once this step is done
  double storage_patience = 30.0;  ///< s to go on trying when the disk is full or refuses
};

/// Runs the job in `folder` from its newest usable checkpoint, or from the scene, to the scene's
/// end time or a stop. Writes checkpoints, frames, series.h5, outcome.json and log.jsonl. Takes the
/// process's signals while it runs (signals.hpp). A numerical failure, a stop and a disk that stays
/// full are outcomes. Throws StorageError when there is nothing to go on from:
/// no_usable_checkpoint, wrong_scene, unsupported_version.
[[nodiscard]] Outcome run_job(JobFolder& folder, const Scene& scene, const RunOptions& options,
                              Reporter& reporter);

}  // namespace sluice

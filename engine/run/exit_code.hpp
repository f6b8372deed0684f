#pragma once

namespace sluice {

/// How `sluice run` ends, as the shell and the service see it.
enum class ExitCode : int {
  done = 0,
  internal_error = 1,  ///< a defect of the program: never expected
  usage = 2,
  invalid_scene = 3,
  numerical_failure = 4,     ///< a guard tripped; the last good checkpoint is kept
  storage_failure = 5,       ///< disk full, write error, or a folder that cannot be used
  no_usable_checkpoint = 6,  ///< checkpoints exist, none can be read
  folder_locked = 7,         ///< another process runs this job
  checkpointed = 85,         ///< stopped as asked; run the folder again to go on
};

}  // namespace sluice

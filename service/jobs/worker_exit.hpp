#pragma once

namespace sluice {

/// Exit codes of `sluice run` that the service acts on. The service stands beside engine/run and
/// not on it, so the numbers stand here again; tests/service holds both equal.
struct WorkerExit {
  static constexpr int done = 0;
  static constexpr int usage = 2;
  static constexpr int invalid_scene = 3;
  static constexpr int numerical_failure = 4;
  static constexpr int storage_failure = 5;
  static constexpr int no_usable_checkpoint = 6;
  static constexpr int folder_locked = 7;
  static constexpr int checkpointed = 85;
};

}  // namespace sluice

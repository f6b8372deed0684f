#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "engine/run/cadence.hpp"
#include "engine/run/outcome.hpp"
#include "engine/run/reporter.hpp"
#include "engine/run/run_loop.hpp"
#include "engine/run/simulation.hpp"
#include "engine/run/stopwatch.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {

/// Everything that a run writes, with what it cost and what happens when the disk refuses. A failed
/// write leaves what was there; it is tried again until RunOptions::storage_patience has passed,
/// then the StorageError is thrown on.
class JobWriter {
 public:
  /// Where it waits for the disk it hurries as soon as `hurried` says so (insist.hpp) and there is
  /// a checkpoint to go on from.
  JobWriter(JobFolder& folder, const RunOptions& options, Reporter& reporter,
            std::function<bool()> hurried);

  /// The step of the checkpoint that the run goes on from: it need not be written again.
  void resumed_at(std::uint64_t step);

  /// Writes a checkpoint when the policy says so. When the disk refuses, the run goes on and the
  /// next try waits.
  void checkpoint_when_due(const Simulation& simulation);
  /// Writes one now, if this step has none; a failure waits as above.
  void checkpoint_soon(const Simulation& simulation);
  /// Writes one now and waits for the disk. Nothing is written from a state that violates a guard:
  /// the run goes on from an older checkpoint then.
  void checkpoint_surely(const Simulation& simulation);

  /// Writes the frame that is due, waiting for the disk: a frame cannot be made up for later.
  void write_due_snapshot(Simulation& simulation);

  /// Publishes series.h5 when it is due; a failure is only warned about.
  void refresh_series(const Simulation& simulation);
  /// Publishes it so that it survives a power cut, waiting for the disk.
  void finish_series(const Simulation& simulation);
  /// Publishes outcome.json, waiting for the disk; once only where the disk has refused already.
  void write_outcome(const Outcome& outcome);

  /// The newest checkpoint of this run, or that it began from, if it is on the disk and whole.
  [[nodiscard]] std::optional<std::filesystem::path> whole_checkpoint() const;
  /// Seconds since the last checkpoint was safe; nothing before the first.
  [[nodiscard]] std::optional<double> checkpoint_age() const;
  /// Adds what the writing cost.
  void account(Account& account) const;

 private:
  void write_checkpoint(const Simulation& simulation);
  void try_checkpoint(const Simulation& simulation);
  void persist(std::string_view what, const std::function<void()>& write);
  void warn(std::string_view what, const StorageError& error, double wait);
  [[nodiscard]] bool checkpoint_due(const Simulation& simulation) const;
  [[nodiscard]] bool is_hurried() const;

  JobFolder* folder_;
  RunOptions options_;
  Reporter* reporter_;
  std::function<bool()> hurried_;
  Stopwatch clock_;
  Backoff backoff_;
  std::optional<std::uint64_t> checkpoint_step_;  ///< step of the newest checkpoint
  std::optional<double> checkpoint_at_;           ///< clock, s
  double checkpoint_cost_ = 0.0;                  ///< of the last one, s
  double checkpoint_seconds_ = 0.0;
  int checkpoints_ = 0;
  double next_series_ = 0.0;  ///< clock, s
  double output_seconds_ = 0.0;
};

}  // namespace sluice

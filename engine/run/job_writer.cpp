#include "engine/run/job_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/run/events.hpp"
#include "engine/run/insist.hpp"
#include "engine/store/disk/trailer.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {
JobWriter::JobWriter(JobFolder& folder, const RunOptions& options, Reporter& reporter,
                     std::function<bool()> hurried)
    : folder_(&folder),
      options_(options),
      reporter_(&reporter),
      hurried_(std::move(hurried)),
      backoff_(options.storage_patience),
      next_series_(series_interval(0.0)) {}

void JobWriter::resumed_at(std::uint64_t step) {
  checkpoint_step_ = step;
  checkpoint_at_ = clock_.seconds();
}

void JobWriter::checkpoint_when_due(const Simulation& simulation) {
  if (checkpoint_due(simulation)) checkpoint_soon(simulation);
}

void JobWriter::checkpoint_soon(const Simulation& simulation) {
  const double now = clock_.seconds();
  if (backoff_.waiting(now) || checkpoint_step_ == simulation.solver().step_count()) return;
  try {
    storing([&] { try_checkpoint(simulation); });
    backoff_.succeeded();
  } catch (const StorageError& error) {
    backoff_.failed(now);
    if (backoff_.exhausted() || !may_pass(error.fault())) throw;
    warn("a checkpoint", error, backoff_.next_try() - now);
  }
}

void JobWriter::checkpoint_surely(const Simulation& simulation) {
  if (checkpoint_step_ == simulation.solver().step_count()) return;
  persist("the checkpoint", [&] { try_checkpoint(simulation); });
}

void JobWriter::try_checkpoint(const Simulation& simulation) {
  if (const auto broken = simulation.violation()) {
    reporter_->event(warning_event("no checkpoint from this state: " + broken->text()));
    return;
  }
  write_checkpoint(simulation);
}

void JobWriter::write_checkpoint(const Simulation& simulation) {
  const double start = clock_.seconds();
  const auto path = folder_->write_checkpoint(simulation.checkpoint());
  const double end = clock_.seconds();
  checkpoint_step_ = simulation.solver().step_count();
  checkpoint_at_ = end;
  reporter_->event(checkpoint_event(simulation, path, end - start));
  for (const std::string& reason : folder_->prune()) reporter_->event(warning_event(reason));
  checkpoint_cost_ = clock_.seconds() - start;
  checkpoint_seconds_ += checkpoint_cost_;
  ++checkpoints_;
}

bool JobWriter::checkpoint_due(const Simulation& simulation) const {
  switch (options_.checkpoints) {
    case CheckpointPolicy::by_cost:
      return !checkpoint_at_ ||
             clock_.seconds() - *checkpoint_at_ >= checkpoint_interval(checkpoint_cost_);
    case CheckpointPolicy::every_steps:
      return simulation.solver().step_count() % options_.checkpoint_steps == 0;
    case CheckpointPolicy::at_end_only:
      return false;
  }
  return false;
}

void JobWriter::write_due_snapshot(Simulation& simulation) {
  const auto index = simulation.due_snapshot();
  if (!index) return;
  const double start = clock_.seconds();
  const Snapshot frame = make_snapshot(simulation.solver().state(), simulation.scene().method);
  const auto path = folder_->paths().frame(*index);
  persist("a frame", [&] {
    folder_->require_held();
    std::filesystem::create_directory(path.parent_path());
    write_snapshot(path, frame);
  });
  simulation.snapshot_written();
  output_seconds_ += clock_.seconds() - start;
}

void JobWriter::refresh_series(const Simulation& simulation) {
  const double start = clock_.seconds();
  if (simulation.samples().empty() || start < next_series_) return;
  try {
    storing([&] {
      folder_->require_held();
      write_series(folder_->paths().series(), simulation.samples());
    });
  } catch (const StorageError& error) {
    if (!may_pass(error.fault())) throw;
    warn("series.h5", error, 10.0);
    next_series_ = start + 10.0;
    return;
  }
  const double end = clock_.seconds();
  output_seconds_ += end - start;
  next_series_ = end + series_interval(end - start);
}

void JobWriter::finish_series(const Simulation& simulation) {
  if (simulation.samples().empty()) return;
  const double start = clock_.seconds();
  persist("series.h5", [&] {
    folder_->require_held();
    write_series(folder_->paths().series(), simulation.samples(), Durability::power_cut);
  });
  output_seconds_ += clock_.seconds() - start;
}

void JobWriter::write_outcome(const Outcome& outcome) {
  const double patience =
      outcome.exit_code == ExitCode::storage_failure ? 0.0 : options_.storage_patience;
  insist(
      patience,
      [&] { folder_->publish_text(folder_->paths().outcome(), to_json(outcome).dump(2) + "\n"); },
      [&](const StorageError& error, double wait) { warn("outcome.json", error, wait); },
      [&] { return is_hurried(); });
}

bool JobWriter::is_hurried() const { return hurried_ && checkpoint_step_ && hurried_(); }

std::optional<std::filesystem::path> JobWriter::whole_checkpoint() const {
  if (!checkpoint_step_) return {};
  const auto path = folder_->paths().checkpoint(*checkpoint_step_);
  try {
    folder_->require_held();
    verify(path);
    return path;
  } catch (const StorageError&) {
    return {};
  }
}

std::optional<double> JobWriter::checkpoint_age() const {
  if (!checkpoint_at_) return {};
  return clock_.seconds() - *checkpoint_at_;
}

void JobWriter::account(Account& account) const {
  account.checkpoint_seconds = checkpoint_seconds_;
  account.output_seconds = output_seconds_;
  account.checkpoints = checkpoints_;
}

void JobWriter::persist(std::string_view what, const std::function<void()>& write) {
  insist(
      options_.storage_patience, write,
      [&](const StorageError& error, double wait) { warn(what, error, wait); },
      [&] { return is_hurried(); });
}

void JobWriter::warn(std::string_view what, const StorageError& error, double wait) {
  reporter_->event(not_written_event(what, told_outside(folder_->name(), error), wait));
}

}  // namespace sluice

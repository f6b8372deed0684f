#include "engine/run/run_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/run/build_id.hpp"
#include "engine/run/events.hpp"
#include "engine/run/insist.hpp"
#include "engine/run/job_writer.hpp"
#include "engine/run/machine_name.hpp"
#include "engine/run/removal_news.hpp"
#include "engine/run/signals.hpp"
#include "engine/run/simulation.hpp"
#include "engine/run/stopwatch.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/digest.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// One attempt at a job, from its first step to its last.
class RunLoop {
 public:
  RunLoop(JobFolder& folder, const RunOptions& options, SignalRequests& signals, Reporter& reporter,
          Simulation& simulation)
      : folder_(&folder),
        options_(options),
        signals_(&signals),
        reporter_(&reporter),
        simulation_(&simulation),
        writer_(folder, options, reporter, [&signals] { return signals.stop_requested(); }),
        removals_(simulation),
        first_step_(simulation.solver().step_count()),
        first_time_(simulation.solver().time()) {}

  void resumed_at(std::uint64_t step) { writer_.resumed_at(step); }

  /// Steps until the end or a stop and leaves everything on disk. Never throws for a numerical or
  /// a storage failure: they are outcomes.
  Outcome run() {
    Outcome outcome = attempt();
    try {
      writer_.write_outcome(outcome);
    } catch (const StorageError& inside) {
      const StorageError error = told_outside(folder_->name(), inside);
      reporter_->event(warning_event(error.what()));
      // Who only reads files does not learn that it is complete: run again, it says so at once.
      if (outcome.exit_code == ExitCode::done) {
        return describe(ExitCode::storage_failure, error.what());
      }
    }
    return outcome;
  }

 private:
  Outcome attempt() {
    try {
      advance_to_end();
      writer_.checkpoint_surely(*simulation_);
      writer_.finish_series(*simulation_);
      return describe(simulation_->finished() ? ExitCode::done : ExitCode::checkpointed,
                      simulation_->finished() ? "" : stop_reason_);
    } catch (const NumericalFailure& failure) {
      return fail(failure);
    } catch (const StorageError& error) {
      return stopped_before_the_disk(told_outside(folder_->name(), error));
    }
  }

  /// One who asked for a stop gets it, also where the disk refuses: what is lost is lost at any
  /// end, and the run goes on from the checkpoint before.
  Outcome stopped_before_the_disk(const StorageError& error) const {
    Outcome outcome = describe(ExitCode::storage_failure, error.what());
    if (!signals_->stop_requested() || !may_pass(error.fault())) return outcome;
    if (const auto checkpoint = writer_.whole_checkpoint()) {
      outcome.exit_code = ExitCode::checkpointed;
      outcome.reason =
          fmt::format("stopped by a signal while the disk refused to write; it resumes from {}: {}",
                      checkpoint->filename().string(), error.what());
    }
    return outcome;
  }

  void advance_to_end() {
    rate_.add(0.0, first_time_, first_step_, 0);
    writer_.write_due_snapshot(*simulation_);
    writer_.checkpoint_when_due(*simulation_);
    while (!simulation_->finished() && !stop_asked()) {
      simulation_->step();
      writer_.write_due_snapshot(*simulation_);
      report();
      writer_.checkpoint_when_due(*simulation_);
      writer_.refresh_series(*simulation_);
    }
  }

  bool stop_asked() {
    const RunRequest request = signals_->take();
    if (request == RunRequest::checkpoint) writer_.checkpoint_soon(*simulation_);
    if (request == RunRequest::stop) stop_reason_ = "stopped by a signal";
    const bool enough =
        options_.stop_after_step && simulation_->solver().step_count() >= *options_.stop_after_step;
    if (enough) stop_reason_ = "stopped after the step asked for";
    return enough || request == RunRequest::stop;
  }

  void report() {
    removals_.tell(*simulation_, *reporter_);
    for (const Diagnosis& warning : simulation_->take_warnings()) {
      reporter_->event(warning_event(warning));
    }
    const double now = clock_.seconds();
    if (now < next_report_) return;
    next_report_ = now + 1.0;
    const Solver& solver = simulation_->solver();
    rate_.add(now, solver.time(), solver.step_count(), simulation_->particle_steps());
    reporter_->progress(progress(now));
  }

  Progress progress(double now) const {
    const Solver& solver = simulation_->solver();
    Progress progress;
    progress.step = solver.step_count();
    progress.time = solver.time();
    progress.end_time = simulation_->scene().end_time;
    progress.time_step = solver.time_step();
    progress.step_limit = solver.step_limit();
    progress.particles = solver.particle_count();
    progress.overtopped = simulation_->overtopped();
    progress.leaked = simulation_->leaked();
    progress.excluded = simulation_->excluded();
    progress.max_speed = solver.extremes().max_speed;
    progress.elapsed = now;
    progress.checkpoint_age = writer_.checkpoint_age();
    progress.rate = rate_.rate();
    return progress;
  }

  /// The samples up to the failure help to understand it; the checkpoints stay as they are.
  Outcome fail(const NumericalFailure& failure) {
    removals_.tell(*simulation_, *reporter_);
    try {
      writer_.finish_series(*simulation_);
    } catch (const StorageError& error) {
      reporter_->event(warning_event(told_outside(folder_->name(), error).what()));
    }
    Outcome outcome = describe(ExitCode::numerical_failure, failure.what());
    outcome.diagnosis = failure.diagnosis();
    return outcome;
  }

  Outcome describe(ExitCode code, std::string reason) const {
    Outcome outcome = describe_simulation(*simulation_);
    outcome.exit_code = code;
    outcome.reason = std::move(reason);
    outcome.account.seconds = clock_.seconds();
    outcome.account.core_seconds = core_clock_.seconds();
    outcome.account.steps = simulation_->solver().step_count() - first_step_;
    writer_.account(outcome.account);
    if (code == ExitCode::done || code == ExitCode::checkpointed) {
      outcome.physics_digest = physics_digest(simulation_->checkpoint());
    }
    return outcome;
  }

  JobFolder* folder_;
  RunOptions options_;
  SignalRequests* signals_;
  Reporter* reporter_;
  Simulation* simulation_;
  Stopwatch clock_;
  CoreStopwatch core_clock_;
  JobWriter writer_;
  RemovalNews removals_;
  RateMeter rate_;
  std::uint64_t first_step_;
  double first_time_;
  double next_report_ = 1.0;
  std::string stop_reason_;
};

/// A scene whose first state violates a guard has no simulation to describe.
Outcome failed_at_start(JobFolder& folder, const Scene& scene, const NumericalFailure& failure) {
  Outcome outcome;
  outcome.exit_code = ExitCode::numerical_failure;
  outcome.reason = failure.what();
  outcome.diagnosis = failure.diagnosis();
  outcome.build = build_id();
  outcome.machine = machine_name();
  outcome.end_time = scene.end_time;
  folder.publish_text(folder.paths().outcome(), to_json(outcome).dump(2) + "\n");
  return outcome;
}

Outcome run_from_scene(JobFolder& folder, const Scene& scene, const RunOptions& options,
                       SignalRequests& signals, Reporter& reporter) {
  try {
    Simulation simulation(scene, options.execution);
    reporter.event(started_event(simulation, folder));
    if (simulation.packing()) reporter.event(packed_event(simulation));
    return RunLoop(folder, options, signals, reporter, simulation).run();
  } catch (const NumericalFailure& failure) {
    return failed_at_start(folder, scene, failure);
  }
}

Outcome run_from_checkpoint(JobFolder& folder, const Scene& scene, const RunOptions& options,
                            SignalRequests& signals, Reporter& reporter, Restored restored) {
  for (const std::string& reason : restored.rejected) reporter.event(warning_event(reason));
  Simulation simulation(scene, options.execution, std::move(restored.checkpoint));
  reporter.event(resumed_event(simulation, folder, restored.path));
  RunLoop loop(folder, options, signals, reporter, simulation);
  loop.resumed_at(simulation.solver().step_count());
  return loop.run();
}

/// Without a checkpoint to go on from there is no attempt, but those who read events must hear of
/// it.
std::optional<Restored> find_checkpoint(JobFolder& folder, const Scene& scene, Reporter& reporter) {
  try {
    return folder.newest_checkpoint(identity_of(scene));
  } catch (const StorageError& inside) {
    const StorageError error = told_outside(folder.name(), inside);
    reporter.event(refused_event(error));
    throw error;
  }
}

}  // namespace

Outcome run_job(JobFolder& folder, const Scene& scene, const RunOptions& options,
                Reporter& reporter) {
  // Before the first event and until after the last, so that no signal that answers one is lost.
  SignalRequests signals;
  signals.empty_when_ended_at_once(folder.lock());
  LoggingReporter logging(reporter, folder.paths().log());
  std::optional<Restored> restored = find_checkpoint(folder, scene, logging);
  // An outcome of an earlier attempt says nothing about this one.
  std::error_code ignored;
  std::filesystem::remove(folder.paths().outcome(), ignored);
  Outcome outcome =
      restored ? run_from_checkpoint(folder, scene, options, signals, logging, *std::move(restored))
               : run_from_scene(folder, scene, options, signals, logging);
  logging.event(ended_event(outcome));
  return outcome;
}

}  // namespace sluice

#include <fmt/format.h>

#include "engine/run/exit_code.hpp"
#include "engine/scene/canonical.hpp"
#include "engine/store/job_folder.hpp"
#include "engine/study/report.hpp"
#include "engine/study/study_result.hpp"

namespace sluice {
namespace {

void add_quantity(StudyRow& row, const std::string& name, const std::optional<double>& value) {
  if (value) row.quantities.emplace_back(name, *value);
}

/// Means over stretches of time, which the chaos after an impact leaves defined; peaks are not.
void take_evidence(StudyRow& row, const Evidence& evidence) {
  for (const PressureEvidence& one : evidence.pressures) {
    if (one.relative_l2) row.sensor_errors.emplace_back(one.sensor, *one.relative_l2);
    add_quantity(row, one.sensor + " impulse", one.simulation.impulse);
    add_quantity(row, one.sensor + " plateau", one.simulation.plateau);
  }
  if (evidence.front) add_quantity(row, "front delay", evidence.front->delay);
}

void take_series(StudyRow& row, const SeriesEvidence& evidence) {
  for (const CurveEvidence& one : evidence.curves) {
    if (one.relative_l2) row.sensor_errors.emplace_back(one.sensor, *one.relative_l2);
    if (one.simulated_peak) add_quantity(row, one.sensor + " highest", one.simulated_peak->value);
  }
}

void take_report(StudyRow& row, const Report& report) {
  const RunFacts& facts = report.facts;
  row.error = report.error();
  row.core_seconds = facts.core_seconds;
  row.particle_steps_per_second = facts.particle_steps_per_second;
  row.steps = facts.step;
  row.machine = facts.machine;
  row.simd_target = facts.simd_target;
  if (facts.particles) {
    row.particles = *facts.particles + facts.overtopped.value_or(0) + facts.leaked.value_or(0);
  }
  if (report.evidence) take_evidence(row, *report.evidence);
  if (report.series_evidence) take_series(row, *report.series_evidence);
}

/// Only a failure of the numbers would come again; another one may pass.
RunState state_of(const RunFacts& facts, const nlohmann::ordered_json& outcome) {
  if (facts.state == "completed") return RunState::completed;
  const auto code = outcome.find("exit_code");
  const bool numerical = code != outcome.end() && code->is_number_integer() &&
                         *code == static_cast<int>(ExitCode::numerical_failure);
  return numerical ? RunState::failed : RunState::stopped;
}

}  // namespace

std::string_view to_string(RunState state) {
  switch (state) {
    case RunState::waiting:
      return "waiting";
    case RunState::stopped:
      return "stopped";
    case RunState::completed:
      return "completed";
    case RunState::failed:
      return "failed";
  }
  return "?";
}

StudyRow read_row(const std::filesystem::path& folder, const StudyRun& run) {
  StudyRow row;
  if (!JobFolder::holds_job(folder)) return row;
  row.state = RunState::stopped;
  try {
    const auto outcome = read_outcome(folder);
    if (outcome.is_object()) {
      const RunFacts facts = run_facts(outcome);
      row.state = state_of(facts, outcome);
      row.reason = facts.reason;
    }
    // A finished run of another scene, or to an earlier end, is not this run.
    if (canonical_text(read_job_scene(folder)) != canonical_text(run.scene)) {
      row.state = RunState::stopped;
      row.reason = "the study has changed since this run";
    }
    if (row.state != RunState::completed) return row;
    const JobRecord job = read_job(folder);
    take_report(row, make_report(job.scene, job.series, job.outcome));
    if (row.error) return row;
    row.reason = "no error: its scene has no reference, or its sensors are not there";
  } catch (const std::exception& error) {
    row.state = RunState::stopped;
    row.reason = error.what();
  }
  return row;
}

}  // namespace sluice

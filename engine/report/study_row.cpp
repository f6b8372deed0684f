#include "engine/report/study_row.hpp"

#include "engine/report/report.hpp"
#include "engine/run/exit_code.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/read/job_reader.hpp"
#include "engine/study/report_row.hpp"

namespace sluice {
namespace {

/// Only a failure of the numbers would come again; another one may pass.
RunState state_of(const RunFacts& facts, const nlohmann::ordered_json& outcome) {
  if (facts.state == "completed") return RunState::completed;
  const auto code = outcome.find("exit_code");
  const bool numerical = code != outcome.end() && code->is_number_integer() &&
                         *code == static_cast<int>(ExitCode::numerical_failure);
  return numerical ? RunState::failed : RunState::stopped;
}

}  // namespace

StudyRow read_row(const std::filesystem::path& folder, const StudyRun& run) {
  StudyRow row;
  if (!JobFolder::holds_job(folder)) return row;
  row.state = RunState::stopped;
  try {
    const JobReader job(folder);
    const auto outcome = job.outcome();
    if (outcome.is_object()) {
      const RunFacts facts = run_facts(outcome);
      row.state = state_of(facts, outcome);
      row.reason = facts.reason;
    }
    // A finished run of another scene, or to an earlier end, is not this run.
    if (canonical_text(job.scene()) != canonical_text(run.scene)) {
      row.state = RunState::stopped;
      row.reason = "the study has changed since this run";
    }
    if (row.state != RunState::completed) return row;
    const JobRecord record = job.record();
    return row_of_report(report_json(make_report(record.scene, record.series, record.outcome)));
  } catch (const std::exception& error) {
    row.state = RunState::stopped;
    row.reason = error.what();
  }
  return row;
}

}  // namespace sluice

#include "service/api/study_view.hpp"

#include <fmt/format.h>

#include "engine/scene/format/canonical.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/digest.hpp"
#include "engine/study/report_row.hpp"
#include "engine/study/study_output.hpp"
#include "service/api/study_jobs.hpp"
#include "service/jobs/job_json.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

StudyRow unfinished(RunState state, const std::string& reason) {
  StudyRow row;
  row.state = state;
  row.reason = reason;
  return row;
}

StudyRow completed_row(const std::string& report) {
  const Json document = stored_json(report);
  if (document.is_object()) return row_of_report(document);
  return unfinished(RunState::stopped, "its report cannot be read");
}

StudyRow row_of_kept(const StudyStore& studies, const StudyRecord& record, const StudyRun& run) {
  if (record.stage == StudyRecord::Stage::making) {
    return unfinished(RunState::waiting, "its job is not made yet");
  }
  const auto kept = studies.kept_run(record.id, run.name);
  if (!kept) return unfinished(RunState::stopped, "its job was deleted");
  if (kept->state == "completed" && !kept->report.empty()) return completed_row(kept->report);
  return unfinished(kept->state == "failed" ? RunState::failed : RunState::stopped,
                    fmt::format("its job was deleted when it was {}{}{}", kept->state,
                                kept->reason.empty() ? "" : ": ", kept->reason));
}

std::string report_text(const ApiContext& context, const std::string& id) {
  try {
    return read_text(context.paths(id).report(), JobPaths::kLargestReport, Links::refuse);
  } catch (const StorageError&) {
    return {};
  }
}

StudyRow row_of_job(const ApiContext& context, const Job& job, const StudyRun& run) {
  switch (job.state) {
    case JobState::queued:
      return unfinished(RunState::waiting, context.scheduler.why_waiting(job));
    case JobState::running:
      return unfinished(RunState::running, "");
    case JobState::paused:
      return unfinished(RunState::stopped,
                        fmt::format("paused{}{}", job.reason.empty() ? "" : ": ", job.reason));
    case JobState::cancelled:
      return unfinished(RunState::stopped, "cancelled");
    case JobState::failed:
      return unfinished(RunState::failed, job.reason);
    case JobState::completed:
      break;
  }
  if (job.end_time != run.scene.end_time) {
    return unfinished(RunState::stopped, "it was given a later end: its result is of another run");
  }
  return completed_row(report_text(context, job.id));
}

Json counts_json(const std::vector<std::pair<JobState, std::size_t>>& counts) {
  Json object = Json::object();
  for (const JobState state : {JobState::queued, JobState::running, JobState::paused,
                               JobState::completed, JobState::failed, JobState::cancelled}) {
    object[to_string(state)] = 0;
  }
  for (const auto& [state, count] : counts) object[to_string(state)] = count;
  return object;
}

Json summary_of(const StudyRecord& record,
                const std::vector<std::pair<JobState, std::size_t>>& counts) {
  bool open = record.stage == StudyRecord::Stage::making;
  for (const auto& [state, count] : counts) open = open || (!is_ended(state) && count > 0);
  return Json{{"id", record.id},
              {"name", record.name},
              {"state", open ? "open" : "ended"},
              {"created_at", time_json(record.created_ms)},
              {"priority", record.priority},
              {"run_count", record.runs},
              {"jobs", counts_json(counts)}};
}

Json links_of(const std::string& id) {
  const std::string self = fmt::format("/v1/studies/{}", id);
  Json links{{"self", self}, {"jobs", fmt::format("/v1/jobs?label={}", id)}};
  for (const char* const format : {"markdown", "csv", "svg"}) {
    links[format] = fmt::format("{}?format={}", self, format);
  }
  return links;
}

/// Share of the model time that is behind a job; null before its first line.
Json progress_of(const Job& job) {
  const Json progress = stored_json(job.progress);
  return progress.is_object() ? progress.value("fraction", Json(nullptr)) : Json(nullptr);
}

void add_jobs(Json& runs, const StudyView& view) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::optional<Job>& job = view.jobs[k];
    runs[k]["job"] = job ? Json(job->id) : Json(nullptr);
    runs[k]["job_state"] = job ? Json(to_string(job->state)) : Json(nullptr);
    runs[k]["progress"] = job ? progress_of(*job) : Json(nullptr);
  }
}

}  // namespace

StudyView view_study(const ApiContext& context, const StudyRecord& record) {
  StudyPlan plan = plan_of_study(context.studies, record);
  auto jobs = jobs_of_study(context.store, record);
  StudyView view{record, {}, {}};
  std::vector<StudyRow> rows;
  for (const StudyRun& run : plan.runs) {
    const auto found = jobs.find(run.name);
    if (found == jobs.end()) {
      rows.push_back(row_of_kept(context.studies, record, run));
      view.jobs.emplace_back();
    } else {
      rows.push_back(row_of_job(context, found->second, run));
      view.jobs.emplace_back(std::move(found->second));
    }
  }
  view.result = evaluate(plan.study, std::move(plan.runs), std::move(rows));
  return view;
}

Json study_summary(const ApiContext& context, const StudyRecord& record) {
  return summary_of(record, context.store.count_by_state(record.id));
}

Json study_document(const ApiContext& context, const StudyView& view) {
  Json document = study_summary(context, view.record);
  document["links"] = links_of(view.record.id);
  Json result = study_json(view.result);
  add_jobs(result["runs"], view);
  result.erase("study");
  document.update(result);
  return document;
}

}  // namespace sluice

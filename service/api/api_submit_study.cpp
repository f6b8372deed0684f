#include <fmt/format.h>

#include <string>

#include "service/api/api_routes.hpp"
#include "service/api/study_jobs.hpp"
#include "service/api/study_view.hpp"
#include "service/api/submission.hpp"
#include "service/http/query.hpp"
#include "service/jobs/admission.hpp"
#include "service/jobs/job_ids.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// What stands in the query and the headers beside the study.
struct StudyOptions {
  bool dry_run = false;
  int priority = 0;
  std::string key;
};

StudyOptions read_study_options(const Request& request) {
  QueryReader query(request);
  StudyOptions options;
  options.dry_run = query.flag("dry_run");
  options.priority = query.integer("priority", -1000, 1000).value_or(0);
  query.finish();
  options.key = read_key(request);
  return options;
}

Response accepted(const ApiContext& context, const StudyRecord& study, bool repeated) {
  return accepted_response(fmt::format("/v1/studies/{}", study.id),
                           study_document(context, view_study(context, study)), repeated);
}

/// What every run and all together would take; nothing is changed.
Response show_plan(const StudyPlan& plan) {
  Json runs = Json::array();
  double core_seconds = 0.0;
  std::uint64_t disk = 0;
  for (const StudyRun& run : plan.runs) {
    const Estimate size = estimate(run.scene);
    Json document = estimate_document(run.scene, size, 1);
    core_seconds += document["seconds"].get<double>();
    disk += size.disk_bytes;
    runs.push_back({{"run", run.name},
                    {"setup", run.setup},
                    {"estimate", std::move(document)},
                    {"warnings", problem_list(run.warnings)}});
  }
  return json_response(200, {{"name", plan.study.name},
                             {"run_count", plan.runs.size()},
                             {"core_seconds", core_seconds},
                             {"disk_bytes", disk},
                             {"runs", std::move(runs)}});
}

/// The folder of the study comes first: with it, the next start can make what a crash left undone.
StudyRecord make_study(ApiContext& context, const Request& request, const StudyOptions& options,
                       const std::string& hash) {
  const StudyPlan plan = admit_study(request.body, context.scheduler.limits());
  StudyRecord study;
  study.id = study_id_of(context.store.new_id());
  study.name = plan.study.name;
  study.runs = plan.runs.size();
  study.priority = options.priority;
  study.created_ms = unix_time_ms();
  study.key = options.key;
  study.body_hash = hash;
  context.studies.add(study, request.body);
  try {
    make_study_jobs(context, study, plan);
  } catch (const JobStoreError& error) {
    if (error.fault() != JobStoreError::Fault::uncertain) context.studies.remove(study.id);
    throw;
  } catch (...) {
    context.studies.remove(study.id);
    throw;
  }
  return study;
}

}  // namespace

Response submit_study(ApiContext& context, const RouteRequest& request) {
  require_json(request.http, "a study");
  const StudyOptions options = read_study_options(request.http);
  if (options.dry_run) {
    return show_plan(admit_study(request.http.body, context.scheduler.limits()));
  }
  const std::string hash =
      options.key.empty() ? "" : request_hash(request.http, fmt::format("{}\n", options.priority));
  const std::scoped_lock one_at_a_time(context.study_changes);
  if (const auto known = context.studies.find_by_key(options.key)) {
    if (known->body_hash == hash) return accepted(context, *known, true);
    throw ApiError(
        ProblemType::key_reused,
        fmt::format("this Idempotency-Key came with another request before and made study "
                    "{}; take a new key for a new study",
                    known->id));
  }
  const StudyRecord study = make_study(context, request.http, options, hash);
  return accepted(context, find_study(context, study.id), false);
}

}  // namespace sluice

#include <fmt/format.h>

#include "engine/scene/forecast/plan.hpp"
#include "service/api/api_routes.hpp"
#include "service/api/submission.hpp"
#include "service/http/query.hpp"
#include "service/jobs/admission.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/job_json.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestLabel = 100;

/// What stands in the query and the headers beside the scene.
struct JobOptions {
  bool dry_run = false;
  std::string label;
  int priority = 0;
  int threads = 1;
  std::string key;
};

JobOptions read_job_options(const ApiContext& context, const Request& request) {
  QueryReader query(request);
  JobOptions options;
  options.dry_run = query.flag("dry_run");
  options.label = query.text("label", kLongestLabel).value_or("");
  options.priority = query.integer("priority", -1000, 1000).value_or(0);
  options.threads =
      query.integer("threads", 1, thread_limit(context.scheduler.limits())).value_or(1);
  if (is_study_id(options.label)) {
    query.reject("label", "has the form of a study's id, which its own jobs bear");
  }
  query.finish();
  options.key = read_key(request);
  return options;
}

std::string hash_of(const SubmittedScene& scene, const JobOptions& options) {
  return request_hash(
      scene, fmt::format("{}\n{}\n{}\n", options.label, options.priority, options.threads));
}

Admitted admit_submission(const SubmittedScene& scene, const ServiceLimits& limits) {
  Admitted admitted = admit_scene(scene.text, limits, scene.parts);
  require_named(scene, admitted.parts);
  return admitted;
}

/// The job, and what may not have been meant in its scene.
Response accepted(const ApiContext& context, const Job& job, bool repeated,
                  const std::vector<Problem>& warnings) {
  Json document = document_of(context, job);
  document["warnings"] = problem_list(warnings);
  return accepted_response(fmt::format("/v1/jobs/{}", job.id), document, repeated);
}

Job new_job(ApiContext& context, const Admitted& admitted, const JobOptions& options) {
  Job job;
  job.id = context.store.new_id();
  job.label = options.label;
  job.priority = options.priority;
  job.threads = options.threads;
  job.created_ms = unix_time_ms();
  describe_scene(job, admitted.scene, admitted.estimate);
  return job;
}

Response make_job(ApiContext& context, const SubmittedScene& scene, const JobOptions& options) {
  const ServiceLimits& limits = context.scheduler.limits();
  const Admitted admitted = admit_submission(scene, limits);
  const std::string hash = options.key.empty() ? "" : hash_of(scene, options);
  const Job job = new_job(context, admitted, options);
  // The folder comes first: a row without its folder could not run, a folder without its row is
  // found at the next start.
  NewFolder folder(context.paths(job.id), admitted.text,
                   {job.label, job.priority, job.threads, job.created_ms, options.key, hash, {}},
                   admitted.parts);
  const auto submitted = keeping_if_uncertain(
      folder, [&] { return context.store.submit(job, options.key, hash, limits.queued_jobs); });
  if (!submitted.repeated) folder.keep();
  context.scheduler.poke();
  return accepted(context, submitted.job, submitted.repeated, admitted.warnings);
}

Response show_plan(const ApiContext& context, const SubmittedScene& scene,
                   const JobOptions& options) {
  const Admitted admitted = admit_submission(scene, context.scheduler.limits());
  return json_response(
      200, {{"plan", Json::parse(plan_json(plan(admitted.scene)))},
            {"estimate", estimate_document(admitted.scene, admitted.estimate, options.threads)},
            {"warnings", problem_list(admitted.warnings)}});
}

}  // namespace

Response submit_job(ApiContext& context, const RouteRequest& request) {
  const SubmittedScene scene = read_submission(request.http);
  const JobOptions options = read_job_options(context, request.http);
  if (options.dry_run) return show_plan(context, scene, options);
  if (options.key.empty()) return make_job(context, scene, options);

  const std::scoped_lock one_at_a_time(context.keyed_submits);
  if (const auto known = context.store.find_by_key(options.key, hash_of(scene, options))) {
    return accepted(context, *known, true, parse_scene(scene.text, scene.parts).warnings);
  }
  return make_job(context, scene, options);
}

}  // namespace sluice

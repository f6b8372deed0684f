#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/errors.hpp"
#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"
#include "service/jobs/admission.hpp"
#include "service/jobs/job_json.hpp"
#include "service/jobs/repair.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// 202 while a running worker has yet to obey.
Response answer(const ApiContext& context, const Job& job) {
  const bool pending = job.pending_stop != PendingStop::none;
  return json_response(pending ? 202 : 200, document_of(context, job));
}

Response act(ApiContext& context, const std::string& id, JobAction action,
             const JobChange& change) {
  const Job job = context.store.apply(id, action, "", change);
  context.scheduler.poke();
  return answer(context, job);
}

Response act(ApiContext& context, const RouteRequest& request, JobAction action) {
  QueryReader(request.http).finish();
  if (!request.http.body.empty()) {
    throw ApiError(ProblemType::bad_request, "this request has no body");
  }
  const Job job = find_job(context, request.parts[0]);
  return act(context, job.id, action, {});
}

[[noreturn]] void refuse_body(std::string_view pointer, const std::string& detail) {
  throw ApiError(ProblemType::bad_request, fmt::format("{}: {}", pointer, detail),
                 {{"errors", Json::array({{{"pointer", pointer}, {"detail", detail}}})}});
}

/// The end time of a resume, s; nothing when the body is empty or an empty object.
std::optional<double> read_end_time(const std::string& body) {
  if (body.empty()) return std::nullopt;
  Problems problems;
  const auto value = read_json(body, problems);
  if (!value || !problems.empty()) {
    const auto found = problems.take();
    refuse_body("", found.empty() ? "is no JSON" : found.front().message);
  }
  if (!value->is_object()) refuse_body("", "must be an object, such as {\"end_time\": 3.0}");
  std::optional<double> end_time;
  for (const auto& [key, member] : value->items()) {
    if (key != "end_time") refuse_body(at("", key), "is unknown: allowed here: end_time");
    if (!member.is_number() || !std::isfinite(member.get<double>())) {
      refuse_body("/end_time", "must be a number of seconds");
    }
    end_time = member.get<double>();
  }
  return end_time;
}

/// What an extension replaces, and with what.
struct Extension {
  std::string scene_before;
  std::string estimate;
};

/// Writes the later end time into the job's scene, checked as a submitted one is. The folder is
/// free again afterwards: a worker needs it as soon as the job is queued.
Extension replace_end_time(const ApiContext& context, Job job, double end_time) {
  JobFolder folder = JobFolder::open(context.paths(job.id).root());
  std::string before = folder.scene_text();
  const std::string extended = with_end_time(before, end_time);
  const Admitted admitted = admit_job_scene(extended, context.scheduler.limits(),
                                            parts_in(folder.paths().root(), Links::refuse));
  describe_scene(job, admitted.scene, admitted.estimate);
  try {
    folder.publish_text(folder.paths().scene(), extended);
  } catch (const StorageError&) {
    // It may be in place, with only its name not surely on the disk.
    folder.publish_text(folder.paths().scene(), before);
    throw;
  }
  return {std::move(before), std::move(job.estimate)};
}

/// For one who is alone with the job: what it is when its scene is changed, it is until its row is.
Response extend(ApiContext& context, const Job& job, double end_time) {
  if (job.state == JobState::running || job.state == JobState::queued) {
    throw ApiError(ProblemType::wrong_state,
                   fmt::format("job {} is {}: its end time can be changed once it is paused or "
                               "has ended",
                               job.id, to_string(job.state)));
  }
  if (!(end_time > job.end_time)) {
    refuse_body("/end_time",
                fmt::format("must be later than the job's end time, {} s", shortest(job.end_time)));
  }
  const Extension extension = replace_end_time(context, job, end_time);
  JobChange change;
  change.end_time = end_time;
  change.estimate = extension.estimate;
  change.event_detail = Json{{"end_time", end_time}}.dump();
  try {
    return answer(context, context.store.apply(job.id, JobAction::resume, "", change));
  } catch (const JobStoreError& error) {
    if (error.fault() == JobStoreError::Fault::uncertain) throw;
    JobFolder folder = JobFolder::open(context.paths(job.id).root());
    folder.publish_text(folder.paths().scene(), extension.scene_before);
    throw;
  }
}

}  // namespace

Response cancel_job(ApiContext& context, const RouteRequest& request) {
  return act(context, request, JobAction::cancel);
}

Response pause_job(ApiContext& context, const RouteRequest& request) {
  return act(context, request, JobAction::pause);
}

Response resume_job(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const auto end_time = read_end_time(request.http.body);
  (void)find_job(context, request.parts[0]);
  const auto alone = context.store.alone_with(request.parts[0]);
  const Job job = find_job(context, request.parts[0]);
  // A cancelled job goes on to its own end, also when that is named.
  const bool same_end = job.state == JobState::cancelled && end_time == job.end_time;
  if (!end_time || same_end) return act(context, job.id, JobAction::resume, {});
  Response response = extend(context, job, *end_time);
  context.scheduler.poke();
  return response;
}

Response checkpoint_job(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const Job job = find_job(context, request.parts[0]);
  if (!context.scheduler.checkpoint_now(job.id)) {
    throw ApiError(ProblemType::wrong_state,
                   fmt::format("job {} is {}: only a running job can write a checkpoint", job.id,
                               to_string(job.state)));
  }
  return json_response(202, document_of(context, job));
}

}  // namespace sluice

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "engine/study/study_output.hpp"
#include "service/api/api_routes.hpp"
#include "service/api/study_jobs.hpp"
#include "service/api/study_view.hpp"
#include "service/http/query.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/retention.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kStudyFormats{"json", "markdown", "csv", "svg"};

Response svg_response(const StudyResult& result) {
  Response response =
      text_response(chart_svg(study_chart(result), SvgPlace::file), "image/svg+xml");
  // The picture needs no script and no other address, so none gets through.
  response.headers.emplace_back("Content-Security-Policy",
                                "default-src 'none'; style-src 'unsafe-inline'");
  return response;
}

/// False when the job ended or went meanwhile.
bool try_to_cancel(JobStore& store, const std::string& id) {
  try {
    return store.apply(id, JobAction::cancel, "", {}).state != JobState::cancelled;
  } catch (const JobStoreError& refusal) {
    const bool raced = refusal.fault() == JobStoreError::Fault::not_found ||
                       refusal.fault() == JobStoreError::Fault::conflict;
    if (!raced) throw;
    return false;
  }
}

void delete_if_there(ApiContext& context, const std::string& id) {
  try {
    delete_job(context.store, context.data, id);
  } catch (const JobStoreError& refusal) {
    if (refusal.fault() != JobStoreError::Fault::not_found) throw;
  }
}

}  // namespace

Response list_studies(ApiContext& context, const RouteRequest& request) {
  QueryReader query(request.http);
  const std::string after = query.text("cursor", 21).value_or("");
  if (!after.empty() && !is_study_id(after)) {
    query.reject("cursor", "must be the `next_cursor` of the page before");
  }
  const int limit = query.integer("limit", 1, 1000).value_or(50);
  query.finish();
  auto page = context.studies.list(after, static_cast<std::size_t>(limit) + 1);
  const bool more = page.size() > static_cast<std::size_t>(limit);
  if (more) page.pop_back();
  Json list = Json::array();
  for (const StudyRecord& study : page) list.push_back(study_summary(context, study));
  return json_response(200, {{"studies", std::move(list)},
                             {"next_cursor", more ? Json(page.back().id) : Json(nullptr)}});
}

Response show_study(ApiContext& context, const RouteRequest& request) {
  QueryReader query(request.http);
  const std::string format = query.word("format", kStudyFormats).value_or("json");
  query.finish();
  const StudyView view = view_study(context, find_study(context, request.parts[0]));
  if (format == "markdown") {
    return text_response(study_markdown(view.result), "text/markdown; charset=utf-8");
  }
  if (format == "csv") return text_response(study_csv(view.result), "text/csv; charset=utf-8");
  if (format == "svg") return svg_response(view.result);
  return json_response(200, study_document(context, view));
}

Response cancel_study(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  if (!request.http.body.empty()) {
    throw ApiError(ProblemType::bad_request, "this request has no body");
  }
  const std::scoped_lock one_at_a_time(context.study_changes);
  const StudyRecord study = find_study(context, request.parts[0]);
  bool pending = false;
  for (const auto& [run, job] : jobs_of_study(context.store, study)) {
    if (!is_ended(job.state) && try_to_cancel(context.store, job.id)) pending = true;
  }
  context.scheduler.poke();
  return json_response(pending ? 202 : 200, study_document(context, view_study(context, study)));
}

Response delete_study(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const std::scoped_lock one_at_a_time(context.study_changes);
  const StudyRecord study = find_study(context, request.parts[0]);
  const auto jobs = jobs_of_study(context.store, study);
  for (const auto& [run, job] : jobs) {
    if (is_ended(job.state)) continue;
    throw ApiError(ProblemType::wrong_state,
                   fmt::format("run {} of study {} is {}: only a study whose jobs have all ended "
                               "can be deleted; cancel it first",
                               run, study.id, to_string(job.state)));
  }
  for (const auto& [run, job] : jobs) delete_if_there(context, job.id);
  context.studies.remove(study.id);
  Response response;
  response.status = 204;
  response.content_type.clear();
  return response;
}

}  // namespace sluice

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "engine/store/disk/sha256.hpp"
#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/job_json.hpp"
#include "service/jobs/retention.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr double kLongestWait = 60.0;  // s

constexpr std::array<std::string_view, 6> kStates{"queued",    "running", "paused",
                                                  "completed", "failed",  "cancelled"};

std::string tag_of(const std::string& text) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(text)));
  return fmt::format("\"{}\"", hash.finish().substr(0, 24));
}

Response shown(const ApiContext& context, const Job& job) {
  Response response = json_response(200, document_of(context, job));
  response.headers.emplace_back("ETag", tag_of(response.body));
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

/// What a waiting client wants to be told of.
enum class News { state, progress };

bool differs(const Job& a, const Job& b, News news) {
  return a.state != b.state || a.pending_stop != b.pending_stop || a.attempts != b.attempts ||
         a.end_time != b.end_time || (news == News::progress && a.progress != b.progress);
}

/// Waits until there is news of the job, it has ended, or the time is over.
Job wait_for_change(ApiContext& context, Job job, double seconds, News news) {
  const auto place = context.waits.try_take();
  // Too many wait already: the answer as it is now is also an answer.
  if (!place) return job;
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  const Job before = job;
  while (!is_ended(job.state) && !differs(before, job, news) && !context.draining) {
    const double left = std::chrono::duration<double>(until - Clock::now()).count();
    if (left <= 0.0) break;
    context.store.wait_for_event(job.id, context.store.last_event(), std::min(left, kProgressLook));
    job = find_job(context, job.id);
  }
  return job;
}

}  // namespace

Response list_jobs(ApiContext& context, const RouteRequest& request) {
  QueryReader query(request.http);
  JobFilter filter;
  if (const auto state = query.word("state", kStates)) filter.state = job_state(*state);
  filter.label = query.text("label", 100);
  filter.after = query.text("cursor", 21).value_or("");
  if (!filter.after.empty() && !is_job_id(filter.after)) {
    query.reject("cursor", "must be the `next_cursor` of the page before");
  }
  const int limit = query.integer("limit", 1, 1000).value_or(50);
  query.finish();

  // One more than asked for tells whether there is another page.
  filter.limit = static_cast<std::size_t>(limit) + 1;
  std::vector<Job> jobs = context.store.list(filter);
  const bool more = jobs.size() == filter.limit;
  if (more) jobs.pop_back();
  Json list = Json::array();
  for (const Job& job : jobs) {
    list.push_back(job_summary(job, context.scheduler.why_waiting(job)));
  }
  return json_response(200, {{"jobs", std::move(list)},
                             {"next_cursor", more ? Json(jobs.back().id) : Json(nullptr)}});
}

Response show_job(ApiContext& context, const RouteRequest& request) {
  QueryReader query(request.http);
  const auto wait = query.number("wait", 0.0, kLongestWait);
  const News news = query.flag("progress") ? News::progress : News::state;
  query.finish();
  Job job = find_job(context, request.parts[0]);
  const std::string_view known = request.http.header("if-none-match");
  Response response = shown(context, job);
  const auto matches = [&] { return !known.empty() && known == response.headers.front().second; };
  // With the tag of what the client has, news that it missed is no reason to wait.
  if (wait && (known.empty() || matches())) {
    job = wait_for_change(context, std::move(job), *wait, news);
    response = shown(context, job);
  }
  if (matches()) {
    response.status = 304;
    response.body.clear();
    response.content_type.clear();
  }
  return response;
}

Response delete_job(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  delete_job(context.store, context.data, find_job(context, request.parts[0]).id);
  Response response;
  response.status = 204;
  response.content_type.clear();
  return response;
}

}  // namespace sluice

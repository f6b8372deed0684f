#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <memory>
#include <optional>

#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"
#include "service/jobs/job_json.hpp"

namespace sluice {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kHeartbeat{15};
constexpr std::size_t kBatch = 100;

/// One reader of a job's history, from an event on. Sends what there is, then what comes; progress
/// goes along without a number, because it is not kept.
class EventStream {
 public:
  EventStream(ApiContext& context, Job job, std::int64_t after, std::shared_ptr<void> place)
      : context_(&context), job_(std::move(job)), last_(after), place_(std::move(place)) {}

  /// As Response::stream.
  bool next(std::string& chunk) {
    if (over_ || context_->draining) return false;
    add_news(chunk);
    if (chunk.empty() && !over_) {
      context_->store.wait_for_event(job_.id, last_, kProgressLook);
      add_news(chunk);
    }
    const auto now = Clock::now();
    if (!chunk.empty()) {
      sent_ = now;
    } else if (now - sent_ >= kHeartbeat) {
      chunk = ": still here\n\n";
      sent_ = now;
    }
    return true;
  }

 private:
  void add_news(std::string& chunk) {
    // The state before the events: an ended job has no event that these may miss.
    const auto job = context_->store.find(job_.id);
    const auto events = context_->store.events(job_.id, last_, kBatch);
    for (const JobEvent& event : events) {
      // Progress never follows the end that it led to.
      if (job && is_end(event)) add_progress(*job, chunk);
      chunk += fmt::format("id: {}\nevent: {}\ndata: {}\n\n", event.number, event.name,
                           text_of(event_json(event)));
      last_ = event.number;
      ended_ = is_end(event);
    }
    if (job && !ended_) add_progress(*job, chunk);
    over_ = !job || (is_ended(job->state) && events.size() < kBatch);
    if (job) job_ = *job;
  }

  void add_progress(const Job& job, std::string& chunk) {
    if (job.progress == job_.progress) return;
    const auto progress = job_summary(job, "")["progress"];
    chunk += fmt::format("event: progress\ndata: {}\n\n", text_of(progress));
    job_.progress = job.progress;
  }

  static bool is_end(const JobEvent& event) {
    const auto state = job_state(event.name);
    return state && is_ended(*state);
  }

  static std::string text_of(const nlohmann::ordered_json& value) {
    return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }

  ApiContext* context_;
  Job job_;
  std::int64_t last_;
  std::shared_ptr<void> place_;
  Clock::time_point sent_ = Clock::now();
  bool ended_ = false;  ///< by the last event that was sent
  bool over_ = false;
};

std::int64_t read_start(const Request& request) {
  const std::string_view text = request.header("last-event-id");
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc{} && stop == text.data() + text.size() && number >= 0;
  if (text.empty() || whole) return number;
  throw ApiError(ProblemType::invalid_parameter,
                 "Last-Event-ID must be the id of an event that this service sent",
                 {{"errors", ProblemFields::array({{{"parameter", "Last-Event-ID"},
                                                    {"detail", "is no event's number"}}})}});
}

}  // namespace

Response stream_events(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const Job job = find_job(context, request.parts[0]);
  const std::int64_t after = read_start(request.http);
  Response response;
  response.content_type = "text/event-stream";
  response.headers.emplace_back("Cache-Control", "no-store");
  if (is_ended(job.state) && context.store.events(job.id, after, 1).empty()) {
    // Tells an EventSource, which connects again by itself, that nothing will come any more.
    response.status = 204;
    response.content_type.clear();
    return response;
  }
  if (request.http.method == "HEAD") return response;
  if (context.draining) throw ApiError(ProblemType::draining, "the service is stopping");
  auto place = context.streams.try_take();
  if (!place) {
    throw ApiError(
        ProblemType::too_many_streams,
        fmt::format("{} event streams are open, the most that there may be", kMaxStreams));
  }
  auto stream = std::make_shared<EventStream>(context, job, after, std::move(place));
  response.stream = [stream](std::string& chunk) { return stream->next(chunk); };
  return response;
}

}  // namespace sluice

#include "service/jobs/job_json.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "engine/scene/format/json_text.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

Json text_or_null(std::string_view text) { return text.empty() ? Json(nullptr) : Json(text); }

Json progress_json(const Job& job) {
  Json progress = stored_json(job.progress);
  if (progress.is_object()) progress.erase("event");
  return progress;
}

Json links_of(const Job& job) {
  const std::string self = fmt::format("/v1/jobs/{}", job.id);
  Json links{{"self", self}};
  for (const char* const name : {"events", "sensors", "report", "log", "files"}) {
    links[name] = fmt::format("{}/{}", self, name);
  }
  return links;
}

}  // namespace

Json time_json(std::int64_t unix_ms) {
  if (unix_ms == 0) return nullptr;
  using namespace std::chrono;
  const sys_time<milliseconds> at{milliseconds(unix_ms)};
  const auto whole = floor<seconds>(at);
  return fmt::format("{:%FT%T}.{:03}Z", whole, (at - whole).count());
}

Json stored_json(const std::string& text) {
  if (text.empty()) return nullptr;
  try {
    return read_stored_json(text);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

Json job_summary(const Job& job, const std::string& waiting) {
  const bool stopping = job.pending_stop != PendingStop::none;
  return Json{{"id", job.id},
              {"state", to_string(job.state)},
              {"stop_requested", stopping ? Json(to_string(job.pending_stop)) : Json(nullptr)},
              {"reason", text_or_null(job.reason)},
              {"name", job.name},
              {"label", job.label},
              {"priority", job.priority},
              {"threads", job.threads},
              {"created_at", time_json(job.created_ms)},
              {"updated_at", time_json(job.updated_ms)},
              {"started_at", time_json(job.started_ms)},
              {"ended_at", time_json(job.ended_ms)},
              {"attempts", job.attempts},
              {"crashes", job.crashes},
              {"end_time", job.end_time},
              {"progress", progress_json(job)},
              {"waiting", text_or_null(waiting)}};
}

Json job_document(const Job& job, const std::string& waiting, std::optional<int> worker) {
  Json document = job_summary(job, waiting);
  document["pid"] = worker ? Json(*worker) : Json(nullptr);
  document["scene_hash"] = job.scene_hash;
  document["estimate"] = stored_json(job.estimate);
  document["outcome"] = stored_json(job.outcome);
  document["links"] = links_of(job);
  return document;
}

Json event_json(const JobEvent& event) {
  return Json{{"number", event.number},
              {"job", event.job},
              {"at", time_json(event.time_ms)},
              {"name", event.name},
              {"detail", stored_json(event.detail)}};
}

}  // namespace sluice

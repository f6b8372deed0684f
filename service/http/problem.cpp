#include "service/http/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;
using enum ProblemType;

constexpr std::array kProblems{
    ProblemEntry{bad_request, 400, "bad-request", "The request cannot be read",
                 "Send HTTP/1.1 with well-formed headers and, where a body belongs, JSON."},
    ProblemEntry{invalid_parameter, 400, "invalid-parameter", "A parameter is wrong",
                 "Correct the parameters that `errors` names."},
    ProblemEntry{unauthorized, 401, "unauthorized", "A token is needed",
                 "Send `Authorization: Bearer TOKEN` with the token of the service's token file."},
    ProblemEntry{forbidden_host, 403, "forbidden-host", "The Host header names another host",
                 "Use the address that the service printed, or start it with --allow-host NAME."},
    ProblemEntry{forbidden_origin, 403, "forbidden-origin", "A foreign page asked for a change",
                 "Send changing requests from the service's own pages or from programs."},
    ProblemEntry{not_found, 404, "not-found", "There is no such resource",
                 "See /openapi.json for all paths."},
    ProblemEntry{no_such_job, 404, "no-such-job", "There is no such job",
                 "GET /v1/jobs lists the jobs that there are."},
    ProblemEntry{no_such_study, 404, "no-such-study", "There is no such study",
                 "GET /v1/studies lists the studies that there are."},
    ProblemEntry{no_such_sensor, 404, "no-such-sensor", "The job has no such sensor",
                 "GET /v1/jobs/{id}/sensors lists its sensors."},
    ProblemEntry{no_such_file, 404, "no-such-file", "The job has no such file",
                 "GET /v1/jobs/{id}/files lists its files."},
    ProblemEntry{method_not_allowed, 405, "method-not-allowed", "The method does not belong here",
                 "Use a method of the Allow header."},
    ProblemEntry{not_acceptable, 406, "not-acceptable", "No form of this resource is acceptable",
                 "Accept application/json, or text/csv for series."},
    ProblemEntry{request_timeout, 408, "request-timeout", "The request arrived too slowly",
                 "Send a whole request within ten seconds."},
    ProblemEntry{wrong_state, 409, "wrong-state", "The job's state does not allow this",
                 "GET the job, and wait with ?wait=30 until its state allows it."},
    ProblemEntry{no_samples_yet, 409, "no-samples-yet", "The job has no samples yet",
                 "Wait until it runs; samples appear about a second after that."},
    ProblemEntry{not_dimensionless, 409, "not-dimensionless", "The scene has no dimensionless form",
                 "Give the scene the keys scales and gravity, or leave dimensionless out."},
    ProblemEntry{body_too_large, 413, "body-too-large", "The body is too large",
                 "Send at most 256 KiB, or 32 MiB as a form with meshes."},
    ProblemEntry{uri_too_long, 414, "uri-too-long", "The request target is too long",
                 "Send at most 4 KiB of path and query."},
    ProblemEntry{unsupported_media_type, 415, "unsupported-media-type",
                 "The body's form is not supported",
                 "Send plain JSON with Content-Type: application/json and no Content-Encoding."},
    ProblemEntry{range_not_satisfiable, 416, "range-not-satisfiable", "No such range",
                 "Ask for one range inside the file, or leave Range out."},
    ProblemEntry{invalid_scene, 422, "invalid-scene", "The scene is not valid",
                 "Correct what `errors` names; /v1/schemas/scene describes every key."},
    ProblemEntry{invalid_study, 422, "invalid-study", "The study is not valid",
                 "Correct what `errors` names; /v1/schemas/study describes every key."},
    ProblemEntry{over_limit, 422, "over-limit", "More than this service allows",
                 "Make the scene coarser, shorter or with fewer samples and frames, or raise the "
                 "service's limit."},
    ProblemEntry{key_reused, 422, "idempotency-key-reused",
                 "The Idempotency-Key came with another request",
                 "Use a new key for each new job."},
    ProblemEntry{headers_too_large, 431, "headers-too-large", "The headers are too large",
                 "Send at most 100 header lines of 16 KiB together."},
    ProblemEntry{internal, 500, "internal", "The service failed",
                 "See the service's log; the request changed nothing that it did not report."},
    ProblemEntry{damaged_files, 500, "damaged-files", "Files of the job or study are damaged",
                 "Bring its folder back from a copy, or delete it; all else continues."},
    ProblemEntry{not_implemented, 501, "not-implemented", "Not implemented",
                 "Send a body with Content-Length and without Transfer-Encoding."},
    ProblemEntry{draining, 503, "draining", "The service is stopping",
                 "Try again after it has started anew; jobs resume from their checkpoints."},
    ProblemEntry{queue_full, 503, "queue-full", "The queue is full",
                 "Try again when jobs have ended."},
    ProblemEntry{too_many_streams, 503, "too-many-streams", "Too many event streams are open",
                 "Close one, or poll the job with ?wait=30."},
    ProblemEntry{overloaded, 503, "overloaded", "Too many requests at once",
                 "Try again in a second."},
    ProblemEntry{not_ready, 503, "not-ready", "The service cannot keep anything",
                 "Have its administrator bring back the data folder and its permissions, and start "
                 "the service again."},
    ProblemEntry{disk_full, 507, "disk-full", "The disk is full",
                 "Delete jobs that have ended, or make room on the data folder's disk."},
};

}  // namespace

std::span<const ProblemEntry> all_problems() { return kProblems; }

const ProblemEntry& problem_entry(ProblemType type) {
  return *std::ranges::find(kProblems, type, &ProblemEntry::type);
}

Response problem_response(ProblemType type, std::string_view detail, const ProblemFields& fields) {
  const ProblemEntry& entry = problem_entry(type);
  Json body{{"type", fmt::format("/problems/{}", entry.slug)},
            {"title", entry.title},
            {"status", entry.status},
            {"detail", detail.empty() ? entry.advice : detail}};
  body.update(fields);
  Response response = json_response(entry.status, body);
  response.content_type = "application/problem+json";
  return response;
}

std::string without_place(std::string text, const std::filesystem::path& data) {
  const std::string place = data.string();
  for (auto at = text.find(place); at != text.npos; at = text.find(place, at)) {
    const bool inside = text.compare(at + place.size(), 1, "/") == 0;
    text.replace(at, place.size() + (inside ? 1 : 0), inside ? "" : "the data folder");
  }
  return text;
}

Response text_response(std::string body, std::string_view type) {
  Response response;
  response.body = std::move(body);
  response.content_type = type;
  return response;
}

Response json_response(int status, const Json& value) {
  Response response;
  response.status = status;
  response.body = value.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  return response;
}

}  // namespace sluice

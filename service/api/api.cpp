#include "service/api/api.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "engine/store/disk/errors.hpp"
#include "service/api/api_routes.hpp"
#include "service/api/study_jobs.hpp"
#include "service/jobs/job_ids.hpp"
#include "service/jobs/job_json.hpp"
#include "service/jobs/service_log.hpp"

namespace sluice {
namespace {

constexpr std::array kRoutes{
    Route{"GET", "/", &show_index},
    Route{"POST", "/v1/jobs", &submit_job},
    Route{"GET", "/v1/jobs", &list_jobs},
    Route{"GET", "/v1/jobs/{id}", &show_job},
    Route{"DELETE", "/v1/jobs/{id}", &delete_job},
    Route{"POST", "/v1/jobs/{id}/cancel", &cancel_job},
    Route{"POST", "/v1/jobs/{id}/pause", &pause_job},
    Route{"POST", "/v1/jobs/{id}/resume", &resume_job},
    Route{"POST", "/v1/jobs/{id}/checkpoint", &checkpoint_job},
    Route{"GET", "/v1/jobs/{id}/events", &stream_events},
    Route{"GET", "/v1/jobs/{id}/sensors", &list_sensors},
    Route{"GET", "/v1/jobs/{id}/sensors/{name}", &show_sensor},
    Route{"GET", "/v1/jobs/{id}/report", &show_report},
    Route{"GET", "/v1/jobs/{id}/log", &show_log},
    Route{"GET", "/v1/jobs/{id}/files", &list_files},
    Route{"GET", "/v1/jobs/{id}/files/{name}", &send_file},
    Route{"POST", "/v1/studies", &submit_study},
    Route{"GET", "/v1/studies", &list_studies},
    Route{"GET", "/v1/studies/{id}", &show_study},
    Route{"DELETE", "/v1/studies/{id}", &delete_study},
    Route{"POST", "/v1/studies/{id}/cancel", &cancel_study},
    Route{"GET", "/v1/schemas", &list_schemas},
    Route{"GET", "/v1/schemas/{name}", &show_schema},
    Route{"GET", "/problems/{slug}", &show_problem},
    Route{"GET", "/openapi.json", &show_openapi},
    Route{"GET", "/livez", &show_livez},
    Route{"GET", "/readyz", &show_readyz},
    Route{"GET", "/metrics", &show_metrics},
};

/// The text up to the next slash, which is taken away with it.
std::string_view next_part(std::string_view& path) {
  const std::size_t slash = std::min(path.find('/'), path.size());
  const std::string_view part = path.substr(0, slash);
  path.remove_prefix(std::min(slash + 1, path.size()));
  return part;
}

/// What the pattern's {parts} caught, or nothing when the path is not of its form.
std::optional<std::vector<std::string>> match(std::string_view pattern, std::string_view path) {
  if (std::ranges::count(pattern, '/') != std::ranges::count(path, '/')) return std::nullopt;
  std::vector<std::string> parts;
  while (!pattern.empty()) {
    const std::string_view wanted = next_part(pattern);
    const std::string_view found = next_part(path);
    if (wanted.starts_with('{')) {
      if (found.empty()) return std::nullopt;
      parts.emplace_back(found);
    } else if (wanted != found) {
      return std::nullopt;
    }
  }
  if (!path.empty()) return std::nullopt;
  return parts;
}

std::string allow_of(const std::set<std::string_view>& methods) {
  std::string text = "OPTIONS";
  for (const std::string_view method : methods) {
    text += fmt::format(", {}", method);
    if (method == "GET") text += ", HEAD";
  }
  return text;
}

Response answer_other_method(const Request& request, const std::set<std::string_view>& methods) {
  const std::string allow = allow_of(methods);
  Response response;
  if (request.method == "OPTIONS") {
    response.status = 204;
    response.content_type.clear();
  } else {
    response =
        problem_response(ProblemType::method_not_allowed, fmt::format("allowed here: {}", allow));
  }
  response.headers.emplace_back("Allow", allow);
  return response;
}

/// RFC 9110, 9.3.7: `OPTIONS *` asks about the server as a whole.
Response answer_asterisk() {
  std::set<std::string_view> methods;
  for (const Route& route : kRoutes) methods.insert(route.method);
  return answer_other_method({"OPTIONS", "*", {}, {}, ""}, methods);
}

Response route(ApiContext& context, const Request& request) {
  if (request.path == "*") return answer_asterisk();
  const std::string_view method =
      request.method == "HEAD" ? std::string_view("GET") : std::string_view(request.method);
  std::string_view path = request.path;
  if (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);  // means the same
  std::set<std::string_view> methods;
  for (const Route& candidate : kRoutes) {
    auto parts = match(candidate.pattern, path);
    if (!parts) continue;
    if (candidate.method != method) {
      methods.insert(candidate.method);
      continue;
    }
    if (method != "GET" && context.draining) {
      throw ApiError(ProblemType::draining, "the service is stopping and takes no changes");
    }
    return candidate.handler(context, {request, *std::move(parts)});
  }
  if (!methods.empty()) return answer_other_method(request, methods);
  throw ApiError(ProblemType::not_found, "no route has this path; see /openapi.json for all");
}

ProblemType problem_of(JobStoreError::Fault fault) {
  using enum JobStoreError::Fault;
  switch (fault) {
    case not_found:
      return ProblemType::no_such_job;
    case conflict:
      return ProblemType::wrong_state;
    case key_reused:
      return ProblemType::key_reused;
    case full:
      return ProblemType::queue_full;
    case disk_full:
      return ProblemType::disk_full;
    case in_use:
    case damaged:
    case newer_version:
    case uncertain:
    case io:
      break;
  }
  return ProblemType::internal;
}

ProblemType problem_of(StorageFault fault) {
  using enum StorageFault;
  switch (fault) {
    case disk_full:
      return ProblemType::disk_full;
    case locked:
      return ProblemType::wrong_state;
    case corrupt:
    case unsupported_version:
    case wrong_scene:
    case not_ours:
    case no_usable_checkpoint:
      return ProblemType::damaged_files;
    case io:
    case unwritable:
    case invalid_content:
    case already_exists:
    case lost:
      break;
  }
  return ProblemType::internal;
}

/// What went wrong on the service's side: all of it for the log, and without our paths for the
/// client.
Response service_failure(const ApiContext& context, const Request& request, ProblemType type,
                         std::string_view message) {
  if (type == ProblemType::internal || type == ProblemType::disk_full ||
      type == ProblemType::damaged_files) {
    log_line({{"event", "request_failed"},
              {"method", request.method},
              {"path", request.path},
              {"message", message}});
  }
  Response response = problem_response(type, without_place(std::string(message), context.data));
  if (response.status == 503) response.headers.emplace_back("Retry-After", "5");
  return response;
}

/// What is wrong with files is the damage of a job or study only where the request names one.
ProblemType problem_of(StorageFault fault, const Request& request) {
  const ProblemType type = problem_of(fault);
  const bool names_one =
      request.path.starts_with("/v1/jobs/") || request.path.starts_with("/v1/studies/");
  return type == ProblemType::damaged_files && !names_one ? ProblemType::internal : type;
}

/// For a request that failed because the files of its job are gone.
std::optional<Response> answer_for_lost_files(const ApiContext& context, const Request& request) {
  constexpr std::string_view kJobs = "/v1/jobs/";
  if (!request.path.starts_with(kJobs)) return std::nullopt;
  const std::string id =
      request.path.substr(kJobs.size(), request.path.find('/', kJobs.size()) - kJobs.size());
  std::error_code ignored;
  const auto folder = context.paths(id).root();
  const bool lost = is_job_id(id) && std::filesystem::exists(folder.parent_path(), ignored) &&
                    !std::filesystem::exists(folder, ignored);
  if (!lost) return std::nullopt;
  return problem_response(
      ProblemType::no_such_job,
      fmt::format("the files of job {} are gone: it was deleted, or somebody removed its folder",
                  id));
}

Response handle_or_fail(ApiContext& context, const Request& request) {
  try {
    return route(context, request);
  } catch (const ApiError& error) {
    Response response = problem_response(error.type(), error.what(), error.fields());
    if (response.status == 503) response.headers.emplace_back("Retry-After", "5");
    return response;
  } catch (const JobStoreError& error) {
    return service_failure(context, request, problem_of(error.fault()), error.what());
  } catch (const StorageError& error) {
    if (auto answer = answer_for_lost_files(context, request)) return *std::move(answer);
    return service_failure(context, request, problem_of(error.fault(), request), error.what());
  } catch (const std::bad_alloc&) {
    return problem_response(ProblemType::overloaded, "the service is out of memory");
  } catch (const std::exception& error) {
    if (auto answer = answer_for_lost_files(context, request)) return *std::move(answer);
    return service_failure(context, request, ProblemType::internal, error.what());
  }
}

}  // namespace

std::span<const Route> all_routes() { return kRoutes; }

nlohmann::ordered_json document_of(const ApiContext& context, const Job& job) {
  return job_document(job, context.scheduler.why_waiting(job), context.scheduler.worker_of(job));
}

Job find_job(const ApiContext& context, const std::string& id) {
  const bool ours = is_job_id(id);
  if (ours) {
    if (auto job = context.store.find(id)) return *std::move(job);
  }
  throw ApiError(ProblemType::no_such_job,
                 ours ? fmt::format("there is no job {}; it may have been deleted", id)
                      : "a job's id is the letter j and 20 characters of 0-9 and a-v");
}

StudyRecord find_study(const ApiContext& context, const std::string& id) {
  if (auto study = context.studies.find(id)) return *std::move(study);
  throw ApiError(ProblemType::no_such_study,
                 is_study_id(id) ? fmt::format("there is no study {}; it may have been deleted", id)
                                 : "a study's id is the letter s and 20 characters of 0-9 and a-v");
}

Api::Api(JobStore& store, Scheduler& scheduler, std::filesystem::path data,
         std::filesystem::path program)
    : context_(std::make_unique<ApiContext>(store, scheduler, std::filesystem::absolute(data),
                                            std::move(program))) {
  finish_studies(*context_);
}

Api::~Api() = default;

Response Api::handle(const Request& request) { return handle_or_fail(*context_, request); }

void Api::set_draining() {
  context_->draining = true;
  context_->store.wake();
}

void Api::count_request(std::string_view method, int status, std::chrono::duration<double> took) {
  context_->metrics.count(method, status, took.count());
}

}  // namespace sluice

#include <fmt/format.h>
#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/json_text.hpp"
#include "engine/store/errors.hpp"
#include "engine/store/file_system.hpp"
#include "service/api_routes.hpp"
#include "service/job_file.hpp"
#include "service/job_json.hpp"
#include "service/query.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct JobFileEntry {
  std::filesystem::path path;
  std::string_view kind;
};

/// Every file of a job that may be fetched. Names come from here alone: what a user sent is only
/// compared with them.
std::vector<JobFileEntry> entries_of(const JobPaths& paths) {
  std::vector<JobFileEntry> entries{
      {paths.scene(), "scene"},        {job_file_path(paths.root()), "job"},
      {paths.series(), "series"},      {paths.outcome(), "outcome"},
      {paths.report(), "report"},      {paths.report_markdown(), "report"},
      {paths.report_html(), "report"}, {paths.log(), "log"}};
  for (auto& path : paths.checkpoints()) entries.push_back({std::move(path), "checkpoint"});
  for (auto& path : paths.frame_files()) entries.push_back({std::move(path), "frame"});
  return entries;
}

std::string_view type_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".json") return "application/json";
  if (extension == ".jsonl") return "application/x-ndjson";
  if (extension == ".md") return "text/markdown; charset=utf-8";
  if (extension == ".html") return "text/html; charset=utf-8";
  return "application/x-hdf5";
}

Response file_response(const std::filesystem::path& path) {
  Response response;
  response.content_type = type_of(path);
  if (path.extension() == ".html") {
    // A report needs no script and no other address, so none gets through.
    response.headers.emplace_back("Content-Security-Policy",
                                  "default-src 'none'; style-src 'unsafe-inline'; img-src data:");
  }
  response.file = path;
  return response;
}

std::optional<Json> describe(const JobFileEntry& entry, const std::string& id) {
  struct stat status {};
  if (::lstat(entry.path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  const std::string name = entry.path.filename().string();
  const std::int64_t changed_ms =
      std::int64_t{status.st_mtim.tv_sec} * 1000 + status.st_mtim.tv_nsec / 1'000'000;
  return Json{{"name", name},
              {"kind", entry.kind},
              {"bytes", status.st_size},
              {"changed_at", time_json(changed_ms)},
              {"href", fmt::format("/v1/jobs/{}/files/{}", id, name)}};
}

constexpr std::array<std::string_view, 3> kReportFormats{"json", "markdown", "html"};

/// The worker writes it when the run is complete.
Response report_file(const Job& job, const std::filesystem::path& path) {
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(path))) {
    return file_response(path);
  }
  throw ApiError(
      ProblemType::wrong_state,
      fmt::format("job {} is {} and has no report: its worker writes one when the run is "
                  "complete; GET /v1/jobs/{}?wait=30 until it is",
                  job.id, to_string(job.state), job.id));
}

Json document_in(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return nullptr;
  const std::string text = read_text(path, JobPaths::kLargestReport);
  try {
    return read_stored_json(text);
  } catch (const std::runtime_error& error) {
    throw StorageError(StorageFault::corrupt,
                       fmt::format("{}: {}", path.filename().string(), error.what()));
  }
}

}  // namespace

Response show_report(ApiContext& context, const RouteRequest& request) {
  QueryReader query(request.http);
  const std::string format = query.word("format", kReportFormats).value_or("json");
  query.finish();
  const Job job = find_job(context, request.parts[0]);
  const JobPaths paths = context.paths(job.id);
  if (format != "json") {
    return report_file(job, format == "html" ? paths.report_html() : paths.report_markdown());
  }
  const Json outcome = document_in(paths.outcome());
  const Json report = document_in(paths.report());
  if (outcome.is_null() && report.is_null()) {
    throw ApiError(ProblemType::wrong_state,
                   fmt::format("job {} is {} and no attempt of it has ended: GET "
                               "/v1/jobs/{}?wait=30 until it has",
                               job.id, to_string(job.state), job.id));
  }
  return json_response(
      200,
      {{"job", job.id}, {"state", to_string(job.state)}, {"outcome", outcome}, {"report", report}});
}

Response show_log(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const JobPaths paths = context.paths(find_job(context, request.parts[0]).id);
  if (std::filesystem::exists(paths.log())) return file_response(paths.log());
  Response empty;
  empty.content_type = type_of(paths.log());
  return empty;
}

Response list_files(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const Job job = find_job(context, request.parts[0]);
  Json files = Json::array();
  for (const JobFileEntry& entry : entries_of(context.paths(job.id))) {
    if (auto file = describe(entry, job.id)) files.push_back(*std::move(file));
  }
  return json_response(200, {{"files", std::move(files)}});
}

Response send_file(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const Job job = find_job(context, request.parts[0]);
  for (const JobFileEntry& entry : entries_of(context.paths(job.id))) {
    if (entry.path.filename() != request.parts[1]) continue;
    if (std::filesystem::exists(entry.path)) return file_response(entry.path);
  }
  throw ApiError(
      ProblemType::no_such_file,
      fmt::format("job {} has no file of this name; see /v1/jobs/{}/files", job.id, job.id));
}

}  // namespace sluice

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"
#include "service/jobs/job_file.hpp"
#include "service/jobs/job_json.hpp"

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
  for (auto& path : paths.parts()) entries.push_back({std::move(path), "mesh"});
  for (auto& path : paths.checkpoints()) entries.push_back({std::move(path), "checkpoint"});
  for (auto& path : frames_of(paths)) entries.push_back({std::move(path), "frame"});
  return entries;
}

std::string_view type_of(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".json") return "application/json";
  if (extension == ".jsonl") return "application/x-ndjson";
  if (extension == ".md") return "text/markdown; charset=utf-8";
  if (extension == ".html") return "text/html; charset=utf-8";
  if (extension == ".h5") return "application/x-hdf5";
  return "application/octet-stream";
}

Response file_response(const std::filesystem::path& path) {
  Response response;
  response.content_type = type_of(path);
  if (path.extension() == ".html") {
    response.headers.emplace_back("Content-Security-Policy", std::string(kPagePolicy));
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

}  // namespace

bool is_regular(const std::filesystem::path& path) {
  std::error_code missing;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(path, missing));
}

std::vector<std::filesystem::path> frames_of(const JobPaths& paths) {
  if (std::filesystem::is_symlink(paths.frames())) return {};
  return paths.snapshot_files();
}

Response show_log(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const JobPaths paths = context.paths(find_job(context, request.parts[0]).id);
  if (is_regular(paths.log())) return file_response(paths.log());
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
    if (is_regular(entry.path)) return file_response(entry.path);
  }
  throw ApiError(
      ProblemType::no_such_file,
      fmt::format("job {} has no file of this name; see /v1/jobs/{}/files", job.id, job.id));
}

}  // namespace sluice

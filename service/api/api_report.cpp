#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"
#include "service/jobs/job_json.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> kReportFormats{"json", "markdown", "html"};

/// Null when there is none or it is damaged.
Json document_in(const std::filesystem::path& path) {
  if (!is_regular(path)) return nullptr;
  try {
    return stored_json(read_text(path, JobPaths::kLargestReport, Links::refuse));
  } catch (const StorageError&) {
    return nullptr;
  }
}

/// How the run ended: as it said itself, else as the service knows it.
Json outcome_of(const Job& job, const JobPaths& paths) {
  if (Json outcome = document_in(paths.outcome()); outcome.is_object()) return outcome;
  if (!is_ended(job.state)) return nullptr;
  if (Json outcome = stored_json(job.outcome); outcome.is_object()) return outcome;
  return Json{{"state", to_string(job.state)}, {"reason", job.reason}};
}

/// What making a report reads, about, bytes.
std::uint64_t bytes_read(const JobPaths& paths) {
  constexpr std::uint64_t kPictures = 3;
  std::error_code none;
  const std::uintmax_t series =
      is_regular(paths.series()) ? std::filesystem::file_size(paths.series()) : 0;
  const auto frames = frames_of(paths);
  const std::uintmax_t frame =
      frames.empty() ? 0 : std::filesystem::file_size(frames.front(), none);
  return series + (none ? 0 : kPictures * frame);
}

/// By the program itself: no report's code is in the service.
std::string made_report(ApiContext& context, const Job& job, const std::string& format) {
  const JobPaths paths = context.paths(job.id);
  std::vector<std::string> arguments{"report", ".", "--format", format};
  if (const Json outcome = outcome_of(job, paths); outcome.is_object()) {
    arguments.insert(arguments.end(),
                     {"--outcome", outcome.dump(-1, ' ', false, Json::error_handler_t::replace)});
  }
  return context.maker.by_program(bytes_read(paths), context.program, paths.root(), arguments);
}

Response report_page(ApiContext& context, const Job& job, const std::string& format) {
  const JobPaths paths = context.paths(job.id);
  const bool page = format == "html";
  const auto path = page ? paths.report_html() : paths.report_markdown();
  Response response;
  if (job.state == JobState::completed && is_regular(path)) {
    response.file = path;
  } else {
    response.body = made_report(context, job, format);
    response.headers.emplace_back("Cache-Control", "no-cache");
  }
  response.content_type = page ? "text/html; charset=utf-8" : "text/markdown; charset=utf-8";
  if (page) response.headers.emplace_back("Content-Security-Policy", std::string(kPagePolicy));
  return response;
}

/// The worker leaves one when the run is complete; it may have been killed before.
Json report_document(ApiContext& context, const Job& job) {
  if (job.state == JobState::completed) {
    if (Json report = document_in(context.paths(job.id).report()); report.is_object())
      return report;
  }
  return stored_json(made_report(context, job, "json"));
}

}  // namespace

Response show_report(ApiContext& context, const RouteRequest& request) {
  QueryReader query(request.http);
  const std::string format = query.word("format", kReportFormats).value_or("json");
  query.finish();
  const Job job = find_job(context, request.parts[0]);
  if (format != "json") return report_page(context, job, format);
  const Json report = report_document(context, job);
  return json_response(200, {{"job", job.id},
                             {"state", to_string(job.state)},
                             {"outcome", outcome_of(job, context.paths(job.id))},
                             {"report", report}});
}

}  // namespace sluice

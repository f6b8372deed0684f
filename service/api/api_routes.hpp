#pragma once

#include <span>
#include <string_view>

#include "service/api/api_context.hpp"
#include "service/http/problem.hpp"

namespace sluice {

using Handler = Response (*)(ApiContext&, const RouteRequest&);

/// A path with {parts}, and what answers there. HEAD goes to GET.
struct Route {
  std::string_view method;
  std::string_view pattern;
  Handler handler;
};

[[nodiscard]] std::span<const Route> all_routes();

/// Of a report's page, which needs no script and no other address.
inline constexpr std::string_view kPagePolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// Whether the path is a file and no link to one.
[[nodiscard]] bool is_regular(const std::filesystem::path& path);
/// The frames of a job; none behind a link. Throws StorageError(corrupt) when something else has
/// their folder's name.
[[nodiscard]] std::vector<std::filesystem::path> frames_of(const JobPaths& paths);

// api_submit.cpp
Response submit_job(ApiContext& context, const RouteRequest& request);
// api_jobs.cpp
Response list_jobs(ApiContext& context, const RouteRequest& request);
Response show_job(ApiContext& context, const RouteRequest& request);
Response delete_job(ApiContext& context, const RouteRequest& request);
// api_actions.cpp
Response cancel_job(ApiContext& context, const RouteRequest& request);
Response pause_job(ApiContext& context, const RouteRequest& request);
Response resume_job(ApiContext& context, const RouteRequest& request);
Response checkpoint_job(ApiContext& context, const RouteRequest& request);
// api_submit_study.cpp
Response submit_study(ApiContext& context, const RouteRequest& request);
// api_studies.cpp
Response list_studies(ApiContext& context, const RouteRequest& request);
Response show_study(ApiContext& context, const RouteRequest& request);
Response cancel_study(ApiContext& context, const RouteRequest& request);
Response delete_study(ApiContext& context, const RouteRequest& request);
// api_events.cpp
Response stream_events(ApiContext& context, const RouteRequest& request);
// api_sensors.cpp
Response list_sensors(ApiContext& context, const RouteRequest& request);
Response show_sensor(ApiContext& context, const RouteRequest& request);
// api_report.cpp
Response show_report(ApiContext& context, const RouteRequest& request);
// api_files.cpp
Response show_log(ApiContext& context, const RouteRequest& request);
Response list_files(ApiContext& context, const RouteRequest& request);
Response send_file(ApiContext& context, const RouteRequest& request);
// api_meta.cpp
Response show_index(ApiContext& context, const RouteRequest& request);
Response show_openapi(ApiContext& context, const RouteRequest& request);
Response list_schemas(ApiContext& context, const RouteRequest& request);
Response show_schema(ApiContext& context, const RouteRequest& request);
Response show_problem(ApiContext& context, const RouteRequest& request);
Response show_livez(ApiContext& context, const RouteRequest& request);
Response show_readyz(ApiContext& context, const RouteRequest& request);
Response show_metrics(ApiContext& context, const RouteRequest& request);

}  // namespace sluice

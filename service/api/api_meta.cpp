#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/format/schema.hpp"
#include "engine/study/study.hpp"
#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"
#include "sluice/openapi_texts.hpp"
#include "sluice/version.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// schemas/openapi.json. As a file it names the schemas beside it, here those that are served.
const std::string& openapi_text() {
  static const std::string served = [] {
    std::string text(kOpenapiTexts[0].second);
    for (const std::string name : {"scene", "study"}) {
      const std::string beside = fmt::format("\"{}.schema.json\"", name);
      for (std::size_t at = 0; (at = text.find(beside, at)) != std::string::npos;) {
        text.replace(at, beside.size(), fmt::format("\"/v1/schemas/{}\"", name));
      }
    }
    return text;
  }();
  return served;
}

}  // namespace

Response show_index(ApiContext& /*context*/, const RouteRequest& request) {
  QueryReader(request.http).finish();
  return json_response(200, {{"service", "sluice"},
                             {"version", kVersion},
                             {"links",
                              {{"jobs", "/v1/jobs"},
                               {"studies", "/v1/studies"},
                               {"schemas", "/v1/schemas"},
                               {"openapi", "/openapi.json"},
                               {"metrics", "/metrics"}}}});
}

Response show_openapi(ApiContext& /*context*/, const RouteRequest& request) {
  QueryReader(request.http).finish();
  return text_response(openapi_text(), "application/json");
}

Response list_schemas(ApiContext& /*context*/, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const Json scene{{"name", "scene"}, {"href", "/v1/schemas/scene"}};
  const Json study{{"name", "study"}, {"href", "/v1/schemas/study"}};
  return json_response(200, {{"schemas", Json::array({scene, study})}});
}

Response show_schema(ApiContext& /*context*/, const RouteRequest& request) {
  QueryReader(request.http).finish();
  if (request.parts[0] == "scene") {
    return text_response(scene_schema_text(), "application/schema+json");
  }
  if (request.parts[0] == "study") {
    return text_response(study_schema_text(), "application/schema+json");
  }
  throw ApiError(ProblemType::not_found,
                 "there are two schemas: /v1/schemas/scene and /v1/schemas/study");
}

Response show_problem(ApiContext& /*context*/, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const auto problems = all_problems();
  const auto found = std::ranges::find(problems, request.parts[0], &ProblemEntry::slug);
  if (found == problems.end()) {
    throw ApiError(ProblemType::not_found, "no problem of this service has this type");
  }
  return json_response(200, {{"type", fmt::format("/problems/{}", found->slug)},
                             {"title", found->title},
                             {"status", found->status},
                             {"advice", found->advice}});
}

Response show_livez(ApiContext& /*context*/, const RouteRequest& request) {
  QueryReader(request.http).finish();
  return json_response(200, {{"status", "alive"}});
}

Response show_readyz(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  if (context.draining) throw ApiError(ProblemType::draining, "the service is stopping");
  const std::string trouble = context.store.trouble();
  if (!trouble.empty())
    throw ApiError(ProblemType::not_ready, without_place(trouble, context.data));
  (void)context.store.last_event();
  return json_response(200, {{"status", "ready"}});
}

Response show_metrics(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  return text_response(context.metrics.text(context.store),
                       "text/plain; version=0.0.4; charset=utf-8");
}

}  // namespace sluice

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/read/series_view.hpp"
#include "service/api/api_routes.hpp"
#include "service/http/query.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 2> kFilters{"none", "gaussian"};
constexpr std::array<std::string_view, 2> kSeriesFormats{"json", "csv"};
constexpr int kUsualPoints = 20'000;
constexpr int kMostPoints = 200'000;
constexpr double kMostProducts = 5e7;  // of a filter: half a second of one core

enum class Format { json, csv };

Scene scene_of(const ApiContext& context, const Job& job) {
  const JobPaths paths = context.paths(job.id);
  const auto damaged = [&](std::string_view how) {
    return StorageError(StorageFault::corrupt,
                        fmt::format("the scene in the folder of job {} {}", job.id, how));
  };
  if (!is_present(paths.scene())) throw damaged("is gone");
  ParseResult result = parse_job_scene(read_text(paths.scene(), kMaxSceneBytes + 1, Links::refuse),
                                       parts_in(paths.root(), Links::refuse));
  if (result.scene) return *std::move(result.scene);
  throw damaged("was altered");
}

void require_sensor(const Scene& scene, const std::string& name) {
  std::vector<std::string_view> names;
  for (const Sensor& sensor : scene.sensors) names.push_back(sensor.name);
  if (std::ranges::find(names, name) != names.end()) return;
  throw ApiError(ProblemType::no_such_sensor,
                 names.empty() ? "this job's scene has no sensors"
                               : fmt::format("there is no sensor {}: {}", name, hint(name, names)));
}

ApiError no_samples_yet(const std::string& name) {
  return {ProblemType::no_samples_yet,
          fmt::format("sensor {} has no samples yet: the job has not run long enough", name)};
}

const Series* series_named(const std::vector<Series>& all, std::string_view name) {
  const auto found = std::ranges::find(all, name, &Series::name);
  return found == all.end() ? nullptr : &*found;
}

/// The query decides, else what the client accepts.
Format choose_format(const Request& request, const std::optional<std::string>& word) {
  if (word) return *word == "csv" ? Format::csv : Format::json;
  const std::string_view accept = request.header("accept");
  const auto names = [&](std::string_view type) { return accept.find(type) != accept.npos; };
  if (accept.empty() || names("*/*") || names("application/json") || names("application/*")) {
    return Format::json;
  }
  if (names("text/csv") || names("text/*")) return Format::csv;
  throw ApiError(ProblemType::not_acceptable,
                 "a series comes as application/json or text/csv: accept one, or say format=");
}

struct SensorQuery {
  SeriesQuery series;
  bool dimensionless = false;
  Format format = Format::json;
};

SensorQuery read_query(const Request& request) {
  QueryReader query(request);
  SensorQuery asked;
  asked.series.from = query.number("from", -1e9, 1e9);
  asked.series.to = query.number("to", -1e9, 1e9);
  const bool gaussian = query.word("filter", kFilters).value_or("none") == "gaussian";
  asked.series.tau = query.number("tau", 1e-9, 1e6);
  const auto points = query.integer("max_points", 10, kMostPoints).value_or(kUsualPoints);
  asked.series.max_points = static_cast<std::size_t>(points);
  asked.series.max_products = kMostProducts;
  asked.dimensionless = query.flag("dimensionless");
  const auto format = query.word("format", kSeriesFormats);
  if (gaussian && !asked.series.tau) query.reject("tau", "is needed with filter=gaussian, in s");
  if (!gaussian && asked.series.tau) query.reject("tau", "goes with filter=gaussian");
  const auto& [from, to] = std::pair(asked.series.from, asked.series.to);
  if (from && to && *from > *to) query.reject("from", "must not be later than to");
  query.finish();
  asked.format = choose_format(request, format);
  return asked;
}

void scale(SeriesQuery& query, const Scene& scene, const Series& series) {
  try {
    query.divisors = dimensionless_divisors(scene, series);
  } catch (const std::invalid_argument& error) {
    throw ApiError(ProblemType::not_dimensionless, error.what());
  }
}

SeriesView view_of(const Series& series, const SeriesQuery& query, const Job& job) {
  try {
    return make_view(series, query,
                     job.state == JobState::completed ? SeriesState::final : SeriesState::growing);
  } catch (const std::length_error& error) {
    throw ApiError(ProblemType::over_limit, error.what(),
                   {{"errors", Json::array({{{"parameter", "tau"}, {"detail", error.what()}}})}});
  }
}

/// A view as text, after one line of JSON with what its headers say.
std::string rendered(const SeriesView& view, const SensorQuery& asked) {
  const Json facts{{"samples", view.samples},
                   {"provisional_after",
                    view.provisional_after ? Json(*view.provisional_after) : Json(nullptr)}};
  return facts.dump() + "\n" +
         (asked.format == Format::json ? json_text(view, asked.series)
                                       : csv_text(view, asked.series));
}

/// In a child process: reads the file and works it up.
std::string make_series_text(const std::filesystem::path& path, const Scene& scene,
                             const std::string& name, SensorQuery asked, const Job& job) {
  const std::vector<Series> all = read_series(path);
  const Series* const series = series_named(all, name);
  if (series == nullptr) throw no_samples_yet(name);
  if (asked.dimensionless) scale(asked.series, scene, *series);
  return rendered(view_of(*series, asked.series, job), asked);
}

Response series_response(std::string text, const SensorQuery& asked, const Job& job) {
  const std::size_t line = text.find('\n');
  const Json facts = Json::parse(text.substr(0, line));
  Response response;
  response.body = std::move(text);
  response.body.erase(0, line + 1);
  if (asked.format == Format::csv) {
    response.content_type = "text/csv; charset=utf-8; header=present";
    // What the JSON form says inside.
    response.headers.emplace_back("Sluice-Samples", facts["samples"].dump());
    if (!facts["provisional_after"].is_null()) {
      response.headers.emplace_back("Sluice-Provisional-After", facts["provisional_after"].dump());
    }
  }
  response.headers.emplace_back("Vary", "Accept");
  response.headers.emplace_back("Sluice-Job-State", std::string(to_string(job.state)));
  return response;
}

Json sensor_json(const Sensor& sensor, const Series* series) {
  Json columns = Json::array();
  if (series != nullptr) {
    for (const Series::Column& column : series->columns) {
      columns.push_back({{"name", column.name}, {"unit", column.unit}});
    }
  }
  const bool empty = series == nullptr || series->size() == 0;
  const auto mean = empty ? std::nullopt : series->mean_interval();
  return Json{{"name", sensor.name},
              {"kind", to_string(sensor.kind)},
              {"interval", sensor.interval},
              {"samples", series == nullptr ? 0 : series->size()},
              {"first", empty ? Json(nullptr) : Json(series->time.front())},
              {"last", empty ? Json(nullptr) : Json(series->time.back())},
              {"mean_interval", mean ? Json(*mean) : Json(nullptr)},
              {"columns", std::move(columns)}};
}

}  // namespace

Response list_sensors(ApiContext& context, const RouteRequest& request) {
  QueryReader(request.http).finish();
  const Job job = find_job(context, request.parts[0]);
  const Scene scene = scene_of(context, job);
  const auto path = context.paths(job.id).series();
  const auto list = [&](const std::vector<Series>& all) {
    Json sensors = Json::array();
    for (const Sensor& sensor : scene.sensors) {
      sensors.push_back(sensor_json(sensor, series_named(all, sensor.name)));
    }
    return Json{{"sensors", std::move(sensors)}}.dump();
  };
  return text_response(is_regular(path)
                           ? context.maker.from_file(path, [&] { return list(read_series(path)); })
                           : list({}),
                       "application/json");
}

Response show_sensor(ApiContext& context, const RouteRequest& request) {
  const SensorQuery asked = read_query(request.http);
  // The state before the samples: those of a job that has completed are final.
  const Job job = find_job(context, request.parts[0]);
  const Scene scene = scene_of(context, job);
  const std::string& name = request.parts[1];
  require_sensor(scene, name);
  const auto path = context.paths(job.id).series();
  if (!is_regular(path)) throw no_samples_yet(name);
  std::string text = context.maker.from_file(
      path, [&] { return make_series_text(path, scene, name, asked, job); });
  return series_response(std::move(text), asked, job);
}

}  // namespace sluice

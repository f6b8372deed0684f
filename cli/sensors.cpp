#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/job_data.hpp"
#include "cli/sensors.hpp"
#include "cli/verbs.hpp"
#include "engine/ladder/table.hpp"
#include "engine/store/dimensionless.hpp"
#include "engine/store/filter.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// A series as it is shown: filtered, scaled.
struct View {
  Series series;
  std::optional<double> provisional_after;  ///< in the view's unit of time
};

Series filtered(const Series& series, double tau) {
  Series result = series;
  const std::size_t width = series.columns.size();
  for (std::size_t column = 0; column < width; ++column) {
    const Filtered values = gaussian_filter(series, tau, column);
    for (std::size_t n = 0; n < series.size(); ++n) {
      result.values[n * width + column] = values.value[n];
    }
    result.weight = values.weight;
  }
  return result;
}

View make_view(const JobData& job, const Series& raw, const SensorArguments& arguments) {
  View view{raw, {}};
  if (arguments.filter == FilterKind::gaussian) {
    view.series = filtered(raw, *arguments.tau);
    if (!job.completed() && raw.size() > 0) {
      view.provisional_after = provisional_after(raw, *arguments.tau);
    }
  }
  if (arguments.dimensionless) {
    const Divisors divisors = dimensionless_divisors(job.scene(), raw);
    view.series = dimensionless(std::move(view.series), divisors);
    if (view.provisional_after) *view.provisional_after /= divisors.time;
  }
  return view;
}

/// An empty cell where there is no value: a dry sensor did not measure zero.
std::string cell(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }

std::string csv_of(const View& view, bool dimensionless) {
  const Series& series = view.series;
  const std::size_t width = series.columns.size();
  std::string text = dimensionless ? "time" : "time_s";
  for (const Series::Column& column : series.columns) text += fmt::format(",{}", column.name);
  text += ",weight\n";
  for (std::size_t n = 0; n < series.size(); ++n) {
    text += fmt::format("{}", series.time[n]);
    for (std::size_t c = 0; c < width; ++c)
      text += fmt::format(",{}", cell(series.values[n * width + c]));
    text += fmt::format(",{}\n", series.weight[n]);
  }
  return text;
}

Json column_json(const Series& series, std::size_t column) {
  Json values = Json::array();
  for (std::size_t n = 0; n < series.size(); ++n) {
    const double value = series.values[n * series.columns.size() + column];
    values.push_back(std::isnan(value) ? Json(nullptr) : Json(value));
  }
  return Json{{"name", series.columns[column].name},
              {"unit", series.columns[column].unit},
              {"values", std::move(values)}};
}

Json json_of(const View& view, const SensorArguments& arguments) {
  const Series& series = view.series;
  const bool gaussian = arguments.filter == FilterKind::gaussian;
  Json object{{"name", series.name}, {"kind", series.kind}};
  object["filter"] = gaussian ? "gaussian" : "none";
  object["tau"] = gaussian ? Json(*arguments.tau) : Json(nullptr);
  object["dimensionless"] = arguments.dimensionless;
  object["provisional_after"] =
      view.provisional_after ? Json(*view.provisional_after) : Json(nullptr);
  object["time_unit"] = arguments.dimensionless ? "1" : "s";
  object["time"] = series.time;
  Json columns = Json::array();
  for (std::size_t c = 0; c < series.columns.size(); ++c) {
    columns.push_back(column_json(series, c));
  }
  object["columns"] = std::move(columns);
  object["weight"] = series.weight;
  return object;
}

void list_sensors(const std::vector<Series>& all, Format format) {
  Json list = Json::array();
  if (format == Format::csv) fmt::print("name,kind,samples,first_s,last_s\n");
  for (const Series& series : all) {
    const bool empty = series.size() == 0;
    const Json first = empty ? Json(nullptr) : Json(series.time.front());
    const Json last = empty ? Json(nullptr) : Json(series.time.back());
    if (format == Format::csv) {
      fmt::print("{},{},{},{},{}\n", csv_field(series.name), series.kind, series.size(),
                 empty ? "" : first.dump(), empty ? "" : last.dump());
    }
    list.push_back(Json{{"name", series.name},
                        {"kind", series.kind},
                        {"samples", series.size()},
                        {"first", first},
                        {"last", last}});
  }
  if (format == Format::json) fmt::print("{}\n", list.dump(2));
}

void require_sense(const SensorArguments& arguments) {
  const bool gaussian = arguments.filter == FilterKind::gaussian;
  if (gaussian && !arguments.tau) {
    throw CommandEnd(ExitCode::usage,
                     "--filter gaussian needs --tau SECONDS; the paper's case "
                     "is shown with 0.002");
  }
  if (!gaussian && arguments.tau) {
    throw CommandEnd(ExitCode::usage, "--tau goes with --filter gaussian");
  }
  if (gaussian && !std::isfinite(*arguments.tau)) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("--tau is {}, but must be a number of seconds", *arguments.tau));
  }
}

void require_folder(const SensorArguments& arguments) {
  if (!std::filesystem::is_directory(arguments.target)) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("there is no folder {}; for a job of a service, add --server URL",
                                 arguments.target));
  }
  if (arguments.from || arguments.to || arguments.max_points) {
    throw CommandEnd(ExitCode::usage, "--from, --to and --max-points go with --server");
  }
}

void show_sensors(const SensorArguments& arguments) {
  require_sense(arguments);
  if (arguments.of_service) return show_service_sensors(arguments);
  require_folder(arguments);
  const JobData job(arguments.target);
  const std::vector<Series> all = job.series();
  if (arguments.name.empty()) return list_sensors(all, arguments.format);
  const View view = make_view(job, find_series(all, arguments.name), arguments);
  if (arguments.format == Format::csv) {
    fmt::print("{}", csv_of(view, arguments.dimensionless));
  } else {
    fmt::print("{}\n", json_of(view, arguments).dump());
  }
}

}  // namespace

void add_sensors(CLI::App& app) {
  auto arguments = std::make_shared<SensorArguments>();
  CLI::App* verb = app.add_subcommand("sensors", "Print a job's sensors, or the series of one");
  verb->add_option("target", arguments->target, "The job's folder; with --server, the job's id")
      ->required();
  verb->add_option("name", arguments->name, "The sensor; without one, all are listed");
  const std::map<std::string, FilterKind> filters{{"none", FilterKind::none},
                                                  {"gaussian", FilterKind::gaussian}};
  verb->add_option("--filter", arguments->filter, "Low-pass filter in time (eq. 12)")
      ->transform(CLI::CheckedTransformer(filters).description("{none,gaussian}"));
  verb->add_option("--tau", arguments->tau, "Its smoothing time, s")->check(CLI::PositiveNumber);
  verb->add_flag("--dimensionless", arguments->dimensionless,
                 "T, X, H and P of eqs. 19-22 by the scene's scales");
  const std::map<std::string, Format> formats{{"csv", Format::csv}, {"json", Format::json}};
  verb->add_option("--format", arguments->format, "csv by default")
      ->transform(CLI::CheckedTransformer(formats).description("{csv,json}"));
  verb->add_flag_callback(
      "--json", [arguments] { arguments->format = Format::json; }, "The same as --format json");
  add_service_sensor_options(*verb, *arguments);
  verb->footer(
      "Example: sluice sensors dambreak-quick P1 --filter gaussian --tau 0.002\n"
      "         sluice sensors j0r2mt1q8kq0f7a3c1d2e P1 --server http://127.0.0.1:8080");
  verb->callback([arguments] { show_sensors(*arguments); });
}

}  // namespace sluice

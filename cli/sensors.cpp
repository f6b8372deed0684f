#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "cli/checks.hpp"
#include "cli/client/job_data.hpp"
#include "cli/sensors.hpp"
#include "cli/verbs.hpp"
#include "engine/store/read/dimensionless.hpp"
#include "engine/store/read/filter.hpp"
#include "engine/study/table.hpp"
#include "service/api/series_view.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// A series as it is shown: filtered, scaled.
struct View {
  Series series;
  std::size_t samples = 0;                  ///< in the time asked for
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
  }
  return result;
}

/// The samples of a time, both ends included.
Series samples_within(const Series& series, double from, double to) {
  const auto first = std::lower_bound(series.time.begin(), series.time.end(), from);
  const auto last = std::upper_bound(first, series.time.end(), to);
  const auto begin = first - series.time.begin();
  const auto end = last - series.time.begin();
  const auto part = [&](const std::vector<double>& all, std::ptrdiff_t width) {
    return std::vector<double>(all.begin() + begin * width, all.begin() + end * width);
  };
  Series result = series;
  result.time = part(series.time, 1);
  result.duration = part(series.duration, 1);
  result.weight = part(series.weight, 1);
  result.values = part(series.values, static_cast<std::ptrdiff_t>(series.columns.size()));
  return result;
}

Divisors divisors_or_end(const JobData& job, const Series& series) {
  try {
    return dimensionless_divisors(job.scene(), series);
  } catch (const std::invalid_argument& error) {
    throw CommandEnd(ExitCode::usage, fmt::format("--dimensionless: {}", error.what()));
  }
}

/// To the time and the number of samples that were asked for.
void cut(View& view, const SensorArguments& arguments) {
  const double infinity = std::numeric_limits<double>::infinity();
  view.series = samples_within(view.series, arguments.from.value_or(-infinity),
                               arguments.to.value_or(infinity));
  view.samples = view.series.size();
  if (!arguments.max_points) return;
  view.series = decimate(view.series, static_cast<std::size_t>(*arguments.max_points));
}

View make_view(const JobData& job, const Series& raw, const SensorArguments& arguments) {
  View view{raw, raw.size(), {}};
  if (arguments.filter == FilterKind::gaussian) {
    view.series = filtered(raw, *arguments.tau);
    if (!job.completed() && raw.size() > 0) {
      view.provisional_after = provisional_after(raw, *arguments.tau);
    }
  }
  cut(view, arguments);
  if (arguments.dimensionless) {
    const Divisors divisors = divisors_or_end(job, raw);
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
  object["samples"] = view.samples;
  object["decimated"] = view.samples != series.size();
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
  if (format == Format::csv) fmt::print("name,kind,samples,first_s,last_s,mean_interval_s\n");
  for (const Series& series : all) {
    const bool empty = series.size() == 0;
    const Json first = empty ? Json(nullptr) : Json(series.time.front());
    const Json last = empty ? Json(nullptr) : Json(series.time.back());
    const auto mean = series.mean_interval();
    if (format == Format::csv) {
      fmt::print("{},{},{},{},{},{}\n", csv_field(series.name), series.kind, series.size(),
                 empty ? "" : first.dump(), empty ? "" : last.dump(),
                 mean ? Json(*mean).dump() : "");
    }
    list.push_back(Json{{"name", series.name},
                        {"kind", series.kind},
                        {"samples", series.size()},
                        {"first", first},
                        {"last", last},
                        {"mean_interval", mean ? Json(*mean) : Json(nullptr)}});
  }
  if (format == Format::json) fmt::print("{}\n", list.dump(2));
}

/// What belongs to one series says nothing about the list of all.
void require_name(const SensorArguments& arguments) {
  if (!arguments.name.empty()) return;
  const auto belongs = [](bool given, std::string_view option) {
    if (!given) return;
    throw CommandEnd(
        ExitCode::usage,
        fmt::format("{} goes with the name of a sensor; without it all are listed", option));
  };
  belongs(arguments.filter == FilterKind::gaussian, "--filter");
  belongs(arguments.tau.has_value(), "--tau");
  belongs(arguments.dimensionless, "--dimensionless");
  belongs(arguments.from.has_value(), "--from");
  belongs(arguments.to.has_value(), "--to");
  belongs(arguments.max_points.has_value(), "--max-points");
}

void require_sense(const SensorArguments& arguments) {
  require_name(arguments);
  const bool gaussian = arguments.filter == FilterKind::gaussian;
  if (gaussian && !arguments.tau) {
    throw CommandEnd(ExitCode::usage,
                     "--filter gaussian needs --tau SECONDS; the paper's case "
                     "is shown with 0.002");
  }
  if (!gaussian && arguments.tau) {
    throw CommandEnd(ExitCode::usage, "--tau goes with --filter gaussian");
  }
  if (arguments.from && arguments.to && *arguments.from > *arguments.to) {
    throw CommandEnd(ExitCode::usage, "--from must not be later than --to");
  }
}

void show_sensors(SensorArguments arguments) {
  require_sense(arguments);
  if (is_of_service(arguments.service, arguments.of_service, arguments.target)) {
    return show_service_sensors(arguments);
  }
  require_folder(arguments.target);
  const JobData job(arguments.target);
  const std::vector<Series> all = job.series();
  if (arguments.name.empty()) return list_sensors(all, arguments.format);
  const View view = make_view(job, find_series(all, arguments.name), arguments);
  if (arguments.format == Format::csv) {
    note_samples_left_out(view.series.size(), view.samples);
    fmt::print("{}", csv_of(view, arguments.dimensionless));
  } else {
    fmt::print("{}\n", json_of(view, arguments).dump());
  }
}

}  // namespace

void add_sensors(CLI::App& app) {
  auto arguments = std::make_shared<SensorArguments>();
  CLI::App* verb = app.add_subcommand("sensors", "Print a job's sensors, or the series of one");
  verb->add_option("target", arguments->target, "The job's folder, or the job's id at a service")
      ->required();
  verb->add_option("name", arguments->name, "The sensor; without one, all are listed");
  const std::map<std::string, FilterKind> filters{{"none", FilterKind::none},
                                                  {"gaussian", FilterKind::gaussian}};
  verb->add_option("--filter", arguments->filter, "Low-pass filter in time (eq. 12)")
      ->transform(one_of(filters));
  verb->add_option("--tau", arguments->tau, "Its smoothing time, s")
      ->check(number_above_zero())
      ->check(number_between(1e-9, 1e6));
  verb->add_flag("--dimensionless", arguments->dimensionless,
                 "T, X, H and P of eqs. 19-22 by the scene's scales");
  const std::map<std::string, Format> formats{{"csv", Format::csv}, {"json", Format::json}};
  CLI::Option* format =
      verb->add_option("--format", arguments->format, "csv by default")->transform(one_of(formats));
  verb->add_flag_callback(
          "--json", [arguments] { arguments->format = Format::json; }, "The same as --format json")
      ->excludes(format);
  add_service_sensor_options(*verb, *arguments);
  verb->footer(
      "Example: sluice sensors dambreak-quick P1 --filter gaussian --tau 0.002\n"
      "         sluice sensors j0r2mt1q8kq0f7a3c1d2e P1 --server http://127.0.0.1:8080");
  verb->callback([arguments] { show_sensors(*arguments); });
}

}  // namespace sluice

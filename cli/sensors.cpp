#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "cli/checks.hpp"
#include "cli/job_data.hpp"
#include "cli/scene_file.hpp"
#include "cli/sensors.hpp"
#include "cli/verbs.hpp"
#include "engine/store/read/dimensionless.hpp"
#include "engine/store/read/series_view.hpp"
#include "engine/study/table.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

Scene scene_or_end(const JobReader& job) {
  return job_scene_or_end(job.scene_text(), job.paths().scene());
}

Divisors divisors_or_end(const JobReader& job, const Series& series) {
  try {
    return dimensionless_divisors(scene_or_end(job), series);
  } catch (const std::invalid_argument& error) {
    throw CommandEnd(ExitCode::usage, fmt::format("--dimensionless: {}", error.what()));
  }
}

SeriesQuery query_of(const JobReader& job, const Series& raw, const SensorArguments& arguments) {
  SeriesQuery query;
  query.from = arguments.from;
  query.to = arguments.to;
  if (arguments.filter == FilterKind::gaussian) query.tau = arguments.tau;
  if (arguments.max_points) query.max_points = static_cast<std::size_t>(*arguments.max_points);
  if (arguments.dimensionless) query.divisors = divisors_or_end(job, raw);
  return query;
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
  const JobReader job = job_or_end(arguments.target);
  const std::vector<Series> all = job.series();
  if (all.empty() && !scene_or_end(job).sensors.empty()) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("{} has no samples yet: it did not run", arguments.target));
  }
  if (arguments.name.empty()) return list_sensors(all, arguments.format);
  const Series& raw = find_series(all, arguments.name);
  const SeriesQuery query = query_of(job, raw, arguments);
  const SeriesView view =
      make_view(raw, query, job.completed() ? SeriesState::final : SeriesState::growing);
  if (arguments.format == Format::json) {
    fmt::print("{}", json_text(view, query));
    return;
  }
  note_samples_left_out(view.series.size(), view.samples);
  fmt::print("{}", csv_text(view, query));
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

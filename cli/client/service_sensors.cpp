#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "cli/checks.hpp"
#include "cli/client/job_names.hpp"
#include "cli/json_text.hpp"
#include "cli/sensors.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFarthest = 1e9;  // s; what a service takes, and so a folder too

std::string series_target(const std::string& id, const SensorArguments& arguments) {
  std::string query = fmt::format("?format={}", arguments.format == Format::csv ? "csv" : "json");
  const auto add = [&query](std::string_view name, const auto& value) {
    if (value) query += fmt::format("&{}={}", name, *value);
  };
  if (arguments.filter == FilterKind::gaussian) query += "&filter=gaussian";
  add("tau", arguments.tau);
  add("from", arguments.from);
  add("to", arguments.to);
  add("max_points", arguments.max_points);
  if (arguments.dimensionless) query += "&dimensionless=1";
  return job_target(id, fmt::format("/sensors/{}{}", percent_encoded(arguments.name), query));
}

void note(const std::string& text) {
  std::fputs(fmt::format("sluice: {}\n", text).c_str(), stderr);
}

/// What stands inside the JSON form and only in the headers of the CSV.
void print_notes(const HttpReply& reply) {
  const std::string samples(reply.header("sluice-samples"));
  const auto lines = std::count(reply.body.begin(), reply.body.end(), '\n');
  const auto all = std::strtoull(samples.c_str(), nullptr, 10);
  if (!samples.empty()) note_samples_left_out(static_cast<std::size_t>(lines - 1), all);
  const std::string after(reply.header("sluice-provisional-after"));
  if (!after.empty()) {
    note(fmt::format("values after {} may still change: the job is not completed",
                     printable(after)));
  }
}

std::string cell(const Json& value) { return value.is_number() ? value.dump() : ""; }

void print_list(const Json& list) {
  fmt::print("name,kind,samples,first_s,last_s,mean_interval_s\n");
  for (const Json& sensor : member(list, "sensors")) {
    fmt::print("{},{},{},{},{},{}\n", text_at(sensor, "name"), text_at(sensor, "kind"),
               count_at(sensor, "samples"), cell(member(sensor, "first")),
               cell(member(sensor, "last")), cell(member(sensor, "mean_interval")));
  }
}

}  // namespace

void add_service_sensor_options(CLI::App& verb, SensorArguments& arguments) {
  const std::string group = "Part of a series";
  add_service_switch(verb, arguments.service, arguments.of_service);
  verb.add_option("--from", arguments.from, "First time, s")
      ->check(any_number())
      ->check(number_between(-kFarthest, kFarthest))
      ->group(group);
  verb.add_option("--to", arguments.to, "Last time, s")
      ->check(any_number())
      ->check(number_between(-kFarthest, kFarthest))
      ->group(group);
  verb.add_option("--max-points", arguments.max_points,
                  "Samples at most, 20000 of a service by default and all of a folder; fewer than "
                  "there are "
                  "keep all extremes")
      ->check(whole_between(10, 200000))
      ->group(group);
}

void note_samples_left_out(std::size_t shown, std::size_t all) {
  if (shown == all) return;
  note(fmt::format("{} of {} samples, with all extremes; see --max-points", shown, all));
}

void show_service_sensors(const SensorArguments& arguments) {
  ServiceClient service(arguments.service);
  const std::string id = job_named(service, arguments.target);
  if (arguments.name.empty()) {
    const HttpReply reply = service.get(job_target(id, "/sensors"));
    if (arguments.format == Format::json) return print_body(reply);
    return print_list(service.object_of(reply));
  }
  const HttpReply reply = service.get(series_target(id, arguments));
  if (arguments.format == Format::csv) print_notes(reply);
  print_body(reply);
}

}  // namespace sluice

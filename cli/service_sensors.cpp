#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/json_text.hpp"
#include "cli/sensors.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

std::string series_target(const SensorArguments& arguments) {
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
  return job_target(arguments.target,
                    fmt::format("/sensors/{}{}", percent_encoded(arguments.name), query));
}

void note(const std::string& text) {
  std::fputs(fmt::format("sluice: {}\n", text).c_str(), stderr);
}

/// What stands inside the JSON form and only in the headers of the CSV.
void print_notes(const HttpReply& reply) {
  const std::string samples(reply.header("sluice-samples"));
  const auto lines = std::count(reply.body.begin(), reply.body.end(), '\n');
  if (!samples.empty() && samples != fmt::format("{}", lines - 1)) {
    note(fmt::format("{} of {} samples, with all extremes; see --max-points", lines - 1,
                     printable(samples)));
  }
  const std::string after(reply.header("sluice-provisional-after"));
  if (!after.empty()) {
    note(fmt::format("values after {} may still change: the job goes on", printable(after)));
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
  const std::string group = "Of a service";
  add_service_switch(verb, arguments.service, arguments.of_service);
  verb.add_option("--from", arguments.from, "First time, s")->group(group);
  verb.add_option("--to", arguments.to, "Last time, s")->group(group);
  verb.add_option("--max-points", arguments.max_points,
                  "Samples at most, 20000 by default; fewer than there are keep all extremes")
      ->check(CLI::Range(10, 200000))
      ->group(group);
}

void show_service_sensors(const SensorArguments& arguments) {
  ServiceClient service(arguments.service);
  if (arguments.name.empty()) {
    const HttpReply reply = service.get(job_target(arguments.target, "/sensors"));
    if (arguments.format == Format::json) return print_body(reply);
    return print_list(service.object_of(reply));
  }
  const HttpReply reply = service.get(series_target(arguments));
  if (arguments.format == Format::csv) print_notes(reply);
  print_body(reply);
}

}  // namespace sluice

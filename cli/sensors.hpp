#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/client/service_client.hpp"

namespace sluice {

enum class FilterKind { none, gaussian };
enum class Format { csv, json };

/// What `sluice sensors` is asked for. Times in s of model time.
struct SensorArguments {
  std::string target;  ///< a job's folder, or its id at a service
  std::string name;    ///< empty: list all
  FilterKind filter = FilterKind::none;
  std::optional<double> tau;
  bool dimensionless = false;
  Format format = Format::csv;
  bool of_service = false;  ///< --server was given
  ServiceOptions service;
  std::optional<double> from;
  std::optional<double> to;
  std::optional<int> max_points;
};

/// Adds --server, --token-file, --from, --to and --max-points.
void add_service_sensor_options(CLI::App& verb, SensorArguments& arguments);

/// Says on stderr what CSV cannot: that samples were left out, if they were.
void note_samples_left_out(std::size_t shown, std::size_t all);

/// The list or the series of a service's job, in the form of the offline ones; JSON as it came.
/// What CSV cannot say, such as samples left out, goes to stderr.
void show_service_sensors(const SensorArguments& arguments);

}  // namespace sluice

#include "engine/study/report_row.hpp"

#include <string>

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// What stands at a pointer; null where nothing does.
const Json& find(const Json& object, const char* pointer) {
  static const Json nothing;
  const Json::json_pointer place(pointer);
  return object.is_structured() && object.contains(place) ? object.at(place) : nothing;
}

std::optional<double> number_at(const Json& object, const char* pointer) {
  const Json& found = find(object, pointer);
  return found.is_number() ? std::optional(found.get<double>()) : std::nullopt;
}

std::string text_at(const Json& object, const char* pointer) {
  const Json& found = find(object, pointer);
  return found.is_string() ? found.get<std::string>() : std::string{};
}

void add_quantity(StudyRow& row, const std::string& name, const std::optional<double>& value) {
  if (value) row.quantities.emplace_back(name, *value);
}

void add_error(StudyRow& row, const std::string& sensor, const Json& one) {
  if (const auto error = number_at(one, "/relative_l2")) {
    row.sensor_errors.emplace_back(sensor, *error);
  }
}

/// Means over stretches of time, which the chaos after an impact leaves defined; peaks are not.
void take_experiment(StudyRow& row, const Json& report) {
  // "evidence" is the word of reports before.
  const Json& comparison = find(report, report.contains("evidence") ? "/evidence" : "/comparison");
  for (const Json& one : find(comparison, "/pressures")) {
    const std::string sensor = text_at(one, "/sensor");
    add_error(row, sensor, one);
    add_quantity(row, sensor + " impulse", number_at(one, "/simulation/impulse"));
    add_quantity(row, sensor + " plateau", number_at(one, "/simulation/plateau"));
  }
  add_quantity(row, "front delay", number_at(comparison, "/front/delay"));
}

void take_curves(StudyRow& row, const Json& report) {
  const Json& comparison =
      find(report, report.contains("series_evidence") ? "/series_evidence" : "/series_comparison");
  for (const Json& one : find(comparison, "/curves")) {
    const std::string sensor = text_at(one, "/sensor");
    add_error(row, sensor, one);
    add_quantity(row, sensor + " highest", number_at(one, "/highest/value"));
    add_quantity(row, sensor + " mean", number_at(one, "/mean"));
  }
}

/// Without a reference runs can still be compared with each other.
void take_sensors(StudyRow& row, const Json& report) {
  for (const Json& one : find(report, "/sensors")) {
    const std::string column = text_at(one, "/column");
    add_quantity(row, text_at(one, "/name") + (column == "value" ? "" : " " + column) + " mean",
                 number_at(one, "/mean"));
  }
}

}  // namespace

StudyRow row_of_report(const Json& report) {
  StudyRow row;
  row.state = RunState::completed;
  row.error = number_at(report, "/error");
  row.core_seconds = number_at(report, "/cost/core_seconds");
  row.particle_steps_per_second = number_at(report, "/cost/particle_steps_per_second");
  row.steps = number_at(report, "/cost/steps");
  row.particles = number_at(report, "/cost/fluid_particles");
  row.machine = text_at(report, "/cost/machine");
  row.simd_target = text_at(report, "/cost/simd_target");
  take_experiment(row, report);
  take_curves(row, report);
  if (row.error) return row;
  if (row.quantities.empty()) take_sensors(row, report);
  row.reason = "no error: its scene has no reference, or its sensors are not there";
  return row;
}

}  // namespace sluice

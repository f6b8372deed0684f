#include <optional>

#include "engine/study/report.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

Json value_of(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json value_of(const std::optional<Peak>& peak) {
  return peak ? Json{{"time", peak->time}, {"value", peak->value}} : Json(nullptr);
}

Json value_of(const std::optional<Rise>& rise) {
  if (!rise) return nullptr;
  return Json{{"time", rise->time}, {"height", rise->height}, {"base", rise->base}};
}

Json measures_json(const PressureMeasures& measures) {
  return Json{{"arrival", value_of(measures.arrival)},
              {"peak", value_of(measures.peak)},
              {"impulse", value_of(measures.impulse)},
              {"plateau", value_of(measures.plateau)},
              {"second_rise", value_of(measures.second_rise)}};
}

Json pressure_json(const PressureEvidence& one) {
  return Json{{"sensor", one.sensor},
              {"reference", one.reference},
              {"height_m", one.height},
              {"smoothing_length_m", one.smoothing_length},
              {"relative_l2", value_of(one.relative_l2)},
              {"simulation", measures_json(one.simulation)},
              {"experiment", measures_json(one.experiment)},
              {"peak_statistics",
               {{"median", one.peak_statistics.median},
                {"p2.5", one.peak_statistics.low},
                {"p97.5", one.peak_statistics.high}}},
              {"peak_place_in_band", value_of(one.place_in_band())}};
}

Json evidence_json(const Evidence& evidence) {
  Json pressures = Json::array();
  for (const PressureEvidence& one : evidence.pressures) pressures.push_back(pressure_json(one));
  Json levels = Json::array();
  for (const LevelEvidence& one : evidence.levels) {
    levels.push_back({{"sensor", one.sensor},
                      {"reference", one.reference},
                      {"rms_difference", value_of(one.rms_difference)}});
  }
  Json front;
  if (evidence.front) {
    front = {{"sensor", evidence.front->sensor},
             {"rms_difference", value_of(evidence.front->rms_difference)},
             {"delay", value_of(evidence.front->delay)}};
  }
  return Json{{"reference", evidence.reference->name},
              {"title", evidence.reference->title},
              {"citation", evidence.reference->citation},
              {"units", "T = t sqrt(g/h0), P = p/(rho0 g h0), H = h/h0, front (w - w0)/h0"},
              {"tau_s", evidence.tau},
              {"time_unit_s", evidence.time_unit},
              {"pressure_shift", value_of(evidence.shift)},
              {"comparison_window", {kComparisonWindow.from, kComparisonWindow.to}},
              {"mean_relative_l2", value_of(evidence.mean_relative_l2)},
              {"pressures", std::move(pressures)},
              {"levels", std::move(levels)},
              {"front", std::move(front)}};
}

Json sensor_json(const SensorSummary& sensor) {
  return Json{{"name", sensor.name},
              {"kind", sensor.kind},
              {"column", sensor.column},
              {"unit", sensor.unit},
              {"samples", sensor.samples},
              {"first_wet_s", value_of(sensor.first_wet)},
              {"highest", value_of(sensor.highest)},
              {"highest_at_s", value_of(sensor.highest_at)},
              {"last", value_of(sensor.last)}};
}

}  // namespace

Json report_json(const Report& report) {
  Json sensors = Json::array();
  for (const SensorSummary& sensor : report.sensors) sensors.push_back(sensor_json(sensor));
  Json object{{"scene", report.scene.name},
              {"spacing_m", report.scene.method.spacing},
              {"smoothing_length_m", report.scene.method.smoothing_length},
              {"tau_s", report.tau},
              {"sensors", std::move(sensors)}};
  object["evidence"] = report.evidence ? evidence_json(*report.evidence) : Json(nullptr);
  object["outcome"] = report.outcome;
  return object;
}

}  // namespace sluice

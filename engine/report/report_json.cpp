#include <optional>

#include "engine/report/report.hpp"
#include "engine/report/report_tables.hpp"
#include "engine/scene/forecast/plan.hpp"

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

Json pressure_json(const PressureComparison& one) {
  return Json{{"sensor", one.sensor},
              {"reference", one.reference},
              {"height_m", one.height},
              {"smoothing_length_m", one.smoothing_length},
              {"air_pressure_pa", value_of(one.air_pressure)},
              {"relative_l2", value_of(one.relative_l2)},
              {"relative_l2_not_shifted", value_of(one.relative_l2_not_shifted)},
              {"simulation", measures_json(one.simulation)},
              {"experiment", measures_json(one.experiment)},
              {"peak_statistics",
               {{"median", one.peak_statistics.median},
                {"p2.5", one.peak_statistics.low},
                {"p97.5", one.peak_statistics.high}}},
              {"peak_place_in_band", value_of(one.place_in_band())}};
}

Json comparison_json(const Comparison& comparison) {
  Json pressures = Json::array();
  for (const PressureComparison& one : comparison.pressures)
    pressures.push_back(pressure_json(one));
  Json levels = Json::array();
  for (const LevelComparison& one : comparison.levels) {
    levels.push_back({{"sensor", one.sensor},
                      {"reference", one.reference},
                      {"rms_difference", value_of(one.rms_difference)}});
  }
  Json front;
  if (comparison.front) {
    front = {{"sensor", comparison.front->sensor},
             {"rms_difference", value_of(comparison.front->rms_difference)},
             {"delay", value_of(comparison.front->delay)}};
  }
  return Json{{"reference", comparison.reference->name},
              {"title", comparison.reference->title},
              {"citation", comparison.reference->citation},
              {"units", "T = t sqrt(g/h0), P = p/(rho0 g h0), H = h/h0, front (w - w0)/h0"},
              {"tau_s", comparison.tau},
              {"time_unit_s", comparison.time_unit},
              {"pressure_shift", value_of(comparison.shift)},
              {"comparison_window",
               {comparison.reference->measures.comparison.from,
                comparison.reference->measures.comparison.to}},
              {"mean_relative_l2", value_of(comparison.mean_relative_l2)},
              {"mean_relative_l2_not_shifted", value_of(comparison.mean_relative_l2_not_shifted)},
              {"pressures", std::move(pressures)},
              {"levels", std::move(levels)},
              {"front", std::move(front)}};
}

Json curves_json(const SeriesComparison& comparison) {
  Json curves = Json::array();
  for (const CurveComparison& one : comparison.curves) {
    curves.push_back({{"sensor", one.sensor},
                      {"unit", one.unit},
                      {"relative_l2", value_of(one.relative_l2)},
                      {"rms_difference", value_of(one.rms_difference)},
                      {"highest", value_of(one.simulated_peak)},
                      {"expected_highest", value_of(one.expected_peak)}});
  }
  return Json{{"title", comparison.title},
              {"citation", comparison.citation},
              {"units", comparison.units == ReferenceUnits::si ? "si" : "dimensionless"},
              {"tau_s", comparison.tau},
              {"shift", 0.0},
              {"mean_relative_l2", value_of(comparison.mean_relative_l2)},
              {"curves", std::move(curves)}};
}

/// Fluid particles at the start, wherever they are now.
std::optional<double> particles_of(const RunFacts& facts) {
  if (!facts.particles) return std::nullopt;
  return *facts.particles + facts.overtopped.value_or(0.0) + facts.leaked.value_or(0.0) +
         facts.excluded.value_or(0.0);
}

Json cost_json(const RunFacts& facts) {
  Json passes = Json::array();
  for (const PassCost& pass : facts.passes) {
    passes.push_back({{"name", pass.name}, {"seconds", pass.seconds}, {"share", pass.share}});
  }
  return Json{{"core_seconds", value_of(facts.core_seconds)},
              {"core_seconds_scaled_from_last_attempt", facts.core_seconds_scaled},
              {"seconds_of_last_attempt", value_of(facts.seconds)},
              {"particle_steps_per_second", value_of(facts.particle_steps_per_second)},
              {"steps", value_of(facts.step)},
              {"fluid_particles", value_of(particles_of(facts))},
              {"threads", value_of(facts.threads)},
              {"machine", facts.machine},
              {"simd_target", facts.simd_target},
              {"passes", std::move(passes)}};
}

Json conservation_json(const Conservation& kept) {
  return Json{{"energy_scale_J_per_m", value_of(kept.energy_scale)},
              {"energy_at_start_J_per_m", value_of(kept.first_energy)},
              {"energy_at_end_J_per_m", value_of(kept.last_energy)},
              {"highest_energy_J_per_m", value_of(kept.highest_energy)},
              {"share_of_mass_that_left", value_of(kept.lost_mass)}};
}

Json extremes_json(const RunFacts& facts) {
  return Json{{"max_speed_m_per_s", value_of(facts.max_speed)},
              {"min_density_ratio", value_of(facts.min_density_ratio)},
              {"max_density_ratio", value_of(facts.max_density_ratio)},
              {"min_time_step_s", value_of(facts.min_time_step)},
              {"max_neighbours", value_of(facts.max_neighbours)}};
}

Json left_out_json(const Scene& scene) {
  Json all = Json::array();
  const Plan parts = plan(scene);
  for (const auto* items :
       {&parts.passes_left_out, &parts.fields_left_out, &parts.files_left_out}) {
    for (const PlanItem& item : *items) all.push_back({{"name", item.name}, {"why", item.reason}});
  }
  return all;
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
              {"lowest", value_of(sensor.lowest)},
              {"lowest_at_s", value_of(sensor.lowest_at)},
              {"last", value_of(sensor.last)},
              {"mean", value_of(sensor.mean)}};
}

}  // namespace

Json report_json(const Report& report) {
  Json sensors = Json::array();
  for (const SensorSummary& sensor : report.sensors) sensors.push_back(sensor_json(sensor));
  Json object{{"scene", report.scene.name},
              {"description", report.scene.description},
              {"scheme", scheme_text(report.scene)},
              {"spacing_m", report.scene.method.spacing},
              {"smoothing_length_m", report.scene.method.smoothing_length},
              {"tau_s", report.tau},
              {"sensors", std::move(sensors)}};
  object["comparison"] = report.comparison ? comparison_json(*report.comparison) : Json(nullptr);
  object["series_comparison"] =
      report.series_comparison ? curves_json(*report.series_comparison) : Json(nullptr);
  object["error"] = value_of(report.error());
  object["cost"] = cost_json(report.facts);
  object["conservation"] = conservation_json(report.conservation);
  object["extremes"] = extremes_json(report.facts);
  object["left_out"] = left_out_json(report.scene);
  object["outcome"] = report.outcome;
  return object;
}

}  // namespace sluice

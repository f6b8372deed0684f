#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "engine/report/report_tables.hpp"
#include "engine/run/guards.hpp"
#include "engine/scene/forecast/plan.hpp"
#include "engine/scene/model/vocabulary.hpp"
#include "engine/space/axes.hpp"
#include "engine/sph/stability/neighbour_count.hpp"

namespace sluice {
namespace {

std::string or_none(const std::string& text) { return text.empty() ? "-" : text; }

std::optional<double> ratio(const std::optional<double>& value, const std::optional<double>& unit) {
  if (!value || !unit || !(*unit > 0.0)) return std::nullopt;
  return *value / *unit;
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.3g} %", 100.0 * *share) : "-";
}

/// They are counted only where the lists say that they may be more.
std::string neighbours_text(const std::optional<double>& most, int dimensions) {
  if (!most) return "-";
  return *most > 0.0 ? brief(*most, 6)
                     : fmt::format("not counted: never above {}", many_neighbours(dimensions));
}

/// What the kinds among the sensors mean, where a word may be taken for something else.
std::string definitions_of(const std::vector<SensorSummary>& sensors) {
  std::string text;
  for (const SensorKind kind : {SensorKind::surface_height, SensorKind::surge_front}) {
    const std::string_view word = word_for(kSensorWords, kind);
    if (std::none_of(sensors.begin(), sensors.end(),
                     [&](const SensorSummary& one) { return one.kind == word; })) {
      continue;
    }
    for (const auto& each : kSensorWords) {
      if (each.value == kind) text += fmt::format("; {}: {}", word, each.about);
    }
  }
  return text;
}

Table sensor_table(const Report& report) {
  Table table;
  table.title = "Sensors";
  table.note = fmt::format("pressures filtered with tau = {:g} ms{}", report.tau * 1e3,
                           definitions_of(report.sensors));
  table.head = {"sensor",      "kind",    "column", "unit",   "samples",
                "wet from, s", "highest", "at, s",  "lowest", "at, s"};
  for (const SensorSummary& one : report.sensors) {
    table.rows.push_back({one.name, one.kind, one.column, one.unit, fmt::format("{}", one.samples),
                          cell(one.first_wet, 4), brief(one.highest, 5), cell(one.highest_at, 4),
                          brief(one.lowest, 5), cell(one.lowest_at, 4)});
  }
  return table;
}

Table run_table(const RunFacts& facts) {
  Table table;
  table.title = "Run";
  table.head = {"", ""};
  const auto add = [&](std::string name, std::string value) {
    table.rows.push_back({std::move(name), std::move(value)});
  };
  add("state", facts.state.empty() ? "the run has not ended yet: no outcome.json" : facts.state);
  if (facts.state.empty()) return table;
  if (!facts.reason.empty()) add("reason", facts.reason);
  add("steps", brief(facts.step, 12));
  add("time, s", brief(facts.time, 6));
  add("fluid and wall particles",
      fmt::format("{} and {}", brief(facts.particles, 12), brief(facts.wall_particles, 12)));
  add(facts.core_seconds_scaled ? "core-seconds (last attempt's cost per step times all steps)"
                                : "core-seconds",
      cell(facts.core_seconds, 2));
  add("wall time of the last attempt, s", cell(facts.seconds, 2));
  add("threads", brief(facts.threads, 6));
  const auto rate = facts.particle_steps_per_second;
  add("million fluid-particle steps per second of wall time",
      cell(rate ? std::optional(*rate * 1e-6) : std::nullopt, 2));
  add("machine", or_none(facts.machine));
  add("SIMD target", or_none(facts.simd_target));
  add("build", or_none(facts.build));
  return table;
}

Table pass_table(const RunFacts& facts) {
  Table table;
  table.title = "Time per pass, last attempt";
  table.head = {"pass", "s", "%"};
  for (const PassCost& pass : facts.passes) {
    table.rows.push_back({or_none(pass.name), cell(pass.seconds, 3), cell(100.0 * pass.share, 1)});
  }
  return table;
}

Table conservation_table(const Report& report) {
  const Conservation& kept = report.conservation;
  const RunFacts& facts = report.facts;
  const GuardLimits limits = GuardLimits::for_method(report.scene.method);
  const auto drift = [&](const std::optional<double>& energy) -> std::optional<double> {
    if (!energy || !kept.first_energy) return std::nullopt;
    return ratio(*energy - *kept.first_energy, kept.energy_scale);
  };
  Table table;
  table.title = "Conservation and guards";
  table.note = fmt::format(
      "energies in {}; the energy scale is what the fluid brings: "
      "kinetic and internal energy and its height above its lowest point",
      energy_unit(report.scene.dimensions()));
  table.head = {"", "value", "the run fails beyond"};
  table.rows = {
      {"energy scale", brief(kept.energy_scale, 5), "-"},
      {"energy at the start", brief(kept.first_energy, 5), "-"},
      {"energy at the end", brief(kept.last_energy, 5), "-"},
      {"energy drift over the scale", percent(drift(kept.last_energy)), "-"},
      {"highest growth over the scale", percent(drift(kept.highest_energy)), "5 %"},
      {"mass that left (overtopped, leaked, excluded)",
       fmt::format("{} ({}, {}, {})", percent(kept.lost_mass), brief(facts.overtopped, 12),
                   brief(facts.leaked, 12), brief(facts.excluded, 12)),
       "1 % leaked, 0.5 % excluded"},
      {"highest speed over sound speed",
       cell(ratio(facts.max_speed, report.scene.method.sound_speed)), "excluded above 1"},
      {"lowest density over reference", cell(facts.min_density_ratio, 4), "excluded below 0.7"},
      {"highest density over reference", cell(facts.max_density_ratio, 4), "excluded above 1.3"},
      {"shortest step, s", brief(facts.min_time_step, 4), "-"},
      {"most neighbours of a particle",
       neighbours_text(facts.max_neighbours, report.scene.dimensions()),
       brief(limits.neighbours, 4)}};
  return table;
}

Table left_out_table(const Scene& scene) {
  Table table;
  table.title = "Left out";
  table.head = {"what", "why"};
  const Plan parts = plan(scene);
  for (const auto* items :
       {&parts.passes_left_out, &parts.fields_left_out, &parts.files_left_out}) {
    for (const PlanItem& item : *items) table.rows.push_back({item.name, item.reason});
  }
  return table;
}

Table digest_table(const RunFacts& facts) {
  Table table;
  table.title = "Digests";
  table.note =
      "SHA-256; equal for the same scene, build and SIMD target, whatever the threads and "
      "interruptions";
  table.head = {"of", "SHA-256"};
  table.rows.push_back({"physics", or_none(facts.physics_digest)});
  for (const auto& [name, digest] : facts.series_digests) table.rows.push_back({name, digest});
  return table;
}

}  // namespace

std::vector<Table> run_tables(const Report& report) {
  std::vector<Table> tables;
  if (!report.sensors.empty()) tables.push_back(sensor_table(report));
  tables.push_back(run_table(report.facts));
  if (report.facts.state.empty()) return tables;
  if (!report.facts.passes.empty()) tables.push_back(pass_table(report.facts));
  tables.push_back(conservation_table(report));
  tables.push_back(left_out_table(report.scene));
  tables.push_back(digest_table(report.facts));
  return tables;
}

}  // namespace sluice

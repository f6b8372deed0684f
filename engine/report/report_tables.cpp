#include "engine/report/report_tables.hpp"

#include <fmt/format.h>

#include <functional>

#include "engine/scene/format/term_line.hpp"
#include "engine/scene/model/vocabulary.hpp"

namespace sluice {
namespace {

using Getter = std::function<std::optional<double>(const PressureMeasures&)>;

std::optional<double> peak_time(const std::optional<Peak>& peak) {
  return peak ? std::optional(peak->time) : std::nullopt;
}
std::optional<double> peak_value(const std::optional<Peak>& peak) {
  return peak ? std::optional(peak->value) : std::nullopt;
}
std::optional<double> rise_time(const std::optional<Rise>& rise) {
  return rise ? std::optional(rise->time) : std::nullopt;
}
std::optional<double> rise_height(const std::optional<Rise>& rise) {
  return rise ? std::optional(rise->height) : std::nullopt;
}

std::string whole_percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.0f} %", 100.0 * *share) : "-";
}

/// Rows of a table with a column per sensor.
class PressureRows {
 public:
  explicit PressureRows(const std::vector<PressureComparison>& all) : all_(all) {}

  void add(std::string label, const std::string& who,
           const std::function<std::string(const PressureComparison&)>& text) {
    std::vector<std::string> row{std::move(label), who};
    for (const PressureComparison& one : all_) row.push_back(text(one));
    rows_.push_back(std::move(row));
  }
  void both(const std::string& label, const Getter& get) {
    add(label, "simulation", [&](const auto& one) { return cell(get(one.simulation)); });
    add("", "experiment", [&](const auto& one) { return cell(get(one.experiment)); });
  }
  std::vector<std::vector<std::string>> take() { return std::move(rows_); }

 private:
  const std::vector<PressureComparison>& all_;
  std::vector<std::vector<std::string>> rows_;
};

void add_peaks(PressureRows& rows) {
  rows.add("first peak, P", "simulation",
           [](const auto& one) { return cell(peak_value(one.simulation.peak)); });
  rows.add("", "median of tests", [](const auto& one) { return cell(one.peak_statistics.median); });
  rows.add("", "2.5-97.5 % of tests", [](const auto& one) {
    return fmt::format("{:.2f}-{:.2f}", one.peak_statistics.low, one.peak_statistics.high);
  });
  rows.add("place in that band (0-100 %)", "simulation",
           [](const auto& one) { return whole_percent(one.place_in_band()); });
  rows.add("first peak, T", "simulation",
           [](const auto& one) { return cell(peak_time(one.simulation.peak)); });
}

std::string shift_text(const Comparison& comparison) {
  return comparison.shift ? fmt::format("{:+.3f}", *comparison.shift) : "-";
}

Table pressure_table(const Comparison& comparison) {
  const auto& all = comparison.pressures;
  Table table;
  table.title = "Pressures";
  table.note = "P = p/(rho0 g h0), T = t sqrt(g/h0)";
  table.head = {"", ""};
  for (const PressureComparison& one : all) table.head.push_back(one.sensor);
  PressureRows rows(all);
  rows.add("height above the floor, mm", "",
           [](const auto& one) { return fmt::format("{:g}", one.height * 1e3); });
  rows.add("h of the sensor, mm", "",
           [](const auto& one) { return fmt::format("{:g}", one.smoothing_length * 1e3); });
  rows.add("air around it, Pa (-: eq. 11)", "",
           [](const auto& one) { return cell(one.air_pressure); });
  rows.add(fmt::format("relative L2, shifted by {} T", shift_text(comparison)), "",
           [](const auto& one) { return cell(one.relative_l2); });
  rows.add("relative L2, not shifted", "",
           [](const auto& one) { return cell(one.relative_l2_not_shifted); });
  rows.both("arrival, T (equal at the first sensor: the shift makes it so)",
            [](const auto& m) { return m.arrival; });
  add_peaks(rows);
  rows.both("impulse, P T", [](const auto& m) { return m.impulse; });
  const Window plateau = comparison.reference->measures.plateau;
  rows.both(fmt::format("plateau (T {:.4g}-{:.4g}), P", plateau.from, plateau.to),
            [](const auto& m) { return m.plateau; });
  rows.both("second rise, T", [](const auto& m) { return rise_time(m.second_rise); });
  rows.both("second rise, P", [](const auto& m) { return rise_height(m.second_rise); });
  table.rows = rows.take();
  return table;
}

Table kinematics_table(const Comparison& comparison) {
  Table table;
  table.title = "Surface levels and surge front";
  table.note =
      "levels h/h0, front (w - w0)/h0; not shifted; delay: how much later the simulated "
      "front passes the same places, T";
  table.head = {"sensor", "experiment's", "rms difference", "delay"};
  for (const LevelComparison& one : comparison.levels) {
    table.rows.push_back({one.sensor, one.reference, cell(one.rms_difference), "-"});
  }
  if (comparison.front) {
    table.rows.push_back({comparison.front->sensor, "front", cell(comparison.front->rms_difference),
                          cell(comparison.front->delay)});
  }
  return table;
}

Table curve_table(const SeriesComparison& comparison) {
  Table table;
  table.title = "Sensors against the scene's reference";
  table.head = {"sensor",  "unit",     "relative L2", "rms difference",
                "highest", "expected", "at",          "expected at"};
  for (const CurveComparison& one : comparison.curves) {
    table.rows.push_back({one.sensor, one.unit.empty() ? "-" : one.unit, brief(one.relative_l2),
                          brief(one.rms_difference), brief(peak_value(one.simulated_peak)),
                          brief(peak_value(one.expected_peak)),
                          brief(peak_time(one.simulated_peak)),
                          brief(peak_time(one.expected_peak))});
  }
  return table;
}

void add_comparison_lines(std::vector<std::string>& lines, const Comparison& comparison) {
  const Reference& reference = *comparison.reference;
  lines.push_back(fmt::format("experiment: {}", reference.title));
  lines.push_back(reference.citation);
  lines.push_back(fmt::format(
      "T = t sqrt(g/h0), one T is {:.4f} s; pressures: time filter tau = {:g} ms, dry counts as P "
      "= 0, shifted by {} T, which makes the first sensor arrive as measured; averages over the "
      "figure's intervals, compared over {:g} < T < {:g}",
      comparison.time_unit, comparison.tau * 1e3, shift_text(comparison),
      reference.measures.comparison.from, reference.measures.comparison.to));
  lines.push_back(fmt::format("mean relative L2 of {}: {} shifted by {} T, {} not shifted",
                              reference.pressures_text(), cell(comparison.mean_relative_l2),
                              shift_text(comparison),
                              cell(comparison.mean_relative_l2_not_shifted)));
}

void add_series_lines(std::vector<std::string>& lines, const SeriesComparison& comparison) {
  lines.push_back(fmt::format("reference: {}", comparison.title));
  if (!comparison.citation.empty()) lines.push_back(comparison.citation);
  lines.push_back(fmt::format(
      "averages over the reference's intervals, not shifted; pressures: time filter tau = {:g} ms",
      comparison.tau * 1e3));
  lines.push_back(fmt::format("mean relative L2: {}", brief(comparison.mean_relative_l2)));
}

bool holds_at_walls(const Method& method) {
  bool found = false;
  for_each_term(RateTerms{}, [&]<class Term>() {
    found |= Term::kSummation.holds_at_walls && method.term<Term>();
  });
  return found;
}

}  // namespace

std::string scheme_text(const Scene& scene) {
  const Method& method = scene.method;
  std::string text =
      fmt::format("{}, {}, precision {}, C = {:g}", word_for(kKernelWords, method.kernel),
                  word_for(kIntegratorWords, method.integrator),
                  word_for(kPrecisionWords, method.precision), method.courant);
  const auto add = [&]<class Term>() {
    const auto& term = method.term<Term>();
    if (term) text += ", " + filled_in(term->in_report(), *term);
  };
  for_each_term(RateTerms{}, add);
  if ((scene.tank || !scene.obstacles.empty()) && !holds_at_walls(method)) text += ", free slip";
  if (method.wall_pressure == WallPressure::clamped) text += ", wall pressure clamped";
  for_each_term(Corrections{}, add);
  if (scene.gate) text += fmt::format(", gate lifted at {:g} m/s", scene.gate->speed);
  return text;
}

std::vector<std::string> report_lines(const Report& report) {
  const Method& method = report.scene.method;
  std::vector<std::string> lines;
  if (!report.scene.description.empty()) lines.push_back(report.scene.description);
  lines.push_back(fmt::format("spacing {:g} mm, h = {:g} mm, c = {:.4g} m/s", method.spacing * 1e3,
                              method.smoothing_length * 1e3, method.sound_speed));
  lines.push_back(scheme_text(report.scene));
  if (report.comparison) add_comparison_lines(lines, *report.comparison);
  if (report.series_comparison) add_series_lines(lines, *report.series_comparison);
  if (!report.comparison && !report.series_comparison) {
    lines.push_back("no experiment in the program matches this scene, and it names no reference");
  }
  return lines;
}

std::vector<Table> comparison_tables(const Report& report) {
  std::vector<Table> tables;
  if (report.comparison) {
    const Comparison& comparison = *report.comparison;
    if (!comparison.pressures.empty()) tables.push_back(pressure_table(comparison));
    if (!comparison.levels.empty() || comparison.front)
      tables.push_back(kinematics_table(comparison));
  }
  if (report.series_comparison) tables.push_back(curve_table(*report.series_comparison));
  return tables;
}

std::vector<Table> report_tables(const Report& report) {
  std::vector<Table> tables = comparison_tables(report);
  for (Table& table : run_tables(report)) tables.push_back(std::move(table));
  return tables;
}

}  // namespace sluice

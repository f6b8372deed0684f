#include "engine/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "engine/store/read/filter.hpp"

namespace sluice {
namespace {

constexpr std::string_view kTimeLabel = "T = t √(g/h₀)";

std::string id_of(std::string_view kind, std::size_t number) {
  return fmt::format("{}-{}", kind, number);
}

ChartLine simulation_line(const Curve& curve) {
  return {"simulation", Ink::simulation, curve.time, curve.value};
}

/// Values whose place on the x axis is drawn.
void add_drawn(std::vector<double>& to, const Axis& axis, const std::vector<double>& x,
               const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (x[i] >= axis.low && x[i] <= axis.high) to.push_back(values[i]);
  }
}

/// The y axis for what the x axis shows.
void fit_height(Chart& chart) {
  std::vector<double> y;
  for (const ChartLine& line : chart.lines) add_drawn(y, chart.x, line.x, line.y);
  for (const ChartBand& band : chart.bands) {
    add_drawn(y, chart.x, band.x, band.low);
    add_drawn(y, chart.x, band.x, band.high);
  }
  for (const ChartMarks& marks : chart.marks) {
    for (const auto* values : {&marks.y, &marks.low, &marks.high}) {
      add_drawn(y, chart.x, marks.x, *values);
    }
  }
  fit_axis(chart.y, y);
}

void fit(Chart& chart) {
  std::vector<double> x;
  for (const ChartLine& line : chart.lines) x.insert(x.end(), line.x.begin(), line.x.end());
  for (const ChartMarks& marks : chart.marks) x.insert(x.end(), marks.x.begin(), marks.x.end());
  hold_axis(chart.x, x);
  fit_height(chart);
}

/// The paper's figure 5: X = w/w0.
Chart front_chart(const Scene& scene, const Comparison& comparison) {
  const double ratio = scene.scales->height / scene.scales->width;
  const auto scaled = [&](Curve curve) {
    for (double& value : curve.value) value = 1.0 + value * ratio;
    return curve;
  };
  const Curve measured = scaled(comparison.reference->front);
  Chart chart;
  chart.id = "front";
  chart.title = "Surge front";
  const Window axis = comparison.reference->measures.front_axis;
  chart.x = {std::string(kTimeLabel), axis.from, axis.to};
  chart.y.label = "X = w/w₀";
  chart.lines.push_back(simulation_line(scaled(comparison.front->simulated)));
  chart.marks.push_back({"experiment", Ink::experiment, measured.time, measured.value, {}, {}, {}});
  fit_height(chart);
  return chart;
}

/// Figures 6 to 9: as far as the experiment goes, where the splashes of the rolling wave begin.
Chart level_chart(const LevelComparison& level, const Reference& reference, std::size_t number) {
  Chart chart;
  chart.id = id_of("level", number);
  chart.title = fmt::format("Surface level at {}", level.sensor);
  chart.x = {std::string(kTimeLabel), 0.0, reference.level_times.centers().back() + 0.5};
  chart.y.label = "H = h/h₀";
  chart.lines.push_back(simulation_line(level.simulated));
  for (const LevelReference& one : reference.levels) {
    if (one.name != level.reference) continue;
    const auto times = reference.level_times.centers();
    chart.marks.push_back({"experiment, mean of the tests",
                           Ink::experiment,
                           {times.begin(), times.end()},
                           one.values,
                           {},
                           {},
                           {}});
  }
  fit_height(chart);
  return chart;
}

/// The tests' percentiles of the first peak, drawn where the one test that is shown has its own.
ChartMarks peak_marks(const PressureReference& sensor, const Reference& reference) {
  const auto times = reference.pressure_times.centers();
  std::size_t at = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (reference.measures.impact.contains(times[k]) && sensor.values[k] > sensor.values[at])
      at = k;
  }
  return {fmt::format("peaks of {} tests: median, 2.5–97.5 %", reference.peak_tests),
          Ink::second,
          {times[at]},
          {sensor.peak.median},
          {sensor.peak.low},
          {sensor.peak.high},
          {}};
}

/// Figures 10 to 13.
Chart pressure_chart(const PressureComparison& pressure, const Comparison& comparison,
                     std::size_t number) {
  const Reference& reference = *comparison.reference;
  const auto times = reference.pressure_times.centers();
  Chart chart;
  chart.id = id_of("pressure", number);
  chart.title = fmt::format("Pressure at {}, {:g} mm above the floor", pressure.sensor,
                            pressure.height * 1e3);
  const Window axis = reference.measures.pressure_axis;
  chart.x = {std::string(kTimeLabel), axis.from, axis.to};
  chart.y.label = "P = p/(ρ₀ g h₀)";
  chart.lines.push_back(simulation_line(pressure.simulated));
  if (comparison.shift)
    chart.lines[0].name += fmt::format(", shifted {:+.3f} T", *comparison.shift);
  for (const PressureReference& one : reference.pressures) {
    if (one.name != pressure.reference) continue;
    const std::vector<double> x(times.begin(), times.end());
    chart.lines.push_back({"experiment, one test", Ink::experiment, x, one.values});
    if (one.band) chart.bands.push_back({"2.5–97.5 % of tests", x, one.band->low, one.band->high});
    chart.marks.push_back(peak_marks(one, reference));
  }
  fit_height(chart);
  return chart;
}

/// The words for a sensor's kind in a heading.
std::string quantity_of(std::string kind) {
  std::replace(kind.begin(), kind.end(), '_', ' ');
  return kind;
}

std::string heading_of(const std::string& name, const std::string& quantity) {
  return name == quantity ? name : fmt::format("{}: {}", name, quantity);
}

Chart curve_chart(const CurveComparison& one, const SeriesComparison& comparison,
                  std::size_t number) {
  const bool plain = comparison.units == ReferenceUnits::si;
  Chart chart;
  chart.id = id_of("curve", number);
  const std::string quantity = quantity_of(one.kind);
  chart.title = heading_of(one.sensor, quantity);
  chart.x.label = plain ? "time t, s" : std::string(kTimeLabel);
  chart.y.label = plain ? fmt::format("{}, {}", quantity, one.unit)
                        : fmt::format("{}, dimensionless", quantity);
  chart.lines.push_back(simulation_line(one.simulated));
  if (one.expected.time.size() > 60) {
    chart.lines.push_back({"reference", Ink::experiment, one.expected.time, one.expected.value});
  } else {
    chart.marks.push_back(
        {"reference", Ink::experiment, one.expected.time, one.expected.value, {}, {}, {}});
  }
  if (!one.expected.low.empty()) {
    chart.bands.push_back(
        {"band of the reference", one.expected.time, one.expected.low, one.expected.high});
  }
  fit(chart);
  return chart;
}

std::vector<double> column_of(const Series& series, std::size_t column, double tau) {
  if (series.kind == "pressure" && series.size() > 0) {
    return gaussian_filter(series, tau, column).value;
  }
  std::vector<double> values;
  for (std::size_t n = 0; n < series.size(); ++n) {
    values.push_back(series.values[n * series.columns.size() + column]);
  }
  return values;
}

Chart plain_chart(const Series& series, double tau, std::size_t number) {
  constexpr std::array kInks{Ink::first, Ink::second, Ink::third, Ink::fourth};
  Chart chart;
  chart.id = id_of("sensor", number);
  chart.title = heading_of(series.name, quantity_of(series.kind));
  chart.x.label = "time t, s";
  chart.y.label = fmt::format("{}, {}", quantity_of(series.kind), series.columns[0].unit);
  const bool many = series.columns.size() > 1;
  for (std::size_t column = 0; column < std::min(series.columns.size(), kInks.size()); ++column) {
    chart.lines.push_back({many ? series.columns[column].name : "", kInks[column], series.time,
                           column_of(series, column, tau)});
  }
  fit(chart);
  return chart;
}

void add_experiment_charts(std::vector<Chart>& charts, std::set<std::string>& drawn,
                           const Report& report) {
  const Comparison& comparison = *report.comparison;
  if (comparison.front) {
    charts.push_back(front_chart(report.scene, comparison));
    drawn.insert(comparison.front->sensor);
  }
  for (const LevelComparison& level : comparison.levels) {
    charts.push_back(level_chart(level, *comparison.reference, charts.size()));
    drawn.insert(level.sensor);
  }
  for (const PressureComparison& pressure : comparison.pressures) {
    charts.push_back(pressure_chart(pressure, comparison, charts.size()));
    drawn.insert(pressure.sensor);
  }
}

}  // namespace

std::vector<Chart> compared_charts(const Report& report) {
  std::vector<Chart> charts;
  if (report.comparison && !report.comparison->pressures.empty()) {
    for (const PressureComparison& pressure : report.comparison->pressures) {
      charts.push_back(pressure_chart(pressure, *report.comparison, charts.size()));
    }
  } else if (report.comparison) {
    std::set<std::string> drawn;
    add_experiment_charts(charts, drawn, report);
  }
  if (report.series_comparison) {
    for (const CurveComparison& one : report.series_comparison->curves) {
      charts.push_back(curve_chart(one, *report.series_comparison, charts.size()));
    }
  }
  return charts;
}

std::string report_svg(const Report& report) {
  const std::vector<Chart> charts = compared_charts(report);
  return charts.empty() ? std::string{} : sheet_svg(charts, 2, report.scene.name);
}

std::vector<Chart> report_charts(const Report& report, const std::vector<Series>& series) {
  std::vector<Chart> charts;
  std::set<std::string> drawn;
  if (report.comparison) add_experiment_charts(charts, drawn, report);
  if (report.series_comparison) {
    for (const CurveComparison& one : report.series_comparison->curves) {
      charts.push_back(curve_chart(one, *report.series_comparison, charts.size()));
      drawn.insert(one.sensor);
    }
  }
  for (const Series& one : series) {
    if (charts.size() >= kMostCharts) break;
    if (one.size() < 2 || one.columns.empty() || drawn.contains(one.name)) continue;
    charts.push_back(plain_chart(one, report.tau, charts.size()));
  }
  return charts;
}

}  // namespace sluice

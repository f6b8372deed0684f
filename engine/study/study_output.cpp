#include "engine/study/study_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/draw/markup.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

std::string state_of(const SetupResult& setup, const StudyResult& result) {
  if (setup.completed == setup.runs.size()) return "completed";
  std::string text;
  for (const RunState state :
       {RunState::failed, RunState::stopped, RunState::running, RunState::waiting}) {
    const auto count = std::count_if(setup.runs.begin(), setup.runs.end(),
                                     [&](std::size_t k) { return result.rows[k].state == state; });
    if (count == 0) continue;
    if (!text.empty()) text += ", ";
    text += setup.runs.size() == 1 ? std::string(to_string(state))
                                   : fmt::format("{} {}", count, to_string(state));
  }
  return text;
}

std::string spread_of(const SetupResult& setup) {
  if (setup.runs.size() < 2 || !setup.lowest_error) return "-";
  return fmt::format("{:.3f}-{:.3f}", *setup.lowest_error, *setup.highest_error);
}

/// Whether the study compares with anything.
bool has_errors(const StudyResult& result) {
  return std::any_of(result.rows.begin(), result.rows.end(),
                     [](const StudyRow& row) { return row.error.has_value(); });
}

Table setup_table(const StudyResult& result) {
  Table table;
  table.title = "Error against cost";
  table.note =
      "error: mean relative L2 of the reference's sensors; front: no other set-up has less "
      "error for the same or less cost";
  const bool refined =
      std::any_of(result.setups.begin(), result.setups.end(),
                  [](const SetupResult& setup) { return setup.difference.has_value(); });
  if (refined) {
    table.note +=
        "; from the finest: mean relative difference of plateaus, means and the like from those "
        "at the finest spacing";
  }
  if (!has_errors(result)) table.note += "; no error: the scenes have no reference";
  table.head = {"set-up",       "state",           "error",     "spread",
                "core-seconds", "million steps/s", "particles", "front"};
  if (refined) table.head.insert(table.head.begin() + 4, "from the finest");
  for (const SetupResult& setup : result.setups) {
    const StudyRow& first = result.rows[setup.runs.front()];
    const auto rate = first.particle_steps_per_second;
    table.rows.push_back({setup.name, state_of(setup, result), cell(setup.error, 4),
                          spread_of(setup), brief(setup.core_seconds, 4),
                          cell(rate ? std::optional(*rate * 1e-6) : std::nullopt, 2),
                          brief(first.particles, 12), setup.on_front ? "*" : ""});
    auto& row = table.rows.back();
    if (refined) row.insert(row.begin() + 4, cell(setup.difference, 4));
  }
  return table;
}

Table target_table(const StudyResult& result) {
  Table table;
  table.title = "The cheapest set-up with an error below a target";
  table.head = {"error below", "set-up", "its error", "core-seconds"};
  for (const Cheapest& one : result.cheapest) {
    const std::string target = fmt::format("{:g}", one.target);
    if (!one.setup) {
      table.rows.push_back({target, "none of these", "-", "-"});
      continue;
    }
    const SetupResult& setup = result.setups[*one.setup];
    table.rows.push_back({target, setup.name, cell(setup.error, 4), brief(setup.core_seconds, 4)});
  }
  return table;
}

Table convergence_table(const StudyResult& result) {
  Table table;
  table.title = "Convergence over the spacing";
  table.note =
      "order of the error: slope of ln error over ln spacing; others: Richardson from the "
      "three finest spacings, GCI with a factor of 1.25";
  table.head = {"set-ups", "quantity", "coarsest to finest", "approach", "order", "limit", "GCI"};
  for (const Convergence& one : result.convergence) {
    std::string values;
    for (auto point = one.points.rbegin(); point != one.points.rend(); ++point) {
      values += fmt::format("{}{:.4g}", values.empty() ? "" : " ", point->value);
    }
    const Richardson fit = one.richardson.value_or(Richardson{});
    const std::string approach =
        one.richardson ? std::string(to_string(fit.approach)) : std::string("-");
    const std::string share = cell(100.0 * fit.gci.value_or(std::nan("")), 1);
    table.rows.push_back({one.setups, one.quantity, values, approach,
                          cell(one.richardson ? fit.order : one.order_of_error, 2),
                          brief(fit.extrapolated), share == "-" ? share : share + " %"});
  }
  return table;
}

Table failure_table(const StudyResult& result) {
  Table table;
  table.title = "Runs without a result";
  table.head = {"run", "state", "reason"};
  for (std::size_t k = 0; k < result.runs.size(); ++k) {
    const StudyRow& row = result.rows[k];
    if (row.state == RunState::completed && (row.error || !has_errors(result))) continue;
    table.rows.push_back({result.runs[k].name, std::string(to_string(row.state)),
                          row.reason.empty() ? "-" : row.reason});
  }
  return table;
}

std::string machines_of(const StudyResult& result) {
  std::set<std::string> machines;
  for (const StudyRow& row : result.rows) {
    if (!row.machine.empty()) machines.insert(row.machine + ", " + row.simd_target);
  }
  return fmt::format("{}", fmt::join(machines, "; "));
}

/// With the spread of its members, where it has some.
void add_mark(ChartMarks& marks, const SetupResult& setup) {
  marks.x.push_back(*setup.core_seconds);
  marks.y.push_back(*setup.error);
  if (setup.runs.size() < 2) return;
  marks.low.resize(marks.x.size(), *setup.error);
  marks.high.resize(marks.x.size(), *setup.error);
  marks.low.back() = *setup.lowest_error;
  marks.high.back() = *setup.highest_error;
}

nlohmann::ordered_json value_of(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::vector<Table> study_tables(const StudyResult& result) {
  std::vector<Table> tables{setup_table(result)};
  if (!result.cheapest.empty()) tables.push_back(target_table(result));
  if (!result.convergence.empty()) tables.push_back(convergence_table(result));
  Table failures = failure_table(result);
  if (!failures.rows.empty()) tables.push_back(std::move(failures));
  return tables;
}

std::string study_text(const StudyResult& result) {
  std::string text = printable(result.study.name) + "\n";
  if (!result.study.description.empty()) text += printable(result.study.description) + "\n";
  if (const std::string machines = machines_of(result); !machines.empty()) text += machines + "\n";
  text += "\n";
  for (const Table& table : study_tables(result)) text += table_text(table);
  return text;
}

std::string study_markdown(const StudyResult& result) {
  std::string text = fmt::format("# {}\n\n", markdown_escaped(result.study.name));
  for (const std::string& line : {result.study.description, machines_of(result)}) {
    if (!line.empty()) text += markdown_escaped(line) + "\n\n";
  }
  for (const Table& table : study_tables(result)) text += table_markdown(table);
  return text;
}

std::string study_csv(const StudyResult& result) {
  std::vector<std::string> keys, sensors;
  if (!result.runs.empty()) {
    for (const auto& [key, value] : result.runs.front().values) keys.push_back(key);
  }
  for (const StudyRow& row : result.rows) {
    for (const auto& [sensor, error] : row.sensor_errors) {
      if (std::find(sensors.begin(), sensors.end(), sensor) == sensors.end()) {
        sensors.push_back(sensor);
      }
    }
  }
  Table table;
  table.head = {"run", "setup", "case"};
  table.head.insert(table.head.end(), keys.begin(), keys.end());
  for (const char* name : {"state", "error", "core_seconds", "particle_steps_per_second",
                           "particles", "steps", "spacing_m"}) {
    table.head.emplace_back(name);
  }
  for (const std::string& sensor : sensors) table.head.push_back("relative_l2_" + sensor);
  table.head.emplace_back("reason");
  for (std::size_t k = 0; k < result.runs.size(); ++k) {
    const StudyRun& run = result.runs[k];
    const StudyRow& row = result.rows[k];
    std::vector<std::string> cells{run.name, run.setup, run.of_case};
    for (const auto& [key, value] : run.values) cells.push_back(value);
    cells.emplace_back(to_string(row.state));
    for (const auto& value : {row.error, row.core_seconds, row.particle_steps_per_second,
                              row.particles, row.steps, std::optional(run.scene.method.spacing)}) {
      cells.push_back(brief(value, 10));
    }
    for (const std::string& sensor : sensors) {
      const auto found = std::find_if(row.sensor_errors.begin(), row.sensor_errors.end(),
                                      [&](const auto& each) { return each.first == sensor; });
      cells.push_back(found == row.sensor_errors.end() ? "-" : brief(found->second, 10));
    }
    cells.push_back(row.reason);
    table.rows.push_back(std::move(cells));
  }
  return table_csv(table);
}

nlohmann::ordered_json study_json(const StudyResult& result) {
  Json runs = Json::array();
  for (std::size_t k = 0; k < result.runs.size(); ++k) {
    const StudyRun& run = result.runs[k];
    const StudyRow& row = result.rows[k];
    Json values = Json::object();
    for (const auto& [key, value] : run.values) values[key] = value;
    Json errors = Json::object();
    for (const auto& [sensor, error] : row.sensor_errors) errors[sensor] = error;
    Json quantities = Json::object();
    for (const auto& [name, value] : row.quantities) quantities[name] = value;
    runs.push_back({{"run", run.name},
                    {"setup", run.setup},
                    {"case", run.of_case},
                    {"values", std::move(values)},
                    {"spacing_m", run.scene.method.spacing},
                    {"state", to_string(row.state)},
                    {"reason", row.reason},
                    {"error", value_of(row.error)},
                    {"relative_l2", std::move(errors)},
                    {"quantities", std::move(quantities)},
                    {"core_seconds", value_of(row.core_seconds)},
                    {"particle_steps_per_second", value_of(row.particle_steps_per_second)},
                    {"particles", value_of(row.particles)},
                    {"steps", value_of(row.steps)},
                    {"machine", row.machine},
                    {"simd_target", row.simd_target}});
  }
  Json setups = Json::array();
  for (const SetupResult& setup : result.setups) {
    setups.push_back({{"setup", setup.name},
                      {"case", setup.of_case},
                      {"runs", setup.runs.size()},
                      {"completed", setup.completed},
                      {"error", value_of(setup.error)},
                      {"lowest_error", value_of(setup.lowest_error)},
                      {"highest_error", value_of(setup.highest_error)},
                      {"difference_from_finest", value_of(setup.difference)},
                      {"core_seconds", value_of(setup.core_seconds)},
                      {"on_pareto_front", setup.on_front}});
  }
  Json cheapest = Json::array();
  for (const Cheapest& one : result.cheapest) {
    cheapest.push_back(
        {{"error_below", one.target},
         {"setup", one.setup ? Json(result.setups[*one.setup].name) : Json(nullptr)}});
  }
  Json convergence = Json::array();
  for (const Convergence& one : result.convergence) {
    Json points = Json::array();
    for (const Refined& point : one.points) points.push_back({point.spacing, point.value});
    const auto& fit = one.richardson;
    convergence.push_back({{"setups", one.setups},
                           {"quantity", one.quantity},
                           {"spacing_m_and_value", std::move(points)},
                           {"order_of_error", value_of(one.order_of_error)},
                           {"approach", fit ? Json(to_string(fit->approach)) : Json(nullptr)},
                           {"order", value_of(fit ? fit->order : std::nullopt)},
                           {"extrapolated", value_of(fit ? fit->extrapolated : std::nullopt)},
                           {"grid_convergence_index", value_of(fit ? fit->gci : std::nullopt)}});
  }
  return Json{{"study", result.study.name},
              {"description", result.study.description},
              {"setups", std::move(setups)},
              {"cheapest", std::move(cheapest)},
              {"convergence", std::move(convergence)},
              {"runs", std::move(runs)}};
}

Chart study_chart(const StudyResult& result) {
  Chart chart;
  chart.id = "study";
  chart.title = fmt::format("{}: error against cost", result.study.name);
  chart.x = {"core-seconds", 1.0, 10.0, AxisScale::logarithmic};
  chart.y = {"mean relative L2 error", 0.1, 1.0, AxisScale::logarithmic};
  ChartMarks others{"set-up", Ink::experiment, {}, {}, {}, {}, {}};
  ChartMarks front{"on the Pareto front", Ink::second, {}, {}, {}, {}, {}};
  std::vector<const SetupResult*> best;
  std::vector<double> x, y;
  for (const SetupResult& setup : result.setups) {
    if (!setup.error || !setup.core_seconds) continue;
    x.push_back(*setup.core_seconds);
    y.insert(y.end(), {*setup.lowest_error, *setup.highest_error});
    if (setup.on_front) {
      best.push_back(&setup);
    } else {
      add_mark(others, setup);
    }
  }
  std::sort(best.begin(), best.end(), [](const SetupResult* a, const SetupResult* b) {
    return *a->core_seconds < *b->core_seconds;
  });
  ChartLine line{"", Ink::second, {}, {}};
  for (const SetupResult* setup : best) {
    add_mark(front, *setup);
    front.labels.push_back(fmt::format("{}", front.x.size()));
    chart.notes.push_back(fmt::format("{}  {}: error {:.3f}, {:.4g} core-seconds", front.x.size(),
                                      setup->name, *setup->error, *setup->core_seconds));
    line.x.push_back(*setup->core_seconds);
    line.y.push_back(*setup->error);
  }
  for (const SetupResult& setup : result.setups) {
    const auto failed = std::count_if(setup.runs.begin(), setup.runs.end(), [&](std::size_t k) {
      return result.rows[k].state == RunState::failed;
    });
    if (failed > 0) chart.notes.push_back(fmt::format("failed, so not drawn: {}", setup.name));
  }
  chart.lines.push_back(std::move(line));
  if (!others.x.empty()) chart.marks.push_back(std::move(others));
  if (!front.x.empty()) chart.marks.push_back(std::move(front));
  fit_axis(chart.x, x);
  fit_axis(chart.y, y);
  return chart;
}

}  // namespace sluice

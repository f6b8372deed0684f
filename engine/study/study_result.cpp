#include "engine/study/study_result.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace sluice {
namespace {

constexpr std::string_view kSpacing = "/resolution/spacing";

std::vector<SetupResult> group(const std::vector<StudyRun>& runs) {
  std::vector<SetupResult> setups;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const StudyRun& run = runs[k];
    auto found = std::find_if(setups.begin(), setups.end(),
                              [&](const SetupResult& setup) { return setup.name == run.setup; });
    if (found == setups.end()) {
      SetupResult setup;
      setup.name = run.setup;
      setup.of_case = run.of_case;
      setup.values = run.values;
      setup.spacing = run.scene.method.spacing;
      found = setups.insert(setups.end(), std::move(setup));
    }
    found->runs.push_back(k);
  }
  return setups;
}

/// Means over the members; nothing as long as one is missing.
void average(SetupResult& setup, const std::vector<StudyRow>& rows) {
  double error = 0.0;
  double cost = 0.0;
  bool complete = true;
  bool priced = true;
  for (const std::size_t k : setup.runs) {
    const StudyRow& row = rows[k];
    if (row.state == RunState::completed) ++setup.completed;
    complete = complete && row.state == RunState::completed && row.error;
    priced = priced && row.state == RunState::completed && row.core_seconds;
    cost += row.core_seconds.value_or(0.0);
    if (!row.error) continue;
    error += *row.error;
    setup.lowest_error = std::min(setup.lowest_error.value_or(*row.error), *row.error);
    setup.highest_error = std::max(setup.highest_error.value_or(*row.error), *row.error);
  }
  const auto count = static_cast<double>(setup.runs.size());
  if (complete) setup.error = error / count;
  if (priced) setup.core_seconds = cost / count;
}

bool dominates(const SetupResult& a, const SetupResult& b) {
  const bool no_worse = *a.error <= *b.error && *a.core_seconds <= *b.core_seconds;
  return no_worse && (*a.error < *b.error || *a.core_seconds < *b.core_seconds);
}

void mark_front(std::vector<SetupResult>& setups) {
  const auto counts = [](const SetupResult& setup) { return setup.error && setup.core_seconds; };
  for (SetupResult& setup : setups) {
    setup.on_front =
        counts(setup) && std::none_of(setups.begin(), setups.end(), [&](const SetupResult& other) {
          return counts(other) && dominates(other, setup);
        });
  }
}

Cheapest cheapest_below(double target, const std::vector<SetupResult>& setups) {
  Cheapest result{target, std::nullopt};
  for (std::size_t k = 0; k < setups.size(); ++k) {
    const SetupResult& setup = setups[k];
    if (!setup.error || !setup.core_seconds || !(*setup.error < target)) continue;
    if (!result.setup || *setup.core_seconds < *setups[*result.setup].core_seconds) {
      result.setup = k;
    }
  }
  return result;
}

/// What a set-up shares with those that differ in the spacing only; empty when none is varied.
std::string family_of(const SetupResult& setup) {
  std::string name = setup.of_case;
  bool varied = false;
  for (const auto& [key, value] : setup.values) {
    if (key == kSpacing) {
      varied = true;
    } else {
      name += ", " + key + " = " + value;
    }
  }
  return varied ? name : std::string{};
}

/// Mean of each quantity over the members of a set-up, the error first if there is one.
std::vector<std::pair<std::string, double>> quantities_of(const SetupResult& setup,
                                                          const std::vector<StudyRow>& rows) {
  std::vector<std::pair<std::string, double>> all;
  if (setup.error) all.emplace_back("error", *setup.error);
  for (const auto& [name, ignored] : rows[setup.runs.front()].quantities) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::size_t k : setup.runs) {
      for (const auto& [other, value] : rows[k].quantities) {
        if (other != name) continue;
        sum += value;
        ++count;
      }
    }
    if (count == setup.runs.size()) all.emplace_back(name, sum / static_cast<double>(count));
  }
  return all;
}

Convergence converge(const std::string& family, const std::string& quantity,
                     std::vector<Refined> points) {
  std::sort(points.begin(), points.end(),
            [](const Refined& a, const Refined& b) { return a.spacing < b.spacing; });
  Convergence result{family, quantity, std::move(points), std::nullopt, std::nullopt};
  if (quantity == "error") {
    result.order_of_error = order_of_errors(result.points);
  } else {
    result.richardson = richardson(result.points);
  }
  return result;
}

std::vector<Convergence> find_convergence(const std::vector<SetupResult>& setups,
                                          const std::vector<StudyRow>& rows) {
  // Both keys in the order in which they were met first.
  std::vector<std::pair<std::string, std::string>> order;
  std::map<std::pair<std::string, std::string>, std::vector<Refined>> points;
  for (const SetupResult& setup : setups) {
    const std::string family = family_of(setup);
    if (family.empty() || setup.completed < setup.runs.size()) continue;
    for (const auto& [quantity, value] : quantities_of(setup, rows)) {
      const std::pair key{family, quantity};
      if (!points.contains(key)) order.push_back(key);
      points[key].push_back({setup.spacing, value});
    }
  }
  std::vector<Convergence> all;
  for (const auto& key : order) {
    if (points[key].size() >= 3) all.push_back(converge(key.first, key.second, points[key]));
  }
  return all;
}

/// How far apart the quantities are that both have, the error left out.
std::optional<double> difference_of(const std::vector<std::pair<std::string, double>>& ours,
                                    const std::vector<std::pair<std::string, double>>& finest) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const auto& [name, value] : ours) {
    for (const auto& [other, best] : finest) {
      if (other != name || name == "error") continue;
      const double scale = std::max(std::abs(value), std::abs(best));
      sum += scale > 0.0 ? std::abs(value - best) / scale : 0.0;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

void compare_with_finest(std::vector<SetupResult>& setups, const std::vector<StudyRow>& rows) {
  std::map<std::string, const SetupResult*> finest;
  const auto counts = [](const SetupResult& setup) {
    return setup.completed == setup.runs.size() && !family_of(setup).empty();
  };
  for (const SetupResult& setup : setups) {
    if (!counts(setup)) continue;
    const SetupResult*& best = finest[family_of(setup)];
    if (best == nullptr || setup.spacing < best->spacing) best = &setup;
  }
  for (SetupResult& setup : setups) {
    if (!counts(setup)) continue;
    setup.difference = difference_of(quantities_of(setup, rows),
                                     quantities_of(*finest.at(family_of(setup)), rows));
  }
}

}  // namespace

std::string_view to_string(RunState state) {
  switch (state) {
    case RunState::waiting:
      return "waiting";
    case RunState::running:
      return "running";
    case RunState::stopped:
      return "stopped";
    case RunState::completed:
      return "completed";
    case RunState::failed:
      return "failed";
  }
  return "?";
}

StudyResult evaluate(const Study& study, std::vector<StudyRun> runs, std::vector<StudyRow> rows) {
  StudyResult result{study, std::move(runs), std::move(rows), {}, {}, {}};
  result.setups = group(result.runs);
  for (SetupResult& setup : result.setups) average(setup, result.rows);
  mark_front(result.setups);
  compare_with_finest(result.setups, result.rows);
  for (const double target : study.targets) {
    result.cheapest.push_back(cheapest_below(target, result.setups));
  }
  result.convergence = find_convergence(result.setups, result.rows);
  return result;
}

}  // namespace sluice

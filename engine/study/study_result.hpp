#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/study/convergence.hpp"
#include "engine/study/study.hpp"

namespace sluice {

enum class RunState { waiting, running, stopped, completed, failed };
[[nodiscard]] std::string_view to_string(RunState state);

/// How one run of a study ended. Only a completed one has an error and a cost.
struct StudyRow {
  RunState state = RunState::waiting;
  std::string reason;           ///< why it is not completed
  std::optional<double> error;  ///< mean relative L2 of the reference's sensors
  std::vector<std::pair<std::string, double>> sensor_errors;
  std::vector<std::pair<std::string, double>> quantities;  ///< what convergence is looked for in
  std::optional<double> core_seconds;
  std::optional<double> particle_steps_per_second;
  std::optional<double> particles, steps;
  std::string machine, simd_target;
};

/// All members of one set-up.
struct SetupResult {
  std::string name;
  std::string of_case;
  std::vector<std::pair<std::string, std::string>> values;
  double spacing = 0.0;           ///< m
  std::vector<std::size_t> runs;  ///< places in StudyResult::rows
  std::size_t completed = 0;
  std::optional<double> error;  ///< mean over the members; only when all of them are completed
  std::optional<double> lowest_error, highest_error;
  std::optional<double> core_seconds;  ///< mean over the members; only when all are completed
  /// From the finest spacing of set-ups that differ in nothing else: mean over their quantities of
  /// |q - q_finest| / max(|q|, |q_finest|). Absent where no spacing is varied.
  std::optional<double> difference;
  bool on_front = false;  ///< no other set-up has less error for at most the same cost
};

/// The cheapest set-up with an error below a target; `setup` is absent when there is none.
struct Cheapest {
  double target = 0.0;
  std::optional<std::size_t> setup;
};

/// How a quantity of set-ups that differ in nothing but the spacing goes to a limit.
struct Convergence {
  std::string setups;    ///< what they have in common
  std::string quantity;  ///< "error", or "SENSOR plateau" and the like
  std::vector<Refined> points;
  std::optional<double> order_of_error;  ///< only for "error"
  std::optional<Richardson> richardson;
};

struct StudyResult {
  Study study;
  std::vector<StudyRun> runs;
  std::vector<StudyRow> rows;  ///< one per run
  std::vector<SetupResult> setups;
  std::vector<Cheapest> cheapest;
  std::vector<Convergence> convergence;
};

/// Puts the rows together: set-ups, Pareto front, targets, convergence. Pure.
[[nodiscard]] StudyResult evaluate(const Study& study, std::vector<StudyRun> runs,
                                   std::vector<StudyRow> rows);

}  // namespace sluice

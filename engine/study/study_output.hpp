#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/draw/chart.hpp"
#include "engine/study/study_result.hpp"
#include "engine/study/table.hpp"

namespace sluice {

/// For people: set-ups with error and cost, the cheapest per target, convergence, what failed.
[[nodiscard]] std::vector<Table> study_tables(const StudyResult& result);
[[nodiscard]] std::string study_text(const StudyResult& result);
[[nodiscard]] std::string study_markdown(const StudyResult& result);

/// One row per run, for spreadsheets.
[[nodiscard]] std::string study_csv(const StudyResult& result);
[[nodiscard]] nlohmann::ordered_json study_json(const StudyResult& result);

/// Error against core-seconds, both logarithmic, the Pareto front joined by a line.
[[nodiscard]] Chart study_chart(const StudyResult& result);

}  // namespace sluice

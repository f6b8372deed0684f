#pragma once

#include <string>
#include <vector>

#include "engine/report/report.hpp"
#include "engine/study/table.hpp"

namespace sluice {

/// What all formats of a report say before their tables, a line each: what ran, against what, with
/// which shift and filter.
[[nodiscard]] std::vector<std::string> report_lines(const Report& report);

/// The comparison, if any, sensor by sensor (report_tables.cpp), then what the run was and cost
/// (report_run_tables.cpp).
[[nodiscard]] std::vector<Table> comparison_tables(const Report& report);
[[nodiscard]] std::vector<Table> run_tables(const Report& report);
[[nodiscard]] std::vector<Table> report_tables(const Report& report);

/// The numerical scheme in one line.
[[nodiscard]] std::string scheme_text(const Scene& scene);

}  // namespace sluice

#pragma once

#include <nlohmann/json.hpp>

#include "engine/study/study_result.hpp"

namespace sluice {

/// A completed run's row from its report.json (report_json() of engine/report): the error, each
/// sensor's part of it, quantities that converge, the cost and the machine. What the report lacks,
/// or has of another type, is absent from the row; a report without an error leaves the reason.
[[nodiscard]] StudyRow row_of_report(const nlohmann::ordered_json& report);

}  // namespace sluice

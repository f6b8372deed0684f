#pragma once

#include <filesystem>

#include "engine/study/study_result.hpp"

namespace sluice {

/// The state of a run from its folder: no simulation is started and nothing is changed. A folder
/// that does not hold this run yet is waiting.
[[nodiscard]] StudyRow read_row(const std::filesystem::path& folder, const StudyRun& run);

}  // namespace sluice

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/store/files/series.hpp"
#include "engine/store/read/job_reader.hpp"

namespace sluice {

/// The job in a folder. Throws CommandEnd(usage) when it holds none.
[[nodiscard]] JobReader job_or_end(const std::filesystem::path& folder);

/// Throws CommandEnd(usage) for a word of a verb that also takes ids when it is no folder that can
/// be read.
void require_folder(const std::string& word);

/// The series of this name; throws CommandEnd(not_found) with the nearest names.
[[nodiscard]] const Series& find_series(const std::vector<Series>& all, const std::string& name);

}  // namespace sluice

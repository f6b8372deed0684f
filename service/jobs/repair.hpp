#pragma once

#include <filesystem>
#include <string>

#include "service/jobs/rebuild.hpp"

namespace sluice {

/// Brings rows and folders together after a service that was killed or lost its power: a deletion
/// whose row is still there is undone, any other is brought to its end; a scene whose later end its
/// row does not know gets the row's end back, because nobody was told of it; temporary files whose
/// writer is gone are removed. For use before the service takes requests and starts workers; a
/// folder that a worker of the last service still uses is left alone. A folder that cannot be
/// mended is reported.
void repair_folders(JobStore& store, const std::filesystem::path& data,
                    const RebuildReport& report = {});

/// A scene's text with another end time, s. Throws std::runtime_error for what is no scene.
[[nodiscard]] std::string with_end_time(const std::string& scene, double end_time);

}  // namespace sluice

#pragma once

#include <filesystem>
#include <vector>

#include "engine/store/disk/publish.hpp"
#include "engine/store/files/sample_table.hpp"

namespace sluice {

/// Publishes the series so far. Without the wait for the disk by default: this file is a copy for
/// readers while a run goes on. A run never reads it back (its series are in the checkpoint), its
/// trailer shows damage by a power cut, and the next publication, about a second after the run goes
/// on, replaces it. Publish the last one of a run with Durability::power_cut. Throws StorageError:
/// invalid_content when the samples break their rules, and what publish throws.
void write_series(const std::filesystem::path& path, const std::vector<SampleTable>& tables,
                  Durability durability = Durability::process_crash,
                  FileSystem& system = FileSystem::real());

/// Reads it back bit by bit, one series per sensor in the order of the scene's list. Throws
/// StorageError: corrupt, unsupported_version, not_ours, io.
[[nodiscard]] std::vector<Series> read_series(const std::filesystem::path& path);

}  // namespace sluice

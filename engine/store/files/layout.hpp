#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/store/files/checkpoint.hpp"
#include "engine/store/files/sample_table.hpp"
#include "engine/store/files/snapshot_io.hpp"
#include "engine/store/hdf5/archive.hpp"

namespace sluice {

// What lies where in each of our files: schemas/checkpoint.md in code. Each walk takes an archive
// (engine/store/hdf5/archive.hpp) and the thing to write, read or digest; one is const for the
// writers.

/// Name and version of a file's layout: the root's first two attributes.
struct Format {
  std::string_view name;
  std::uint64_t version;  ///< that is written
  std::uint64_t oldest;   ///< that is still read
};
inline constexpr Format kCheckpointFormat{"sluice-checkpoint", 5, 3};
inline constexpr Format kSeriesFormat{"sluice-series", 2, 1};
inline constexpr Format kSnapshotFormat{"sluice-frame", 2, 1};

/// How a file keeps the samples: the first versions had a group for each sensor.
enum class SampleLayout { by_sensor, tables };
/// How a checkpoint keeps what left: before version 5 without velocities and densities.
enum class RemovedLayout { places, states };
struct CheckpointLayout {
  SampleLayout samples = SampleLayout::tables;
  RemovedLayout removed = RemovedLayout::states;

  [[nodiscard]] static CheckpointLayout of_version(std::uint64_t version) {
    return {version < 4 ? SampleLayout::by_sensor : SampleLayout::tables,
            version < 5 ? RemovedLayout::places : RemovedLayout::states};
  }
};
[[nodiscard]] inline SampleLayout series_layout(std::uint64_t version) {
  return version < 2 ? SampleLayout::by_sensor : SampleLayout::tables;
}

/// Writes the format; or returns the file's version, and throws StorageError: not_ours or
/// unsupported_version when it is none that is read.
void walk_format(WriteArchive& archive, const Format& format);
std::uint64_t walk_format(ReadArchive& archive, const Format& format);

void walk_identity(WriteArchive& archive, const Checkpoint& checkpoint);
void walk_identity(ReadArchive& archive, Checkpoint& checkpoint);

/// All that the digest covers.
void walk_physics(WriteArchive& archive, const Checkpoint& checkpoint);
void walk_physics(ReadArchive& archive, Checkpoint& checkpoint, const CheckpointLayout& layout);
void walk_physics(DigestArchive& archive, const Checkpoint& checkpoint);

void walk_samples(WriteArchive& archive, const std::vector<SampleTable>& tables);
void walk_samples(ReadArchive& archive, std::vector<SampleTable>& tables, SampleLayout layout);
void walk_samples(DigestArchive& archive, const std::vector<SampleTable>& tables);

void walk_snapshot(WriteArchive& archive, const Snapshot& frame);
/// The first version names no origin.
void walk_snapshot(ReadArchive& archive, Snapshot& frame, std::uint64_t version);

}  // namespace sluice

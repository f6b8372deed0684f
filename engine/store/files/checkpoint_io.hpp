#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/scene/model/scene.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/files/checkpoint.hpp"

namespace sluice {

/// `checkpoint-<step>.h5`, the step in 12 digits so that names sort by step.
[[nodiscard]] std::string checkpoint_name(std::uint64_t step);
/// The step of such a name; empty for any other name.
[[nodiscard]] std::optional<std::uint64_t> step_of_checkpoint_name(std::string_view name);

/// What a checkpoint must belong to. An empty member is not checked.
struct CheckpointIdentity {
  std::optional<std::string> scene_hash;
  std::optional<Integrator> integrator;
};

/// That of a run of this scene.
[[nodiscard]] CheckpointIdentity identity_of(const Scene& scene);
/// Throws StorageError(wrong_scene) for a checkpoint of another scene or integrator.
void require_identity(const Checkpoint& checkpoint, const CheckpointIdentity& identity);

/// The HDF5 image of a checkpoint; equal checkpoints give equal bytes. Throws StorageError:
/// invalid_content when a carried field has the wrong length, a number is not finite or a series
/// breaks its rules.
[[nodiscard]] Bytes encode_checkpoint(const Checkpoint& checkpoint);
/// Inverse of it. Throws StorageError: corrupt when anything is missing, unknown, of wrong type or
/// shape or not finite; unsupported_version; not_ours for another format; wrong_scene.
[[nodiscard]] Checkpoint decode_checkpoint(ByteSpan image, const CheckpointIdentity& identity = {});

/// Publishes it in `folder` under its name so that it survives a power cut; returns the path.
std::filesystem::path write_checkpoint(const std::filesystem::path& folder,
                                       const Checkpoint& checkpoint,
                                       FileSystem& system = FileSystem::real());
/// Reads and checks a checkpoint file; the message of an error begins with the path.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path,
                                         const CheckpointIdentity& identity = {});

}  // namespace sluice

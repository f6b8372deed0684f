#include "engine/store/files/checkpoint_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "engine/scene/format/canonical.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/digest.hpp"
#include "engine/store/files/layout.hpp"
#include "engine/store/files/rules.hpp"

namespace sluice {
namespace {

constexpr std::string_view kPrefix = "checkpoint-";
constexpr std::string_view kSuffix = ".h5";
constexpr std::size_t kDigits = 12;

/// About the size of the image.
std::uint64_t expected_bytes(const Checkpoint& checkpoint) {
  std::uint64_t bytes = file_bytes(checkpoint.samples);
  const Particles& particles = checkpoint.solver.particles;
  for (const Field& field : fields_in(particles.position.size())) {
    bytes += field.values.of(particles).size() * sizeof(double);
  }
  return bytes;
}

}  // namespace

CheckpointIdentity identity_of(const Scene& scene) {
  return {scene_hash(identity_text(scene)), scene.method.integrator};
}

void require_identity(const Checkpoint& checkpoint, const CheckpointIdentity& identity) {
  if (identity.scene_hash && *identity.scene_hash != checkpoint.scene_hash) {
    throw StorageError(
        StorageFault::wrong_scene,
        fmt::format("of another scene (hash {} where {} is expected): the scene was changed after "
                    "the run began; put it back, or run the new scene in a folder of its own",
                    checkpoint.scene_hash, *identity.scene_hash));
  }
  if (identity.integrator && *identity.integrator != checkpoint.integrator) {
    throw StorageError(StorageFault::wrong_scene,
                       "of a run with another integrator than the scene asks for");
  }
}

std::string checkpoint_name(std::uint64_t step) {
  return fmt::format("{}{:0{}}{}", kPrefix, step, kDigits, kSuffix);
}

std::optional<std::uint64_t> step_of_checkpoint_name(std::string_view name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) {
    return std::nullopt;
  }
  name.remove_prefix(kPrefix.size());
  name.remove_suffix(std::min(kSuffix.size(), name.size()));
  std::uint64_t step = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), step);
  const bool whole = error == std::errc() && end == name.data() + name.size();
  // Only the name that would be written: else one step could have two files.
  return whole && name == fmt::format("{:0{}}", step, kDigits) ? std::optional(step) : std::nullopt;
}

Bytes encode_checkpoint(const Checkpoint& checkpoint) {
  require_sound(checkpoint, StorageFault::invalid_content);
  WriteArchive archive(expected_bytes(checkpoint));
  walk_format(archive, kCheckpointFormat);
  walk_identity(archive, checkpoint);
  walk_physics(archive, checkpoint);
  return archive.image();
}

Checkpoint decode_checkpoint(ByteSpan image, const CheckpointIdentity& identity) {
  ReadArchive archive(image);
  Checkpoint checkpoint;
  const std::uint64_t version = walk_format(archive, kCheckpointFormat);
  walk_identity(archive, checkpoint);
  require_identity(checkpoint, identity);
  walk_physics(archive, checkpoint, CheckpointLayout::of_version(version));
  archive.require_all_met();
  require_sound(checkpoint, StorageFault::corrupt);
  return checkpoint;
}

std::filesystem::path write_checkpoint(const std::filesystem::path& folder,
                                       const Checkpoint& checkpoint, FileSystem& system) {
  std::filesystem::path path = folder / checkpoint_name(checkpoint.solver.step);
  const Bytes image = naming(path, [&] { return encode_checkpoint(checkpoint); });
  publish(path, image, Durability::power_cut, system);
  return path;
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity) {
  const Bytes image = read_verified(path);
  return naming(path, [&] { return decode_checkpoint(image, identity); });
}

}  // namespace sluice

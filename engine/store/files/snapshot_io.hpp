#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/space/axes.hpp"
#include "engine/space/field_member.hpp"
#include "engine/space/vec.hpp"
#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/store/disk/publish.hpp"

namespace sluice {

/// A particle snapshot for pictures, in single precision: nothing goes on from it. Every field has
/// one entry per particle. Positions are relative to an origin near the fluid, because single
/// precision tells no particles apart far from zero.
struct Snapshot {
  std::uint64_t step = 0;
  double time = 0.0;                      ///< s
  PerAxis<std::vector<float>> position;   ///< m, from the origin
  PerAxis<std::vector<float>> velocity;   ///< m/s
  std::vector<float> pressure;            ///< Pa
  std::vector<std::uint64_t> id;          ///< number given at the start
  Vec origin = filled_vec<kAnyDim>(0.0);  ///< m

  [[nodiscard]] std::size_t size() const { return position.front().size(); }
  /// Where particle i is, m.
  [[nodiscard]] Vec position_of(std::size_t i) const {
    return origin + vector_of(position, i).cast<double>();
  }
  /// Velocity of particle i, m/s.
  [[nodiscard]] auto velocity_of(std::size_t i) const { return vector_of(velocity, i); }
  friend bool operator==(const Snapshot&, const Snapshot&) = default;
};

struct SnapshotField {
  std::string_view name;
  std::string_view unit;
  std::string_view description;
  FieldMember<Snapshot, std::vector<float>> values;
};

/// One without particles, of so many dimensions.
[[nodiscard]] Snapshot empty_snapshot(std::uint64_t step, double time, std::size_t dimensions);

/// What a snapshot holds of each particle beside its id.
[[nodiscard]] std::span<const SnapshotField> snapshot_fields_in(std::size_t dimensions);

/// `frame-<index>.h5`, the index in 6 digits.
[[nodiscard]] std::string snapshot_name(std::uint64_t index);

/// The snapshot of a state; pressure by eq. 3. In each direction the origin is zero, or the middle
/// of the particles where that is farther away than they are spread.
[[nodiscard]] Snapshot make_snapshot(const SolverState& state, const Method& method);

/// Publishes it. Survives a power cut by default, because a checkpoint that counts the frame as
/// written does. Throws StorageError: invalid_content when fields differ in length, and what
/// publish throws.
void write_snapshot(const std::filesystem::path& path, const Snapshot& frame,
                    Durability durability = Durability::power_cut,
                    FileSystem& system = FileSystem::real());

/// Throws StorageError: corrupt, unsupported_version, not_ours, io.
[[nodiscard]] Snapshot read_snapshot(const std::filesystem::path& path);

}  // namespace sluice

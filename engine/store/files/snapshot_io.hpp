#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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
  double time = 0.0;              ///< s
  std::vector<float> x, y;        ///< m, from the origin
  std::vector<float> vx, vy;      ///< m/s
  std::vector<float> pressure;    ///< Pa
  std::vector<std::uint64_t> id;  ///< number given at the start
  double origin_x = 0.0;          ///< m
  double origin_y = 0.0;          ///< m

  /// Where particle i is, m.
  [[nodiscard]] Vec position(std::size_t i) const {
    return {origin_x + static_cast<double>(x[i]), origin_y + static_cast<double>(y[i])};
  }
  friend bool operator==(const Snapshot&, const Snapshot&) = default;
};

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

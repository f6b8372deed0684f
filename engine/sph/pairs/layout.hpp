#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/space/vec.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// The fixed geometry of the order of particles in memory: strips two spacings high, and along a
/// strip bins two spacings wide (wider in a vast and almost empty domain). It depends on the scene
/// alone, never on where particles went.
class Grid {
 public:
  /// `particles` bounds the memory that the grid may use. Lengths in m.
  Grid(const Box& domain, double spacing, double smoothing_length, std::size_t particles);

  [[nodiscard]] std::size_t strips() const { return strips_; }
  [[nodiscard]] std::size_t bins() const { return bins_; }
  /// Positions outside the domain count to the nearest strip and bin.
  [[nodiscard]] std::size_t strip(double y) const { return cell(y - origin_.y(), strip_, strips_); }
  [[nodiscard]] std::size_t bin(double x) const { return cell(x - origin_.x(), bin_, bins_); }
  [[nodiscard]] double strip_height() const { return strip_; }
  /// Lower edge of a strip, m.
  [[nodiscard]] double strip_bottom(std::size_t strip) const {
    return origin_.y() + static_cast<double>(strip) * strip_;
  }
  /// A cluster spans at most this much of a strip, m.
  [[nodiscard]] double max_cluster_length() const { return max_cluster_length_; }

  /// Tiles: squares whose centres are the origins of single-precision positions. One tile where
  /// that resolves 3e-5 h.
  struct Tile {
    int column = 0;
    int row = 0;
    friend bool operator==(const Tile&, const Tile&) = default;
  };
  [[nodiscard]] Tile tile(const Vec& position) const;
  [[nodiscard]] Vec tile_center(Tile tile) const {
    return tile_origin_ + tile_size_ * Vec(tile.column + 0.5, tile.row + 0.5);
  }
  [[nodiscard]] double tile_size() const { return tile_size_; }
  /// Whether there is no other tile than one.
  [[nodiscard]] bool has_one_tile() const { return one_tile_; }

 private:
  static std::size_t cell(double distance, double size, std::size_t count);

  Vec origin_;
  double strip_;
  double bin_;
  std::size_t strips_;
  std::size_t bins_;
  double max_cluster_length_;
  bool one_tile_;
  double tile_size_;
  Vec tile_origin_;
};

/// Where particles go in memory: strip by strip, by x inside a strip, four to a cluster. A strip
/// starts a new cluster and so does a gap; slots left over are empty.
struct Layout {
  std::vector<std::uint32_t> strip_begin;  ///< first cluster of each strip, and the end
  std::size_t slot_count = 0;
  std::size_t chunk = 1;  ///< clusters per chunk, the unit of work of a thread

  [[nodiscard]] std::size_t slots() const { return slot_count; }
  [[nodiscard]] std::size_t clusters() const { return slot_count / kCluster; }
  [[nodiscard]] std::size_t chunks() const { return (clusters() + chunk - 1) / chunk; }
  [[nodiscard]] std::size_t chunk_begin(std::size_t n) const {
    return std::min(n * chunk, clusters());
  }
};

/// A layout, and who goes where in it.
struct Order {
  static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();

  Layout layout;
  std::vector<std::uint32_t> source;  ///< per slot: index of the particle, or kEmpty
};

/// Orders the particles by (strip, x, y, id). The order of the input changes nothing. Slots with
/// id < 0 are empty and are left out.
[[nodiscard]] Order sort_into_clusters(ThreadTeam& team, const Grid& grid,
                                       std::span<const double> x, std::span<const double> y,
                                       std::span<const double> id);

}  // namespace sluice

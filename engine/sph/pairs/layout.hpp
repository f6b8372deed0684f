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

/// The fixed geometry of the order of particles in memory: rows two spacings high, and along a
/// row cells two spacings wide (wider in a vast and almost empty domain). It depends on the scene
/// alone, never on where particles went.
class Grid {
 public:
  /// `particles` bounds the memory that the grid may use. Lengths in m.
  Grid(const Box& domain, double spacing, double smoothing_length, std::size_t particles);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t cells() const { return cells_; }
  /// Positions outside the domain count to the nearest row and cell.
  [[nodiscard]] std::size_t row(double y) const { return index_of(y - origin_.y(), row_, rows_); }
  [[nodiscard]] std::size_t cell(double x) const {
    return index_of(x - origin_.x(), cell_, cells_);
  }
  [[nodiscard]] double row_height() const { return row_; }
  /// Lower edge of a row, m.
  [[nodiscard]] double row_bottom(std::size_t row) const {
    return origin_.y() + static_cast<double>(row) * row_;
  }
  /// A cluster spans at most this much of a row, m.
  [[nodiscard]] double max_cluster_length() const { return max_cluster_length_; }

  /// Origin cells: squares whose centres are the origins of single-precision positions. One origin
  /// cell where that resolves 3e-5 h.
  struct OriginCell {
    int column = 0;
    int row = 0;
    friend bool operator==(const OriginCell&, const OriginCell&) = default;
  };
  [[nodiscard]] OriginCell origin_cell(const Vec& position) const;
  [[nodiscard]] Vec origin_cell_center(OriginCell origin_cell) const {
    return origin_cell_corner_ +
           origin_cell_size_ * Vec(origin_cell.column + 0.5, origin_cell.row + 0.5);
  }
  [[nodiscard]] double origin_cell_size() const { return origin_cell_size_; }
  /// Whether there is no other origin cell than one.
  [[nodiscard]] bool has_one_origin_cell() const { return one_origin_cell_; }

 private:
  static std::size_t index_of(double distance, double size, std::size_t count);

  Vec origin_;
  double row_;
  double cell_;
  std::size_t rows_;
  std::size_t cells_;
  double max_cluster_length_;
  bool one_origin_cell_;
  double origin_cell_size_;
  Vec origin_cell_corner_;
};

/// Where particles go in memory: row by row, by x inside a row, four to a cluster. A row
/// starts a new cluster and so does a gap; slots left over are empty.
struct Layout {
  std::vector<std::uint32_t> row_begin;  ///< first cluster of each row, and the end
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

/// Orders the particles by (row, x, y, id). The order of the input changes nothing. Slots with
/// id < 0 are empty and are left out.
[[nodiscard]] Order sort_into_clusters(ThreadTeam& team, const Grid& grid,
                                       std::span<const double> x, std::span<const double> y,
                                       std::span<const double> id);

}  // namespace sluice

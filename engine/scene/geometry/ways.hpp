#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/scene/geometry/solids.hpp"

namespace sluice {

/// Lengths of the ways from a place to the nodes of a grid around it, in spacings: where a particle
/// gets through, outside of all solids. Places have room for a particle, half a spacing all round.
class Ways {
 public:
  /// `solids` must outlive this.
  Ways(const Solids& solids, double spacing);

  /// Seeks ways that are no longer than `longest` and stay within `radius` of `from`, spacings.
  void seek(const Vec& from, double radius, double longest);
  /// Whether `from` is in a slit so narrow that no node is in its sight.
  [[nodiscard]] bool shut() const { return shut_; }
  /// Whether particles have room at a node within `radius`, spacings, to which no way was found.
  [[nodiscard]] bool miss_somebody(double radius);
  /// Infinite where there is no way; nothing where no node is in sight.
  [[nodiscard]] std::optional<double> length_to(const Vec& place);

 private:
  /// A node of the grid, counted from the lower left one in the window.
  struct Node {
    int i = 0;
    int j = 0;
  };
  [[nodiscard]] Vec place_of(Node n) const {
    return middle_ + cell_ * Vec(n.i - half_, n.j - half_);
  }
  [[nodiscard]] std::size_t index(Node n) const {
    return static_cast<std::size_t>(n.j) * static_cast<std::size_t>(2 * half_ + 1) +
           static_cast<std::size_t>(n.i);
  }
  [[nodiscard]] bool in_reach(Node n) const {
    return n.i >= 0 && n.j >= 0 && n.i <= 2 * half_ && n.j <= 2 * half_;
  }
  [[nodiscard]] bool passable(Node n);
  template <class F>
  void for_nodes_in_sight(const Vec& place, const F& f);

  const Solids& solids_;
  double spacing_;
  double cell_;                                    ///< m, of the grid
  std::unordered_map<std::uint64_t, bool> known_;  ///< of the grid as a whole
  Vec middle_ = Vec::Zero();                       ///< a node of the grid near the place
  std::int64_t column_ = 0;                        ///< of the middle
  std::int64_t row_ = 0;
  int half_ = 0;
  bool shut_ = false;
  std::vector<double> length_;
};

}  // namespace sluice

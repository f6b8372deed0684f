#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/scene/geometry/solids.hpp"
#include "engine/space/lattice.hpp"

namespace sluice {

/// Lengths of the ways from a place to the nodes of a grid around it, in spacings: where a particle
/// gets through, outside of all solids. Places have room for a particle, half a spacing all round.
template <int Dim>
class WaysN {
 public:
  using Point = VecN<Dim>;

  /// `solids` must outlive this.
  WaysN(const SolidsN<Dim>& solids, double spacing);

  /// Seeks ways that are no longer than `longest` and stay within `radius` of `from`, spacings.
  void seek(const Point& from, double radius, double longest);
  /// The same for the shortest way to one place alone.
  void seek(const Point& from, const Point& to, double radius, double longest);
  /// Whether `from` is in a slit so narrow that no node is in its sight.
  [[nodiscard]] bool shut() const { return shut_; }
  /// Whether particles have room at a node within `radius`, spacings, to which no way was found.
  [[nodiscard]] bool miss_somebody(double radius);
  /// Infinite where there is no way; nothing where no node is in sight.
  [[nodiscard]] std::optional<double> length_to(const Point& place);

 private:
  /// A node of the grid, counted from the middle of a window of nodes from -half_ to half_.
  using Node = CellN<Dim>;

  [[nodiscard]] Point place_of(const Node& n) const { return middle_ + cell_ * as_vector<Dim>(n); }
  [[nodiscard]] std::size_t index(const Node& n) const;
  [[nodiscard]] bool in_reach(const Node& n) const;
  [[nodiscard]] bool passable(const Node& n);
  /// `left` is a lower bound of what a way still has before it at a node, spacings. Ends at the
  /// first node, of those with the least such bound in all, that is `enough`.
  template <class Left, class Enough>
  void seek_by(const Point& from, double radius, double longest, const Left& left,
               const Enough& enough);
  template <class F>
  void for_nodes_in_sight(const Point& place, const F& f);
  template <class F>
  void for_all_nodes(const F& f) const;

  const SolidsN<Dim>& solids_;
  double spacing_;
  double cell_;                                    ///< m, of the grid
  std::unordered_map<std::uint64_t, bool> known_;  ///< of the grid as a whole
  Point middle_ = Point::Zero();                   ///< a node of the grid near the place
  Node middle_node_{};                             ///< the same, counted from the origin
  std::int64_t half_ = 0;
  bool shut_ = false;
  std::vector<double> length_;
};

}  // namespace sluice

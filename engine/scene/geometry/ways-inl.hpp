#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "engine/scene/geometry/ways.hpp"

namespace sluice {
namespace ways {

// Lengths in spacings. Nodes that have such room and neighbour on such a grid have only what is
// open between them.
inline constexpr double kNode = 0.5;
inline constexpr double kPassable = 0.36;  // from a solid; so no slit that particles pass is closed
inline constexpr double kJoined = 0.75;    // what has room for a particle and a node are in sight

/// A number for each node of a grid, for one node in every 2^(64/d) along an axis the same.
template <int Dim>
std::uint64_t key_of(const CellN<Dim>& node) {
  constexpr int kBits = 64 / Dim;
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  std::uint64_t key = 0;
  for (const std::int64_t number : node)
    key = key << kBits | (static_cast<std::uint64_t>(number) & kMask);
  return key;
}

}  // namespace ways

template <int Dim>
WaysN<Dim>::WaysN(const SolidsN<Dim>& solids, double spacing)
    : solids_(solids), spacing_(spacing), cell_(ways::kNode * spacing) {}

template <int Dim>
std::size_t WaysN<Dim>::index(const Node& n) const {
  return index_between<Dim>(shifted<Dim>({}, -half_), shifted<Dim>({}, half_), n);
}

template <int Dim>
bool WaysN<Dim>::in_reach(const Node& n) const {
  return std::all_of(n.begin(), n.end(), [&](std::int64_t k) { return k >= -half_ && k <= half_; });
}

template <int Dim>
bool WaysN<Dim>::passable(const Node& n) {
  Node of_grid = middle_node_;
  for (int axis = 0; axis < Dim; ++axis) of_grid[axis] += n[axis];
  const auto [entry, is_new] = known_.try_emplace(ways::key_of<Dim>(of_grid), false);
  if (is_new) entry->second = solids_.leaves_room(place_of(n), ways::kPassable * spacing_);
  return entry->second;
}

template <int Dim>
template <class F>
void WaysN<Dim>::for_nodes_in_sight(const Point& place, const F& f) {
  const Node at = cell_at<Dim>((place - middle_) / cell_);
  for_each_cell<Dim>(shifted<Dim>(at, -1), shifted<Dim>(at, 2), [&](const Node& n) {
    if (!in_reach(n)) return;
    const double distance = (place_of(n) - place).norm() / spacing_;
    if (distance <= ways::kJoined && passable(n)) f(n, distance);
  });
}

template <int Dim>
template <class F>
void WaysN<Dim>::for_all_nodes(const F& f) const {
  for_each_cell<Dim>(shifted<Dim>({}, -half_), shifted<Dim>({}, half_), f);
}

template <int Dim>
void WaysN<Dim>::seek(const Point& from, double radius, double longest) {
  const auto nothing = [](const Node&) { return 0.0; };
  const auto never = [](const Node&) { return false; };
  seek_by(from, radius, longest, nothing, never);
}

template <int Dim>
void WaysN<Dim>::seek(const Point& from, const Point& to, double radius, double longest) {
  const double apart = (to - from).norm() / spacing_;
  const double farthest = 0.5 * (longest + apart) + ways::kJoined;
  const auto left = [&](const Node& n) { return (place_of(n) - to).norm() / spacing_; };
  const auto in_sight = [&](const Node& n) { return left(n) <= ways::kJoined; };
  seek_by(from, std::min(radius, farthest), longest, left, in_sight);
}

template <int Dim>
template <class Left, class Enough>
void WaysN<Dim>::seek_by(const Point& from, double radius, double longest, const Left& left,
                         const Enough& enough) {
  const Point cells = from / cell_;
  for (int axis = 0; axis < Dim; ++axis) {
    middle_node_[axis] = static_cast<std::int64_t>(std::round(cells[axis]));
  }
  middle_ = cell_ * as_vector<Dim>(middle_node_);
  half_ = static_cast<std::int64_t>(std::ceil(radius / ways::kNode)) + 1;
  length_.assign(index(shifted<Dim>({}, half_)) + 1, std::numeric_limits<double>::infinity());

  using Reached = std::pair<double, Node>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto reach = [&](const Node& n, double length) {
    const double whole = length + left(n);
    if (whole > longest || length >= length_[index(n)]) return;
    length_[index(n)] = length;
    next.push({whole, n});
  };
  shut_ = true;
  for_nodes_in_sight(from, [&](const Node& n, double length) {
    shut_ = false;
    reach(n, length);
  });
  while (!next.empty()) {
    const auto [whole, n] = next.top();
    next.pop();
    const double length = length_[index(n)];
    if (whole > length + left(n)) continue;
    if (enough(n)) return;
    for_each_cell<Dim>(
        shifted<Dim>(n, -1), shifted<Dim>(n, 1), [&, &node = n, way = length](const Node& beside) {
          if (!in_reach(beside) || (place_of(beside) - from).norm() > radius * spacing_) return;
          const double step = (as_vector<Dim>(beside) - as_vector<Dim>(node)).norm();
          if (passable(beside)) reach(beside, way + ways::kNode * step);
        });
  }
}

template <int Dim>
bool WaysN<Dim>::miss_somebody(double radius) {
  bool missed = false;
  for_all_nodes([&](const Node& n) {
    if (missed || std::isfinite(length_[index(n)])) return;
    missed = (place_of(n) - middle_).norm() <= radius * spacing_ && passable(n);
  });
  return missed;
}

template <int Dim>
std::optional<double> WaysN<Dim>::length_to(const Point& place) {
  std::optional<double> best;
  for_nodes_in_sight(place, [&](const Node& n, double distance) {
    best = std::min(best.value_or(std::numeric_limits<double>::infinity()),
                    length_[index(n)] + distance);
  });
  return best;
}

}  // namespace sluice

#include "engine/scene/geometry/ways.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace sluice {
namespace {

// Lengths in spacings. Nodes that have such room and neighbour on such a grid have only what is
// open between them.
constexpr double kNode = 0.5;
constexpr double kPassable = 0.36;  // from a solid; so no slit that particles pass is closed
constexpr double kJoined = 0.75;    // what has room for a particle and a node are in sight

}  // namespace

Ways::Ways(const Solids& solids, double spacing)
    : solids_(solids), spacing_(spacing), cell_(kNode * spacing) {}

bool Ways::passable(Node n) {
  const auto column = static_cast<std::uint64_t>(column_ + n.i - half_);
  const auto row = static_cast<std::uint64_t>(row_ + n.j - half_);
  const auto [entry, is_new] = known_.try_emplace(column << 32 ^ (row & 0xffffffffU), false);
  if (is_new) entry->second = solids_.leaves_room(place_of(n), kPassable * spacing_);
  return entry->second;
}

template <class F>
void Ways::for_nodes_in_sight(const Vec& place, const F& f) {
  const Vec at = (place - middle_) / cell_;
  const int i = static_cast<int>(std::floor(at.x())) + half_;
  const int j = static_cast<int>(std::floor(at.y())) + half_;
  for (int di = -1; di <= 2; ++di) {
    for (int dj = -1; dj <= 2; ++dj) {
      const Node n{i + di, j + dj};
      if (!in_reach(n)) continue;
      const double distance = (place_of(n) - place).norm() / spacing_;
      if (distance <= kJoined && passable(n)) f(n, distance);
    }
  }
}

void Ways::seek(const Vec& from, double radius, double longest) {
  const Vec cell = from / cell_;
  column_ = static_cast<std::int64_t>(std::round(cell.x()));
  row_ = static_cast<std::int64_t>(std::round(cell.y()));
  middle_ = cell_ * Vec(static_cast<double>(column_), static_cast<double>(row_));
  half_ = static_cast<int>(std::ceil(radius / kNode)) + 1;
  const auto side = static_cast<std::size_t>(2 * half_ + 1);
  length_.assign(side * side, std::numeric_limits<double>::infinity());

  using Reached = std::pair<double, std::pair<int, int>>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto reach = [&](Node n, double length) {
    if (length > longest || length >= length_[index(n)]) return;
    length_[index(n)] = length;
    next.push({length, {n.i, n.j}});
  };
  for_nodes_in_sight(from, reach);
  shut_ = next.empty();
  while (!next.empty()) {
    const double length = next.top().first;
    const Node n{next.top().second.first, next.top().second.second};
    next.pop();
    if (length > length_[index(n)]) continue;
    for (int di = -1; di <= 1; ++di) {
      for (int dj = -1; dj <= 1; ++dj) {
        const Node beside{n.i + di, n.j + dj};
        if (!in_reach(beside) || (place_of(beside) - from).norm() > radius * spacing_) continue;
        if (passable(beside)) reach(beside, length + kNode * std::hypot(di, dj));
      }
    }
  }
}

bool Ways::miss_somebody(double radius) {
  for (int i = 0; i <= 2 * half_; ++i) {
    for (int j = 0; j <= 2 * half_; ++j) {
      const Node n{i, j};
      if (std::isfinite(length_[index(n)])) continue;
      if ((place_of(n) - middle_).norm() <= radius * spacing_ && passable(n)) return true;
    }
  }
  return false;
}

std::optional<double> Ways::length_to(const Vec& place) {
  std::optional<double> best;
  for_nodes_in_sight(place, [&](Node n, double distance) {
    best = std::min(best.value_or(std::numeric_limits<double>::infinity()),
                    length_[index(n)] + distance);
  });
  return best;
}

}  // namespace sluice

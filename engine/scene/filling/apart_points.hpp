#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "engine/space/lattice.hpp"

namespace sluice {

/// Points that keep a distance to one another.
template <int Dim>
class ApartPoints {
 public:
  /// No distance that they are to keep is longer than `cell`, m.
  explicit ApartPoints(double cell) : cell_(cell) {}

  /// Takes a point unless one that it has is nearer than `apart`, m.
  void add(const VecN<Dim>& point, double apart) {
    const CellN<Dim> place = cell_at<Dim>(point / cell_);
    bool free = true;
    for_each_cell<Dim>(shifted<Dim>(place, -1), shifted<Dim>(place, 1), [&](const auto& cell) {
      const auto found = bins_.find(cell);
      free =
          free && (found == bins_.end() ||
                   std::none_of(found->second.begin(), found->second.end(),
                                [&](const auto& other) { return (other - point).norm() < apart; }));
    });
    if (!free) return;
    bins_[place].push_back(point);
    points_.push_back(point);
  }
  [[nodiscard]] std::vector<VecN<Dim>> take() { return std::move(points_); }

 private:
  double cell_;
  std::map<CellN<Dim>, std::vector<VecN<Dim>>> bins_;
  std::vector<VecN<Dim>> points_;
};

}  // namespace sluice

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/sph/solver/cluster_bounds.hpp"

namespace sluice {
namespace cluster_bounds {

inline constexpr float kHuge = std::numeric_limits<float>::max();

/// A box that is still empty along one axis, in smoothing lengths.
template <typename T>
struct Extent {
  T low = std::numeric_limits<T>::max();
  T high = -std::numeric_limits<T>::max();
  void add(T from, T way, T skin) {
    low = std::min(low, from + std::min(way, T{0}) - skin);
    high = std::max(high, from + std::max(way, T{0}) + skin);
  }
};

}  // namespace cluster_bounds

template <int Dim>
void ClusterBounds<Dim>::assign_origin_cells(ThreadTeam& team, const Grid<Dim>& grid,
                                             const Layout& layout, const AxisSpans<Dim>& position,
                                             std::span<const double> id) {
  const std::size_t clusters = layout.clusters();
  resize_closely(origin_cell, clusters);
  team.run(layout.chunks(), [&](std::size_t chunk) {
    for (std::size_t c = layout.chunk_begin(chunk); c < layout.chunk_begin(chunk + 1); ++c) {
      const std::size_t first = kCluster * c;
      origin_cell[c] = id[first] < 0.0 ? typename Grid<Dim>::OriginCell{}
                                       : grid.origin_cell(place_in<Dim>(position, first));
    }
  });
}

template <int Dim>
void ClusterBounds<Dim>::resize(const Layout& layout) {
  for (auto* vector : {&min, &max}) {
    for (AlignedArray<float>& along : *vector) along.resize(layout.clusters());
  }
  for (auto* a : {&x_max_before, &x_min_after}) a->resize(layout.clusters());
}

template <int Dim>
template <typename T>
void ClusterBounds<Dim>::assign_boxes(std::size_t begin, std::size_t end, const Grid<Dim>& grid,
                                      double smoothing_length, const ListPathsView<T, Dim>& paths) {
  using cluster_bounds::kHuge;
  const Skin<T>& skin = paths.skin;
  for (std::size_t c = begin; c < end; ++c) {
    std::array<cluster_bounds::Extent<T>, Dim> extent;
    for (std::size_t s = kCluster * c; s < kCluster * (c + 1); ++s) {
      if (!(std::abs(paths.position[0][s]) < static_cast<T>(kNowhere))) continue;
      T speed{};
      for (std::size_t axis = 0; axis < Dim; ++axis) speed += std::abs(paths.velocity[axis][s]);
      const T off = skin.least + skin.per_speed * speed;
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        extent[axis].add(paths.position[axis][s], skin.lifetime * paths.velocity[axis][s], off);
      }
    }
    const bool used = extent[0].low <= extent[0].high;
    const VecN<Dim> origin = grid.origin_cell_center(origin_cell[c]) / smoothing_length;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      const double from = origin[static_cast<Eigen::Index>(axis)];
      const auto [low, high] = extent[axis];
      min[axis][c] = used ? outwards(from + static_cast<double>(low), -1.0) : kHuge;
      max[axis][c] = used ? outwards(from + static_cast<double>(high), 1.0) : -kHuge;
    }
  }
}

template <int Dim>
void ClusterBounds<Dim>::assign_rows(ThreadTeam& team, const Layout& layout) {
  using cluster_bounds::kHuge;
  const std::size_t rows = layout.row_begin.size() - 1;
  for (std::size_t axis = 1; axis < Dim; ++axis) {
    row_min[axis].resize(rows);
    row_max[axis].resize(rows);
  }
  team.run(rows, [&](std::size_t s) {
    const std::size_t begin = layout.row_begin[s];
    const std::size_t end = layout.row_begin[s + 1];
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      // Written once: rows side by side share lines of the cache.
      float low = kHuge;
      float high = -kHuge;
      for (std::size_t c = begin; c < end; ++c) {
        low = std::min(low, min[axis][c]);
        high = std::max(high, max[axis][c]);
      }
      row_min[axis][s] = low;
      row_max[axis][s] = high;
    }
    float right = -kHuge;
    for (std::size_t c = begin; c < end; ++c) x_max_before[c] = right = std::max(right, max[0][c]);
    float left = kHuge;
    for (std::size_t c = end; c-- > begin;) x_min_after[c] = left = std::min(left, min[0][c]);
  });
  const std::vector<float>& lowest = row_min[kLastAxis];
  const std::vector<float>& highest = row_max[kLastAxis];
  row_max_before.resize(rows);
  row_min_after.resize(rows);
  std::inclusive_scan(highest.begin(), highest.end(), row_max_before.begin(),
                      [](float a, float b) { return std::max(a, b); });
  std::inclusive_scan(lowest.rbegin(), lowest.rend(), row_min_after.rbegin(),
                      [](float a, float b) { return std::min(a, b); });
}

}  // namespace sluice

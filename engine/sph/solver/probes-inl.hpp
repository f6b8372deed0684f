#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/space/space_traits.hpp"
#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/method/equation_of_state.hpp"
#include "engine/sph/solver/probes.hpp"

namespace sluice {
namespace probes {

/// Of boxes and places in smoothing lengths; covers rounding.
inline constexpr double kBoxSlack = 1e-3;

/// Whether b is looked at before a: the higher one, of two as high the one with less x, then z.
template <int Dim>
[[nodiscard]] bool is_lower(const VecN<Dim>& a, const VecN<Dim>& b) {
  if (a[kUpAxis] != b[kUpAxis]) return a[kUpAxis] < b[kUpAxis];
  for (int axis = 0; axis < Dim; ++axis) {
    if (a[axis] != b[axis]) return a[axis] > b[axis];
  }
  return false;
}

}  // namespace probes

template <int Dim>
template <class Body>
void FluidProbe<Dim>::for_rows_in(const BoxN<Dim>& box, const Body& body) const {
  std::array<float, Dim> low{};
  std::array<float, Dim> high{};
  for (int axis = 1; axis < Dim; ++axis) {
    low[static_cast<std::size_t>(axis)] = outwards(box.min[axis], -1.0);
    high[static_cast<std::size_t>(axis)] = outwards(box.max[axis], 1.0);
  }
  bounds_.for_rows_in(low, high, 0, [&](std::size_t row) {
    if (layout_.row_begin[row] < layout_.row_begin[row + 1]) body(row);
  });
}

template <int Dim>
template <class Body>
void FluidProbe<Dim>::for_each_in(const BoxN<Dim>& box, const Body& body) const {
  const double h = method_.smoothing_length;
  const BoxN<Dim> wider = grown<Dim>({box.min / h, box.max / h}, probes::kBoxSlack);
  const float left = outwards(wider.min[0], -1.0);
  const float right = outwards(wider.max[0], 1.0);
  for_rows_in(wider, [&](std::size_t row) {
    const float* const reach = bounds_.x_max_before.data();
    const std::uint32_t end = layout_.row_begin[row + 1];
    const auto first = static_cast<std::size_t>(
        std::lower_bound(reach + layout_.row_begin[row], reach + end, left) - reach);
    for (std::size_t c = first; c < end && bounds_.x_min_after[c] <= right; ++c) {
      for (std::size_t s = kCluster * c; s < kCluster * (c + 1); ++s) {
        if (particles_.id[s] >= 0.0) body(s);
      }
    }
  });
}

template <int Dim>
Probe FluidProbe<Dim>::pressure(const VecN<Dim>& point, double h) const {
  // The part of each row that lies in the ball of the support.
  thread_local std::vector<RowPart> rows;
  rows.clear();
  const VecN<Dim> place = point / method_.smoothing_length;
  const double reach = method_.support_ratio() * h / method_.smoothing_length + probes::kBoxSlack;
  for_rows_in(grown<Dim>({place, place}, reach), [&](std::size_t row) {
    double off_sq = 0.0;
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      const double at = place[static_cast<Eigen::Index>(axis)];
      const double off = std::max({0.0, bounds_.row_min[axis][row] - at - probes::kBoxSlack,
                                   at - bounds_.row_max[axis][row] - probes::kBoxSlack});
      off_sq += off * off;
    }
    const double along = std::sqrt(std::max(0.0, reach * reach - off_sq)) + probes::kBoxSlack;
    rows.push_back({layout_.row_begin[row], layout_.row_begin[row + 1],
                    outwards(place[0] - along, -1.0), outwards(place[0] + along, 1.0)});
  });
  const PointSums sums =
      sum_around_(particles_, {point, h, method_.reference_density, bounds_.view(), rows});
  if (!(sums.kernel > 0.0)) return {};
  const LinearEquationOfState state{method_.sound_speed};
  const double scale =
      kernel_value_scale<Dim>(method_.kernel) * method_.particle_mass() / cell_measure<Dim>(h);
  return {state.pressure(sums.excess / sums.kernel), scale * sums.volumes};
}

template <int Dim>
Probe FluidProbe<Dim>::surface_height(const VecN<Dim>& place) const {
  const double h = method_.smoothing_length;
  const double support = method_.support();
  const double volume = cell_measure<Dim>(method_.spacing) / cell_measure<Dim>(h);
  std::vector<VecN<Dim>> column;
  BoxN<Dim> whole = grown<Dim>({place, place}, support);
  whole.min[kUpAxis] = domain_.box.min[kUpAxis];
  whole.max[kUpAxis] = domain_.box.max[kUpAxis];
  for_each_in(whole, [&](std::size_t s) {
    VecN<Dim> beside = particles_.position_of(s) - place;
    beside[kUpAxis] = 0.0;
    if (beside.cwiseAbs().maxCoeff() < support) column.push_back(particles_.position_of(s));
  });
  // Highest first, so that the search ends at the surface; what lies deeper is never sorted.
  std::make_heap(column.begin(), column.end(), probes::is_lower<Dim>);
  std::vector<VecN<Dim>> top;  // sorted
  // As far as the first below y.
  const auto sort_down_to = [&](double y) {
    while (!column.empty() && (top.empty() || top.back()[kUpAxis] >= y)) {
      std::pop_heap(column.begin(), column.end(), probes::is_lower<Dim>);
      top.push_back(column.back());
      column.pop_back();
    }
  };
  const auto filled = [&](double y) {
    sort_down_to(y - support);
    VecN<Dim> at = place;
    at[kUpAxis] = y;
    double sum = 0.0;
    for (const VecN<Dim>& p : top) {
      if (p[kUpAxis] > y + support) continue;
      if (p[kUpAxis] < y - support) break;
      sum += volume * kernel_value<Dim>(method_.kernel, (p - at).squaredNorm() / (h * h));
    }
    return sum;
  };
  constexpr double kSurface = 0.5;
  sort_down_to(std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (next < top.size()) {  // of which filled() makes more
    const double y = top[next++][kUpAxis];
    const double at_particle = filled(y);
    if (at_particle < kSurface) continue;
    double low = y;
    double high = y + support;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (low + high);
      (filled(middle) >= kSurface ? low : high) = middle;
    }
    return {low, at_particle};
  }
  return {};
}

template <int Dim>
double FluidProbe<Dim>::distance(const VecN<Dim>& point) const {
  double nearest_sq = method_.support() * method_.support();
  bool found = false;
  for_each_in(grown<Dim>({point, point}, method_.support()), [&](std::size_t s) {
    const double sq = (particles_.position_of(s) - point).squaredNorm();
    if (sq > nearest_sq) return;
    nearest_sq = sq;
    found = true;
  });
  return found ? std::sqrt(nearest_sq) : std::numeric_limits<double>::infinity();
}

}  // namespace sluice

#include "engine/sph/solver/probes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/method/equation_of_state.hpp"

namespace sluice {
namespace {

/// Of boxes and places in smoothing lengths; covers rounding.
constexpr double kBoxSlack = 1e-3;

}  // namespace

template <class Body>
void FluidProbe::for_rows_in(float low, float high, const Body& body) const {
  for (std::size_t row = bounds_.first_row(low); row + 1 < layout_.row_begin.size(); ++row) {
    if (bounds_.row_y_min_after[row] > high) break;
    if (layout_.row_begin[row] == layout_.row_begin[row + 1]) continue;
    if (bounds_.row_y_max[row] >= low && bounds_.row_y_min[row] <= high) body(row);
  }
}

template <class Body>
void FluidProbe::for_each_in(const Box& box, const Body& body) const {
  const double h = method_.smoothing_length;
  const float x_min = outwards(box.min.x() / h - kBoxSlack, -1.0);
  const float x_max = outwards(box.max.x() / h + kBoxSlack, 1.0);
  const auto in_row = [&](std::size_t row) {
    const float* const reach = bounds_.x_max_before.data();
    const std::uint32_t end = layout_.row_begin[row + 1];
    const auto first = static_cast<std::size_t>(
        std::lower_bound(reach + layout_.row_begin[row], reach + end, x_min) - reach);
    for (std::size_t c = first; c < end && bounds_.x_min_after[c] <= x_max; ++c) {
      for (std::size_t s = kCluster * c; s < kCluster * (c + 1); ++s) {
        if (particles_.id[s] >= 0.0) body(s);
      }
    }
  };
  for_rows_in(outwards(box.min.y() / h - kBoxSlack, -1.0),
              outwards(box.max.y() / h + kBoxSlack, 1.0), in_row);
}

Probe FluidProbe::pressure(const Vec& point, double h) const {
  // The part of each row that lies in the circle of the support.
  thread_local std::vector<Surroundings::Row> rows;
  rows.clear();
  const Vec place = point / method_.smoothing_length;
  const double reach = method_.support_ratio() * h / method_.smoothing_length + kBoxSlack;
  const auto add_row = [&](std::size_t row) {
    const double off = std::max({0.0, bounds_.row_y_min[row] - place.y() - kBoxSlack,
                                 place.y() - bounds_.row_y_max[row] - kBoxSlack});
    const double along = std::sqrt(std::max(0.0, reach * reach - off * off)) + kBoxSlack;
    rows.push_back({layout_.row_begin[row], layout_.row_begin[row + 1],
                    outwards(place.x() - along, -1.0), outwards(place.x() + along, 1.0)});
  };
  for_rows_in(outwards(place.y() - reach, -1.0), outwards(place.y() + reach, 1.0), add_row);
  const PointSums sums =
      sum_around_(particles_, {point, h, method_.reference_density, bounds_.view(), rows});
  if (!(sums.kernel > 0.0)) return {};
  const LinearEquationOfState state{method_.sound_speed};
  const double scale = kernel_value_scale(method_.kernel) * method_.particle_mass() / (h * h);
  return {state.pressure(sums.excess / sums.kernel), scale * sums.volumes};
}

Probe FluidProbe::surface_height(double x) const {
  const double h = method_.smoothing_length;
  const double support = method_.support();
  const double volume = method_.spacing * method_.spacing / (h * h);
  std::vector<Vec> column;
  const Box whole{{x - support, domain_.box.min.y()}, {x + support, domain_.box.max.y()}};
  for_each_in(whole, [&](std::size_t s) {
    if (std::abs(particles_.position[0][s] - x) < support)
      column.push_back(particles_.position_of(s));
  });
  // Highest first, so that the search ends at the surface; what lies deeper is never sorted.
  const auto lower = [](const Vec& a, const Vec& b) {
    return a.y() != b.y() ? a.y() < b.y() : a.x() > b.x();
  };
  std::make_heap(column.begin(), column.end(), lower);
  std::vector<Vec> top;  // sorted
  // As far as the first below y.
  const auto sort_down_to = [&](double y) {
    while (!column.empty() && (top.empty() || top.back().y() >= y)) {
      std::pop_heap(column.begin(), column.end(), lower);
      top.push_back(column.back());
      column.pop_back();
    }
  };
  const auto filled = [&](double y) {
    sort_down_to(y - support);
    double sum = 0.0;
    for (const Vec& p : top) {
      if (p.y() > y + support) continue;
      if (p.y() < y - support) break;
      sum += volume * kernel_value(method_.kernel, (p - Vec(x, y)).squaredNorm() / (h * h));
    }
    return sum;
  };
  constexpr double kSurface = 0.5;
  sort_down_to(std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (next < top.size()) {  // of which filled() makes more
    const double y = top[next++].y();
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

double FluidProbe::distance(const Vec& point) const {
  const Vec support = Vec::Constant(method_.support());
  double nearest_sq = method_.support() * method_.support();
  bool found = false;
  for_each_in({point - support, point + support}, [&](std::size_t s) {
    const double sq = (particles_.position_of(s) - point).squaredNorm();
    if (sq > nearest_sq) return;
    nearest_sq = sq;
    found = true;
  });
  return found ? std::sqrt(nearest_sq) : std::numeric_limits<double>::infinity();
}

}  // namespace sluice

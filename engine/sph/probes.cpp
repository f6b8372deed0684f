#include "engine/sph/probes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/sph/equation_of_state.hpp"
#include "engine/sph/kernel.hpp"

namespace sluice {
namespace {

/// The first in [begin, end) with values[i] >= least, values ascending; end where there is none. As
/// std::lower_bound, without branches that nothing predicts: a probe does little else.
std::size_t first_from(const float* values, std::size_t begin, std::size_t end, float least) {
  std::size_t count = end - begin;
  while (count > 0) {
    const std::size_t half = (count + 1) / 2;
    begin += static_cast<std::size_t>(values[begin + half - 1] < least) * half;
    count -= half;
  }
  return begin;
}

}  // namespace

template <class Body>
void FluidProbe::for_runs_in(const Box& box, const Body& body) const {
  // The clusters' boxes hold their particles, in smoothing lengths; the slack covers rounding.
  const double h = method_.smoothing_length;
  const double slack = 1e-3;
  const float x_min = outwards(box.min.x() / h - slack, -1.0);
  const float x_max = outwards(box.max.x() / h + slack, 1.0);
  const float y_min = outwards(box.min.y() / h - slack, -1.0);
  const float y_max = outwards(box.max.y() / h + slack, 1.0);
  for (std::size_t strip = bounds_.first_strip(y_min); strip + 1 < layout_.strip_begin.size();
       ++strip) {
    if (bounds_.strip_y_min_after[strip] > y_max) break;
    if (bounds_.strip_y_max[strip] < y_min) continue;
    if (bounds_.strip_y_min[strip] > y_max) continue;
    const std::size_t end = layout_.strip_begin[strip + 1];
    const std::size_t from =
        first_from(bounds_.x_max_before.data(), layout_.strip_begin[strip], end, x_min);
    std::size_t to = from;
    while (to < end && bounds_.x_min_after[to] <= x_max) ++to;
    if (from < to) body(kCluster * from, kCluster * to);
  }
}

template <class Body>
void FluidProbe::for_each_in(const Box& box, const Body& body) const {
  for_runs_in(box, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      if (particles_.id[s] >= 0.0) body(s);
    }
  });
}

Probe FluidProbe::pressure(const Vec& point, double h) const {
  const Vec support = Vec::Constant(method_.support_ratio() * h);
  const Surroundings around{point, h, method_.reference_density};
  PointSums sums;
  for_runs_in({point - support, point + support}, [&](std::size_t begin, std::size_t end) {
    sum_around_(particles_, begin, end, around, sums);
  });
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
  const Box whole{{x - support, method_.domain.min.y()}, {x + support, method_.domain.max.y()}};
  for_each_in(whole, [&](std::size_t s) {
    if (std::abs(particles_.x[s] - x) < support) column.push_back(particles_.position(s));
  });
  // Highest first, so that the search ends at the surface.
  std::sort(column.begin(), column.end(), [](const Vec& a, const Vec& b) {
    return a.y() != b.y() ? a.y() > b.y() : a.x() < b.x();
  });
  const auto filled = [&](double y) {
    double sum = 0.0;
    for (const Vec& p : column) {
      if (p.y() > y + support) continue;
      if (p.y() < y - support) break;
      sum += volume * kernel_value(method_.kernel, (p - Vec(x, y)).squaredNorm() / (h * h));
    }
    return sum;
  };
  constexpr double kSurface = 0.5;
  for (const Vec& p : column) {
    const double at_particle = filled(p.y());
    if (at_particle < kSurface) continue;
    double low = p.y();
    double high = p.y() + support;
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
    const double sq = (particles_.position(s) - point).squaredNorm();
    if (sq > nearest_sq) return;
    nearest_sq = sq;
    found = true;
  });
  return found ? std::sqrt(nearest_sq) : std::numeric_limits<double>::infinity();
}

}  // namespace sluice

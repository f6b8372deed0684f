#include "engine/sph/probes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/sph/equation_of_state.hpp"
#include "engine/sph/kernel.hpp"

namespace sluice {

template <class Body>
void FluidProbe::for_each_in(const Box& box, const Body& body) const {
  // The boxes hold their particles, in smoothing lengths; the slack covers single precision.
  const double h = method_.smoothing_length;
  const double slack = 1e-3;
  const double x_min = box.min.x() / h - slack;
  const double x_max = box.max.x() / h + slack;
  const double y_min = box.min.y() / h - slack;
  const double y_max = box.max.y() / h + slack;
  for (std::size_t strip = bounds_.first_strip(static_cast<float>(y_min));
       strip + 1 < layout_.strip_begin.size(); ++strip) {
    if (static_cast<double>(bounds_.strip_y_min_after[strip]) > y_max) break;
    if (static_cast<double>(bounds_.strip_y_max[strip]) < y_min) continue;
    if (static_cast<double>(bounds_.strip_y_min[strip]) > y_max) continue;
    const auto& before = bounds_.x_max_before;
    const auto begin = before.begin() + layout_.strip_begin[strip];
    const auto end = before.begin() + layout_.strip_begin[strip + 1];
    auto cluster = std::lower_bound(begin, end, static_cast<float>(x_min));
    for (; cluster != end; ++cluster) {
      const auto c = static_cast<std::size_t>(cluster - before.begin());
      if (static_cast<double>(bounds_.x_min_after[c]) > x_max) break;
      for (std::size_t s = kCluster * c; s < kCluster * (c + 1); ++s) {
        if (particles_.id[s] >= 0.0) body(s);
      }
    }
  }
}

Probe FluidProbe::pressure(const Vec& point, double h) const {
  const LinearEquationOfState state{method_.sound_speed};
  const Vec support = Vec::Constant(method_.support_ratio() * h);
  const double inverse_sq = 1.0 / (h * h);
  double weighted = 0.0;
  double plain = 0.0;
  double filled = 0.0;
  for_each_in({point - support, point + support}, [&](std::size_t s) {
    const double r_sq = (particles_.position(s) - point).squaredNorm() * inverse_sq;
    const double w = kernel_value(method_.kernel, r_sq) * inverse_sq;
    const double excess = particles_.density_excess[s];
    weighted += state.pressure(excess) * w;
    plain += w;
    filled += w * method_.particle_mass() / (method_.reference_density + excess);
  });
  if (!(plain > 0.0)) return {};
  return {weighted / plain, filled};
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

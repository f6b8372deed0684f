// Extremes, energies and rates over the particles. Included once per SIMD target.

#if defined(SLUICE_MEASURES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_MEASURES_INL
#undef SLUICE_MEASURES_INL
#else
#define SLUICE_MEASURES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "engine/sph/loops/state-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Whether the components are within a box, its faces included.
template <int Dim, class D, class V>
HWY_INLINE auto within(D d, const BoxN<Dim>& box, const std::array<V, Dim>& x) {
  auto inside = hn::And(x[0] >= hn::Set(d, box.min[0]), x[0] <= hn::Set(d, box.max[0]));
  for (int axis = 1; axis < Dim; ++axis) {
    const V along = x[static_cast<std::size_t>(axis)];
    inside = hn::And(
        inside, hn::And(along >= hn::Set(d, box.min[axis]), along <= hn::Set(d, box.max[axis])));
  }
  return inside;
}

template <int Dim>
void measure(const ParticleSpan<Dim>& p, const MethodN<Dim>& method, const FlowDomainN<Dim>& domain,
             Motion& out) {
  using D = hn::ScalableTag<double>;
  const D d;
  using V = hn::Vec<D>;
  const auto at = [&](const double* field, std::size_t s)
                      HWY_ATTR { return hn::LoadU(d, field + s); };
  V speed_sq = hn::Zero(d);
  V low = hn::Set(d, 1e300);
  V high = hn::Set(d, -1e300);
  V front = hn::Set(d, -1e300);
  auto leaving = hn::FirstN(d, 0);
  // As cause_to_remove(). All comparisons are false for a NaN.
  const V sound_sq = hn::Set(d, method.sound_speed * method.sound_speed);
  const V most_excess = hn::Set(d, method.most_density_excess());
  const V over_from = hn::Set(d, domain.over_from());
  const V walls_reach = hn::Set(d, domain.walls_reach);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = at(p.id, s) >= hn::Zero(d);
    const auto v = load_axes<Dim>(d, p.velocity, s);
    const auto x = load_axes<Dim>(d, p.position, s);
    const V rho = at(p.density_excess, s);
    const V v_sq = plain_dot(v, v);
    speed_sq = hn::Max(speed_sq, hn::IfThenElseZero(used, v_sq));
    low = hn::Min(low, hn::IfThenElse(used, rho, low));
    high = hn::Max(high, hn::IfThenElse(used, rho, high));
    front = hn::Max(front, hn::IfThenElse(used, x[0], front));
    const V y = x[kUpAxis];
    const auto inside = within<Dim>(d, domain.box, x);
    const auto over = hn::AndNot(within<Dim>(d, domain.rim, x), y >= over_from);
    const auto in_wall = hn::AndNot(within<Dim>(d, domain.room, x), y < walls_reach);
    const auto kept = hn::AndNot(hn::Or(over, in_wall), inside);
    const auto fit = hn::And(v_sq <= sound_sq, hn::Abs(rho) <= most_excess);
    leaving = hn::Or(leaving, hn::AndNot(hn::And(kept, fit), used));
  }
  Motion seen;
  seen.speed_sq = hn::GetLane(hn::MaxOfLanes(d, speed_sq));
  seen.min_density_excess = hn::GetLane(hn::MinOfLanes(d, low));
  seen.max_density_excess = hn::GetLane(hn::MaxOfLanes(d, high));
  seen.max_x = hn::GetLane(hn::MaxOfLanes(d, front));
  seen.leaving = !hn::AllFalse(d, leaving);
  out.merge(seen);
}

template <int Dim>
void measure_acceleration(const ParticleSpan<Dim>& p, Motion& out) {
  using D = hn::ScalableTag<double>;
  const D d;
  hn::Vec<D> largest = hn::Zero(d);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.id + s) >= hn::Zero(d);
    const auto a = load_axes<Dim>(d, p.acceleration, s);
    largest = hn::Max(largest, hn::IfThenElseZero(used, plain_dot(a, a)));
  }
  out.acceleration_sq = std::max(out.acceleration_sq, hn::GetLane(hn::MaxOfLanes(d, largest)));
}

template <typename T, int Dim>
void measure_rates(const ParticleSpan<Dim>& p, const Rates<T, Dim>& r, Motion& out) {
  const State d;
  StateVec largest = hn::Zero(d);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.id + s) >= hn::Zero(d);
    const auto a = array_of<Dim>([&](auto axis) HWY_ATTR { return load_acceleration(r, axis, s); });
    largest = hn::Max(largest, hn::IfThenElseZero(used, plain_dot(a, a)));
  }
  out.acceleration_sq = std::max(out.acceleration_sq, hn::GetLane(hn::MaxOfLanes(d, largest)));
}

/// ln(1 + s) - s/(1 + s) = s^2/2 - 2 s^3/3 + 3 s^4/4 - ... The series is quicker and, since the two
/// nearly cancel, more exact where the fluid is hardly compressed: its rest is below 1e-15 of it.
HWY_INLINE StateVec compression(StateVec s) {
  const State d;
  constexpr double kHardly = 0.02;
  constexpr int kTerms = 9;
  StateVec sum = hn::Zero(d);
  for (int k = kTerms + 1; k >= 2; --k) {
    sum = hn::Set(d, static_cast<double>(k - 1) / k) - s * sum;
  }
  const StateVec series = s * s * sum;
  if (hn::AllTrue(d, hn::Abs(s) <= hn::Set(d, kHardly))) return series;
  double excess[kCluster];
  double exact[kCluster];
  hn::StoreU(s, d, excess);
  hn::StoreU(series, d, exact);
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    const double e = excess[lane];
    if (std::abs(e) > kHardly) exact[lane] = std::log1p(e) - e / (1.0 + e);
  }
  return hn::LoadU(d, exact);
}

template <int Dim>
void sum_energy(const ParticleSpan<Dim>& p, const MethodN<Dim>& method, Energy& out) {
  const State d;
  StateVec speeds_sq = hn::Zero(d);
  StateVec lifts = hn::Zero(d);
  StateVec compressions = hn::Zero(d);
  const auto f = array_of<Dim>([&](auto axis) HWY_ATTR {
    return hn::Set(d, method.gravity[static_cast<Eigen::Index>(axis)]);
  });
  const StateVec rho_0 = hn::Set(d, method.reference_density);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.id + s) >= hn::Zero(d);
    const auto at = [&](const double* field)
                        HWY_ATTR { return hn::IfThenElseZero(used, hn::LoadU(d, field + s)); };
    const auto v = array_of<Dim>([&](auto axis) HWY_ATTR { return at(p.velocity[axis]); });
    const auto x = array_of<Dim>([&](auto axis) HWY_ATTR { return at(p.position[axis]); });
    speeds_sq = speeds_sq + plain_dot(v, v);
    lifts = lifts - plain_dot(f, x);
    compressions = compressions + compression(at(p.density_excess) / rho_0);
  }
  const double mass = method.particle_mass();
  const double c_sq = method.sound_speed * method.sound_speed;
  out.kinetic += 0.5 * mass * hn::GetLane(hn::SumOfLanes(d, speeds_sq));
  out.potential += mass * hn::GetLane(hn::SumOfLanes(d, lifts));
  out.internal += mass * c_sq * hn::GetLane(hn::SumOfLanes(d, compressions));
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

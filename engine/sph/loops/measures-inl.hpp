// Extremes, energies and rates over the particles. Included once per SIMD target.

#if defined(SLUICE_MEASURES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_MEASURES_INL
#undef SLUICE_MEASURES_INL
#else
#define SLUICE_MEASURES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "engine/sph/loops/state-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline void measure(const ParticleSpan& p, const Method& method, const FlowDomain& domain,
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
  const Box& box = domain.box;
  const Box& room = domain.room;
  const V over_from = hn::Set(d, domain.over_from());
  const V rim_left = hn::Set(d, domain.rim_left);
  const V rim_right = hn::Set(d, domain.rim_right);
  const V room_left = hn::Set(d, room.min.x());
  const V room_right = hn::Set(d, room.max.x());
  const V room_floor = hn::Set(d, room.min.y());
  const V room_ceiling = hn::Set(d, room.max.y());
  const V walls_reach = hn::Set(d, domain.walls_reach);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = at(p.id, s) >= hn::Zero(d);
    const V vx = at(p.vx, s);
    const V vy = at(p.vy, s);
    const V x = at(p.x, s);
    const V y = at(p.y, s);
    const V rho = at(p.density_excess, s);
    const V v_sq = vx * vx + vy * vy;
    speed_sq = hn::Max(speed_sq, hn::IfThenElseZero(used, v_sq));
    low = hn::Min(low, hn::IfThenElse(used, rho, low));
    high = hn::Max(high, hn::IfThenElse(used, rho, high));
    front = hn::Max(front, hn::IfThenElse(used, x, front));
    const auto inside =
        hn::And(hn::And(x >= hn::Set(d, box.min.x()), x <= hn::Set(d, box.max.x())),
                hn::And(y >= hn::Set(d, box.min.y()), y <= hn::Set(d, box.max.y())));
    const auto over = hn::And(y >= over_from, hn::Or(x<rim_left, x> rim_right));
    const auto outside_room =
        hn::Or(hn::Or(x<room_left, x> room_right), hn::Or(y<room_floor, y> room_ceiling));
    const auto in_wall = hn::And(y < walls_reach, outside_room);
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

inline void measure_acceleration(const ParticleSpan& p, Motion& out) {
  using D = hn::ScalableTag<double>;
  const D d;
  hn::Vec<D> largest = hn::Zero(d);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.id + s) >= hn::Zero(d);
    const auto ax = hn::LoadU(d, p.ax + s);
    const auto ay = hn::LoadU(d, p.ay + s);
    largest = hn::Max(largest, hn::IfThenElseZero(used, ax * ax + ay * ay));
  }
  out.acceleration_sq = std::max(out.acceleration_sq, hn::GetLane(hn::MaxOfLanes(d, largest)));
}

template <typename T>
void measure_rates(const ParticleSpan& p, const Rates<T>& r, Motion& out) {
  const State d;
  StateVec largest = hn::Zero(d);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.id + s) >= hn::Zero(d);
    const auto ax = load_rate(r, r.blocks.x, r.acceleration_scale, r.gravity.x(), s);
    const auto ay = load_rate(r, r.blocks.y, r.acceleration_scale, r.gravity.y(), s);
    largest = hn::Max(largest, hn::IfThenElseZero(used, ax * ax + ay * ay));
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

inline void sum_energy(const ParticleSpan& p, const Method& method, Energy& out) {
  const State d;
  StateVec speeds_sq = hn::Zero(d);
  StateVec lifts = hn::Zero(d);
  StateVec compressions = hn::Zero(d);
  const StateVec fx = hn::Set(d, method.gravity.x());
  const StateVec fy = hn::Set(d, method.gravity.y());
  const StateVec rho_0 = hn::Set(d, method.reference_density);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.id + s) >= hn::Zero(d);
    const auto at = [&](const double* field)
                        HWY_ATTR { return hn::IfThenElseZero(used, hn::LoadU(d, field + s)); };
    const StateVec vx = at(p.vx);
    const StateVec vy = at(p.vy);
    speeds_sq = speeds_sq + (vx * vx + vy * vy);
    lifts = lifts - (fx * at(p.x) + fy * at(p.y));
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

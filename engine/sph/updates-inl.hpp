// The loops over particles. Included once per SIMD target. Plain arithmetic: each element is
// rounded the same way in a vector and alone, which is what exact restart needs (the build forbids
// contraction).

#if defined(SLUICE_UPDATES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_UPDATES_INL
#undef SLUICE_UPDATES_INL
#else
#define SLUICE_UPDATES_INL
#endif

#include <hwy/highway.h>

#include <limits>
#include <type_traits>

#include "engine/sph/updates.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
HWY_INLINE double acceleration(const Rates<T>& rates, const T* sum, double gravity, std::size_t s) {
  return rates.acceleration_scale * static_cast<double>(sum[s]) + gravity;
}

template <typename T>
void leap_frog(const ParticleSpan& p, const Rates<T>& rates, double dt_mean, double dt) {
  // One field at a time: the compiler sees short loops without aliases.
  const auto kick = [&](double* HWY_RESTRICT half, double* HWY_RESTRICT full,
                        const T* HWY_RESTRICT sum, double scale, double constant) HWY_ATTR {
    for (std::size_t s = p.begin; s < p.end; ++s) {
      const double rate = scale * static_cast<double>(sum[s]) + constant;
      half[s] += dt_mean * rate;
      full[s] = half[s] + 0.5 * dt * rate;
    }
  };
  const auto drift = [&](double* HWY_RESTRICT x, const double* HWY_RESTRICT v) HWY_ATTR {
    for (std::size_t s = p.begin; s < p.end; ++s) x[s] += dt * v[s];
  };
  kick(p.vx_half, p.vx, rates.x_sum, rates.acceleration_scale, rates.gravity.x());
  kick(p.vy_half, p.vy, rates.y_sum, rates.acceleration_scale, rates.gravity.y());
  kick(p.density_excess_half, p.density_excess, rates.density_sum, rates.density_scale, 0.0);
  drift(p.x, p.vx_half);
  drift(p.y, p.vy_half);
}

inline void add_scaled(const ParticleSpan& p, double* HWY_RESTRICT to,
                       const double* HWY_RESTRICT from, double factor) {
  for (std::size_t s = p.begin; s < p.end; ++s) to[s] += factor * from[s];
}

inline void kick_drift(const ParticleSpan& p, double dt) {
  add_scaled(p, p.vx, p.ax, 0.5 * dt);
  add_scaled(p, p.vy, p.ay, 0.5 * dt);
  add_scaled(p, p.x, p.vx, 0.5 * dt);
  add_scaled(p, p.y, p.vy, 0.5 * dt);
}

template <typename T>
void density_drift(const ParticleSpan& p, const Rates<T>& rates, double dt) {
  double* HWY_RESTRICT density = p.density_excess;
  const T* HWY_RESTRICT sum = rates.density_sum;
  for (std::size_t s = p.begin; s < p.end; ++s) {
    density[s] += dt * (rates.density_scale * static_cast<double>(sum[s]));
  }
  add_scaled(p, p.x, p.vx, 0.5 * dt);
  add_scaled(p, p.y, p.vy, 0.5 * dt);
}

template <typename T>
void kick(const ParticleSpan& p, const Rates<T>& rates, double dt) {
  const auto one = [&](double* HWY_RESTRICT a, double* HWY_RESTRICT v, const T* HWY_RESTRICT sum,
                       double gravity) HWY_ATTR {
    for (std::size_t s = p.begin; s < p.end; ++s) {
      a[s] = acceleration(rates, sum, gravity, s);
      v[s] += 0.5 * dt * a[s];
    }
  };
  one(p.ax, p.vx, rates.x_sum, rates.gravity.x());
  one(p.ay, p.vy, rates.y_sum, rates.gravity.y());
}

template <typename T>
void write_pairs(const ParticleSpan& p, const PairScales& k, PairArrays<T>& out) {
  using D = hn::CappedTag<double, kCluster>;
  const D d;
  const hn::Rebind<T, D> d_out;
  const auto relative = [&](T* HWY_RESTRICT to, const double* HWY_RESTRICT x,
                            const double* HWY_RESTRICT origin) HWY_ATTR {
    const auto scale = hn::Set(d, k.inverse_length);
    for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
      const auto value = (hn::LoadU(d, x + s) - hn::Set(d, origin[s / kCluster])) * scale;
      if constexpr (std::is_same_v<T, double>) {
        hn::StoreU(value, d_out, to + s);
      } else {
        hn::StoreU(hn::DemoteTo(d_out, value), d_out, to + s);
      }
    }
  };
  const auto scaled = [&](T* HWY_RESTRICT to, const double* HWY_RESTRICT v) HWY_ATTR {
    for (std::size_t s = p.begin; s < p.end; ++s) to[s] = static_cast<T>(v[s] * k.inverse_speed);
  };
  relative(out.x.data(), p.x, k.origin_x);
  relative(out.y.data(), p.y, k.origin_y);
  scaled(out.u.data(), p.vx);
  scaled(out.v.data(), p.vy);

  T* HWY_RESTRICT excess = out.excess.data();
  T* HWY_RESTRICT volume = out.volume.data();
  T* HWY_RESTRICT stress = out.stress.data();
  for (std::size_t i = p.begin; i < p.end; ++i) {
    const T s = static_cast<T>(p.density_excess[i] * k.inverse_density);
    const T v = T{1} / (T{1} + s);
    excess[i] = s;
    volume[i] = v;
    stress[i] = s * v * v;
  }
  if (out.diffused.size() == 0) return;
  T* HWY_RESTRICT diffused = out.diffused.data();
  for (std::size_t i = p.begin; i < p.end; ++i) {
    diffused[i] = static_cast<T>(
        p.density_excess[i] * k.inverse_density -
        (k.hydrostatic.x() * p.x[i] + k.hydrostatic.y() * p.y[i] - k.hydrostatic_middle));
  }
}

template <typename T>
void reinitialise_density(const ParticleSpan& p, const T* excess, double reference_density) {
  for (std::size_t s = p.begin; s < p.end; ++s) {
    const double fresh = static_cast<double>(excess[s]) * reference_density;
    if (p.density_excess_half != nullptr) {
      p.density_excess_half[s] += fresh - p.density_excess[s];
    }
    p.density_excess[s] = fresh;
  }
}

inline void measure(const ParticleSpan& p, const Method& method, double ahead, Motion& out) {
  using D = hn::ScalableTag<double>;
  const D d;
  using V = hn::Vec<D>;
  const auto at = [&](const double* field, std::size_t s)
                      HWY_ATTR { return hn::LoadU(d, field + s); };
  V speed_sq = hn::Zero(d);
  V low = hn::Set(d, 1e300);
  V high = hn::Set(d, -1e300);
  auto moved = hn::FirstN(d, 0);
  auto outside = hn::FirstN(d, 0);
  auto broken = hn::FirstN(d, 0);
  const V lead = hn::Set(d, ahead);
  // As Method::keeps.
  const Box& domain = method.domain;
  const V top = hn::Set(d, method.wall_top.value_or(std::numeric_limits<double>::infinity()));
  const V rim_left = hn::Set(d, method.rim_left);
  const V rim_right = hn::Set(d, method.rim_right);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const V reach = at(p.reach, s);
    const auto used = reach < hn::Set(d, kNoReach);
    const V vx = at(p.vx, s);
    const V vy = at(p.vy, s);
    const V x = at(p.x, s);
    const V y = at(p.y, s);
    const V rho = at(p.density_excess, s);
    speed_sq = hn::Max(speed_sq, hn::IfThenElseZero(used, vx * vx + vy * vy));
    low = hn::Min(low, hn::IfThenElse(used, rho, low));
    high = hn::Max(high, hn::IfThenElse(used, rho, high));
    const V dx = x + lead * vx - at(p.x_sorted, s);
    const V dy = y + lead * vy - at(p.y_sorted, s);
    moved = hn::Or(moved, hn::And(used, dx * dx + dy * dy > reach * reach));
    const auto inside =
        hn::And(hn::And(x >= hn::Set(d, domain.min.x()), x <= hn::Set(d, domain.max.x())),
                hn::And(y >= hn::Set(d, domain.min.y()), y <= hn::Set(d, domain.max.y())));
    const auto beside = hn::Or(x<rim_left, x> rim_right);
    const auto kept = hn::AndNot(hn::And(y >= top, beside), inside);
    outside = hn::Or(outside, hn::AndNot(kept, used));
    // False for a NaN as well.
    const auto sound =
        hn::Abs(x) + hn::Abs(y) + hn::Abs(vx) + hn::Abs(vy) + hn::Abs(rho) < hn::Set(d, 1e300);
    broken = hn::Or(broken, hn::AndNot(sound, used));
  }
  out.speed_sq = hn::GetLane(hn::MaxOfLanes(d, speed_sq));
  out.min_density_excess = hn::GetLane(hn::MinOfLanes(d, low));
  out.max_density_excess = hn::GetLane(hn::MaxOfLanes(d, high));
  out.moved = !hn::AllFalse(d, moved);
  out.outside = !hn::AllFalse(d, outside);
  out.finite = hn::AllFalse(d, broken);
}

inline void measure_acceleration(const ParticleSpan& p, Motion& out) {
  using D = hn::ScalableTag<double>;
  const D d;
  hn::Vec<D> largest = hn::Zero(d);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.reach + s) < hn::Set(d, kNoReach);
    const auto ax = hn::LoadU(d, p.ax + s);
    const auto ay = hn::LoadU(d, p.ay + s);
    largest = hn::Max(largest, hn::IfThenElseZero(used, ax * ax + ay * ay));
  }
  out.acceleration_sq = hn::GetLane(hn::MaxOfLanes(d, largest));
}

template <typename T>
void measure_rates(const ParticleSpan& p, const Rates<T>& rates, Motion& out) {
  using D = hn::ScalableTag<double>;
  const D d;
  const hn::Rebind<T, D> d_sum;
  const auto rate = [&](const T* sum, double gravity, std::size_t s) HWY_ATTR {
    const auto value = hn::LoadU(d_sum, sum + s);
    const auto scale = hn::Set(d, rates.acceleration_scale);
    if constexpr (std::is_same_v<T, double>) {
      return scale * value + hn::Set(d, gravity);
    } else {
      return scale * hn::PromoteTo(d, value) + hn::Set(d, gravity);
    }
  };
  hn::Vec<D> largest = hn::Zero(d);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto used = hn::LoadU(d, p.reach + s) < hn::Set(d, kNoReach);
    const auto ax = rate(rates.x_sum, rates.gravity.x(), s);
    const auto ay = rate(rates.y_sum, rates.gravity.y(), s);
    largest = hn::Max(largest, hn::IfThenElseZero(used, ax * ax + ay * ay));
  }
  out.acceleration_sq = hn::GetLane(hn::MaxOfLanes(d, largest));
}

template <typename T>
void fill_updates(Updates<T>& out) {
  out.leap_frog = &leap_frog<T>;
  out.kick_drift = &kick_drift;
  out.density_drift = &density_drift<T>;
  out.kick = &kick<T>;
  out.write_pairs = &write_pairs<T>;
  out.reinitialise = &reinitialise_density<T>;
  out.measure = &measure;
  out.measure_acceleration = &measure_acceleration;
  out.measure_rates = &measure_rates<T>;
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

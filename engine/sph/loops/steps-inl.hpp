// The steps of both integrators and what changes the state between them. Included once per SIMD
// target. Plain arithmetic: each element is rounded the same way in a vector and alone, which is
// what exact restart needs (the build forbids contraction).

#if defined(SLUICE_STEPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_STEPS_INL
#undef SLUICE_STEPS_INL
#else
#define SLUICE_STEPS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/sph/loops/state-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
void leap_frog(const ParticleSpan& p, const Rates<T>& r, double dt_mean, double dt) {
  const State d;
  const auto kick = [&](double* HWY_RESTRICT half, double* HWY_RESTRICT full, std::size_t s,
                        StateVec rate) HWY_ATTR {
    const StateVec next = hn::LoadU(d, half + s) + hn::Set(d, dt_mean) * rate;
    hn::StoreU(next, d, half + s);
    hn::StoreU(next + hn::Set(d, 0.5 * dt) * rate, d, full + s);
    return next;
  };
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    kick(p.density_excess_half, p.density_excess, s,
         load_rate(r, r.blocks.density, r.density_scale, 0.0, s));
    const StateVec vx =
        kick(p.vx_half, p.vx, s, load_rate(r, r.blocks.x, r.acceleration_scale, r.gravity.x(), s));
    const StateVec vy =
        kick(p.vy_half, p.vy, s, load_rate(r, r.blocks.y, r.acceleration_scale, r.gravity.y(), s));
    add_scaled(p.x + s, vx, dt);
    add_scaled(p.y + s, vy, dt);
  }
}

inline void kick_drift(const ParticleSpan& p, double dt) {
  const hn::ScalableTag<double> d;
  const auto along = [&](double* HWY_RESTRICT x, double* HWY_RESTRICT v,
                         const double* HWY_RESTRICT a, std::size_t s) HWY_ATTR {
    add_scaled(v + s, hn::LoadU(d, a + s), 0.5 * dt);
    add_scaled(x + s, hn::LoadU(d, v + s), 0.5 * dt);
  };
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    along(p.x, p.vx, p.ax, s);
    along(p.y, p.vy, p.ay, s);
  }
}

template <typename T>
void density_drift(const ParticleSpan& p, const Rates<T>& r, double dt) {
  const State d;
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    add_scaled(p.density_excess + s, load_rate(r, r.blocks.density, r.density_scale, 0.0, s), dt);
    add_scaled(p.x + s, hn::LoadU(d, p.vx + s), 0.5 * dt);
    add_scaled(p.y + s, hn::LoadU(d, p.vy + s), 0.5 * dt);
  }
}

/// By how much a particle is shifted: not at a free surface, where neighbours lack and the gradient
/// of the concentration is no sign of disorder. On a lattice cut by a flat surface the trace
/// is 1.24 in the first row, 1.82 in the second and 2 from the third on (Wendland, h = 1.5 dx).
constexpr double kSurfaceTrace = 1.75;
constexpr double kInsideTrace = 1.9;

template <typename T>
void shift(const ParticleSpan& p, const Rates<T>& r, const Shift& k) {
  const State d;
  const StateVec zero = hn::Zero(d);
  const StateVec one = hn::Set(d, 1.0);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const StateVec vx = hn::LoadU(d, p.vx + s);
    const StateVec vy = hn::LoadU(d, p.vy + s);
    const StateVec trace = load_sums(r, r.blocks.trace, s) * hn::Set(d, k.trace_scale);
    const StateVec inside =
        (trace - hn::Set(d, kSurfaceTrace)) * hn::Set(d, 1.0 / (kInsideTrace - kSurfaceTrace));
    const StateVec length =
        hn::Min(hn::Max(inside, zero), one) * hn::Sqrt(vx * vx + vy * vy) * hn::Set(d, k.per_speed);
    const StateVec x = load_sums(r, r.blocks.x, s) * length;
    const StateVec y = load_sums(r, r.blocks.y, s) * length;
    const StateVec way = hn::Sqrt(x * x + y * y);
    const StateVec most = hn::Set(d, k.most);
    const StateVec held = hn::IfThenElse(way > most, most / way, one);
    add_scaled(p.x + s, x * held, 1.0);
    add_scaled(p.y + s, y * held, 1.0);
    add_scaled(p.density_excess + s, x * held, k.hydrostatic.x());
    add_scaled(p.density_excess + s, y * held, k.hydrostatic.y());
  }
}

template <typename T>
void kick(const ParticleSpan& p, const Rates<T>& r, double dt) {
  const State d;
  const auto along = [&](double* HWY_RESTRICT a, double* HWY_RESTRICT v, std::size_t s,
                         StateVec rate) HWY_ATTR {
    hn::StoreU(rate, d, a + s);
    add_scaled(v + s, rate, 0.5 * dt);
  };
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    along(p.ax, p.vx, s, load_rate(r, r.blocks.x, r.acceleration_scale, r.gravity.x(), s));
    along(p.ay, p.vy, s, load_rate(r, r.blocks.y, r.acceleration_scale, r.gravity.y(), s));
  }
}

template <typename T>
void reinitialise_density(const ParticleSpan& p, const Rates<T>& r, double reference_density) {
  const State d;
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const StateVec divisor = load_sums(r, r.blocks.x, s);
    const StateVec quotient = load_sums(r, r.blocks.density, s) / divisor;
    const StateVec fresh =
        hn::IfThenElseZero(divisor > hn::Zero(d), quotient) * hn::Set(d, reference_density);
    if (p.density_excess_half != nullptr) {
      add_scaled(p.density_excess_half + s, fresh - hn::LoadU(d, p.density_excess + s), 1.0);
    }
    hn::StoreU(fresh, d, p.density_excess + s);
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

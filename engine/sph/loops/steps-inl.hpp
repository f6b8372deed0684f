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

template <typename T, int Dim>
void leap_frog(const ParticleSpan<Dim>& p, const Rates<T, Dim>& r, double dt_mean, double dt) {
  const State d;
  const auto kick = [&](double* HWY_RESTRICT half, double* HWY_RESTRICT full, std::size_t s,
                        StateVec rate) HWY_ATTR {
    const StateVec next = hn::LoadU(d, half + s) + hn::Set(d, dt_mean) * rate;
    hn::StoreU(next, d, half + s);
    hn::StoreU(next + hn::Set(d, 0.5 * dt) * rate, d, full + s);
    return next;
  };
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    kick(p.density_excess_half, p.density_excess, s, load_density_rate(r, s));
    unroll<Dim>([&](auto axis) HWY_ATTR {
      const StateVec v =
          kick(p.velocity_half[axis], p.velocity[axis], s, load_acceleration(r, axis, s));
      add_scaled(p.position[axis] + s, v, dt);
    });
  }
}

template <int Dim>
void kick_drift(const ParticleSpan<Dim>& p, double dt) {
  const hn::ScalableTag<double> d;
  const auto along = [&](double* HWY_RESTRICT x, double* HWY_RESTRICT v,
                         const double* HWY_RESTRICT a, std::size_t s) HWY_ATTR {
    add_scaled(v + s, hn::LoadU(d, a + s), 0.5 * dt);
    add_scaled(x + s, hn::LoadU(d, v + s), 0.5 * dt);
  };
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    unroll<Dim>([&](auto axis) HWY_ATTR {
      along(p.position[axis], p.velocity[axis], p.acceleration[axis], s);
    });
  }
}

template <typename T, int Dim>
void density_drift(const ParticleSpan<Dim>& p, const Rates<T, Dim>& r, double dt) {
  const State d;
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    add_scaled(p.density_excess + s, load_density_rate(r, s), dt);
    unroll<Dim>([&](auto axis) HWY_ATTR {
      add_scaled(p.position[axis] + s, hn::LoadU(d, p.velocity[axis] + s), 0.5 * dt);
    });
  }
}

/// Not at a free surface, where neighbours lack and the gradient of the concentration is no sign of
/// disorder.
template <typename T, int Dim>
void shift(const ParticleSpan<Dim>& p, const Rates<T, Dim>& r, const Shift<Dim>& k) {
  const State d;
  const StateVec zero = hn::Zero(d);
  const StateVec one = hn::Set(d, 1.0);
  constexpr double kSurface = ParticleShifting::kSurfaceTrace<Dim>;
  constexpr double kPerTrace = 1.0 / (ParticleShifting::kInsideTrace<Dim> - kSurface);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto v = load_axes<Dim>(d, p.velocity, s);
    const StateVec trace = load_sums(r, r.blocks.trace, s) * hn::Set(d, k.trace_scale);
    const StateVec inside = (trace - hn::Set(d, kSurface)) * hn::Set(d, kPerTrace);
    const StateVec length =
        hn::Min(hn::Max(inside, zero), one) * hn::Sqrt(plain_dot(v, v)) * hn::Set(d, k.per_speed);
    const auto wanted = array_of<Dim>(
        [&](auto axis) HWY_ATTR { return load_sums(r, r.blocks.vector[axis], s) * length; });
    const StateVec way = hn::Sqrt(plain_dot(wanted, wanted));
    const StateVec most = hn::Set(d, k.most);
    const StateVec held = hn::IfThenElse(way > most, most / way, one);
    unroll<Dim>([&](auto axis) HWY_ATTR {
      const StateVec along = wanted[axis] * held;
      add_scaled(p.position[axis] + s, along, 1.0);
      add_scaled(p.density_excess + s, along, k.hydrostatic[static_cast<Eigen::Index>(axis)]);
    });
  }
}

template <typename T, int Dim>
void kick(const ParticleSpan<Dim>& p, const Rates<T, Dim>& r, double dt) {
  const State d;
  const auto along = [&](double* HWY_RESTRICT a, double* HWY_RESTRICT v, std::size_t s,
                         StateVec rate) HWY_ATTR {
    hn::StoreU(rate, d, a + s);
    add_scaled(v + s, rate, 0.5 * dt);
  };
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    unroll<Dim>([&](auto axis) HWY_ATTR {
      along(p.acceleration[axis], p.velocity[axis], s, load_acceleration(r, axis, s));
    });
  }
}

template <typename T, int Dim>
void reinitialise_density(const ParticleSpan<Dim>& p, const Rates<T, Dim>& r,
                          double reference_density) {
  const State d;
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const StateVec divisor = load_sums(r, r.blocks.divisor, s);
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

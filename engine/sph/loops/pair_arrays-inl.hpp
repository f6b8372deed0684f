// From sums of chunks to sums of particles, and from the state to the pair arrays. Included once
// per SIMD target.

#if defined(SLUICE_PAIR_ARRAYS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_PAIR_ARRAYS_INL
#undef SLUICE_PAIR_ARRAYS_INL
#else
#define SLUICE_PAIR_ARRAYS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "engine/sph/loops/state-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
void gather(std::span<const Contribution> contributions, const T* const* sums_of_chunks,
            std::size_t stride, T* own) {
  const hn::CappedTag<T, kCluster> d;
  for (const Contribution& a : contributions) {
    const T* HWY_RESTRICT from = sums_of_chunks[a.chunk] + stride * a.place;
    T* HWY_RESTRICT to = own + stride * a.cluster;
    for (std::size_t k = 0; k < stride; k += hn::Lanes(d)) {
      hn::StoreU(hn::LoadU(d, to + k) + hn::LoadU(d, from + k), d, to + k);
    }
  }
}

/// Calls body(slot) for the particles of a span, so that a vector of the state belongs to one
/// cluster.
template <int Dim, class Body>
HWY_INLINE void for_each_vector(const ParticleSpan<Dim>& p, const Body& body) {
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(State())) body(s);
}

/// A state in the type of the sums.
template <typename T>
HWY_INLINE auto rounded(StateVec value) {
  if constexpr (std::is_same_v<T, double>) {
    return value;
  } else {
    return hn::DemoteTo(hn::Rebind<T, State>(), value);
  }
}

template <typename T, int Dim>
void write_places(const ParticleSpan<Dim>& p, const PairScales<Dim>& k, PairArrays<T, Dim>& out) {
  using Fields = PairFields<Dim>;
  const State d;
  const hn::Rebind<T, State> d_out;
  VecN<Dim> origin = k.grid->origin_cell_center(k.origin_cell[p.begin / kCluster]);
  const bool one_origin = k.grid->has_one_origin_cell();
  const bool keeps_diffused = out.keeps_diffused();
  for_each_vector(p, [&](std::size_t s) HWY_ATTR {
    if (HWY_UNLIKELY(!one_origin)) origin = k.grid->origin_cell_center(k.origin_cell[s / kCluster]);
    T* HWY_RESTRICT to = out.cluster(Fields::position, s);
    const auto x = load_axes<Dim>(d, p.position, s);
    unroll<Dim>([&](auto axis) HWY_ATTR {
      const StateVec from = hn::Set(d, origin[static_cast<Eigen::Index>(axis)]);
      const StateVec value = (x[axis] - from) * hn::Set(d, k.inverse_length);
      hn::StoreU(rounded<T>(value), d_out, to + Fields::begin(axis));
    });
    if (!keeps_diffused) return;
    StateVec hydrostatic = hn::Set(d, k.hydrostatic[0]) * x[0];
    for (std::size_t axis = 1; axis < Dim; ++axis) {
      hydrostatic =
          hydrostatic + hn::Set(d, k.hydrostatic[static_cast<Eigen::Index>(axis)]) * x[axis];
    }
    const StateVec excess = hn::LoadU(d, p.density_excess + s) * hn::Set(d, k.inverse_density);
    const StateVec psi = excess - (hydrostatic - hn::Set(d, k.hydrostatic_middle));
    hn::StoreU(rounded<T>(psi), d_out, to + Fields::begin(Fields::diffused));
  });
}

template <typename T, int Dim>
void write_velocities(const ParticleSpan<Dim>& p, const PairScales<Dim>& k,
                      PairArrays<T, Dim>& out) {
  using Fields = PairFields<Dim>;
  const State d;
  const hn::Rebind<T, State> d_out;
  for_each_vector(p, [&](std::size_t s) HWY_ATTR {
    T* HWY_RESTRICT to = out.cluster(Fields::velocity, s);
    const auto v = load_axes<Dim>(d, p.velocity, s);
    unroll<Dim>([&](auto axis) HWY_ATTR {
      hn::StoreU(rounded<T>(v[axis] * hn::Set(d, k.inverse_speed)), d_out,
                 to + Fields::begin(axis));
    });
  });
}

template <typename T, int Dim>
void write_densities(const ParticleSpan<Dim>& p, const PairScales<Dim>& k,
                     PairArrays<T, Dim>& out) {
  using Fields = PairFields<Dim>;
  const State d;
  const hn::Rebind<T, State> d_out;
  const auto one = hn::Set(d_out, T{1});
  for_each_vector(p, [&](std::size_t s) HWY_ATTR {
    T* HWY_RESTRICT to = out.cluster(0, s);
    const StateVec density = hn::LoadU(d, p.density_excess + s) * hn::Set(d, k.inverse_density);
    const auto excess = rounded<T>(density);
    const auto volume = one / (one + excess);
    hn::StoreU(excess, d_out, to + Fields::begin(Fields::excess));
    hn::StoreU(volume, d_out, to + Fields::begin(Fields::volume));
    hn::StoreU(excess * volume * volume, d_out, to + Fields::begin(Fields::pressure_term));
  });
}

template <typename T, int Dim>
void compare_with_paths(const ParticleSpan<Dim>& p, const PairArrays<T, Dim>& now,
                        const ListPathsView<T, Dim>& paths, T elapsed, Motion& out) {
  using D = hn::CappedTag<T, kCluster>;
  const D d;
  const auto t = hn::Set(d, elapsed);
  auto expired = hn::FirstN(d, 0);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto x = load_axes<Dim>(d, paths.position, s);
    const auto v = load_axes<Dim>(d, paths.velocity, s);
    const auto off = array_of<Dim>([&](auto axis) HWY_ATTR {
      const auto place = hn::LoadU(d, now.cluster(PairFields<Dim>::position + axis, s));
      return hn::NegMulAdd(v[axis], t, place - x[axis]);
    });
    const auto limit =
        hn::MulAdd(hn::Set(d, paths.skin.per_speed), sum_of_sizes(v), hn::Set(d, paths.skin.least));
    const auto used = hn::Abs(x[0]) < hn::Set(d, static_cast<T>(kNowhere));
    expired = hn::Or(expired, hn::And(used, dot(off, off) > limit * limit));
  }
  out.expired |= !hn::AllFalse(d, expired);
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

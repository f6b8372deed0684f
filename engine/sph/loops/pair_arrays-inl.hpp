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

/// to = (from - origin) * scale for the slots [begin, end)
template <class D, typename T>
HWY_INLINE void write_relative(D d, std::size_t begin, std::size_t end, T* HWY_RESTRICT to,
                               const double* HWY_RESTRICT from, double origin, double scale) {
  const hn::Rebind<T, D> d_out;
  for (std::size_t s = begin; s < end; s += hn::Lanes(d)) {
    const auto value = (hn::LoadU(d, from + s) - hn::Set(d, origin)) * hn::Set(d, scale);
    if constexpr (std::is_same_v<T, double>) {
      hn::StoreU(value, d_out, to + s);
    } else {
      hn::StoreU(hn::DemoteTo(d_out, value), d_out, to + s);
    }
  }
}

template <typename T, int Dim>
void write_places(const ParticleSpan<Dim>& p, const PairScales<Dim>& k, PairArrays<T, Dim>& out) {
  const auto write = [&](auto d, std::size_t begin, std::size_t end) HWY_ATTR {
    const VecN<Dim> origin = k.grid->origin_cell_center(k.origin_cell[begin / kCluster]);
    unroll<Dim>([&](auto axis) HWY_ATTR {
      write_relative(d, begin, end, out.position[axis].data(), p.position[axis],
                     origin[static_cast<Eigen::Index>(axis)], k.inverse_length);
    });
  };
  if (k.grid->has_one_origin_cell()) {
    write(hn::ScalableTag<double>(), p.begin, p.end);
  } else {
    for (std::size_t s = p.begin; s < p.end; s += kCluster) write(State(), s, s + kCluster);
  }
  if (out.diffused.size() == 0) return;
  T* HWY_RESTRICT diffused = out.diffused.data();
  for (std::size_t i = p.begin; i < p.end; ++i) {
    double hydrostatic = k.hydrostatic[0] * p.position[0][i];
    for (int axis = 1; axis < Dim; ++axis) {
      hydrostatic += k.hydrostatic[axis] * p.position[static_cast<std::size_t>(axis)][i];
    }
    diffused[i] = static_cast<T>(p.density_excess[i] * k.inverse_density -
                                 (hydrostatic - k.hydrostatic_middle));
  }
}

template <typename T, int Dim>
void write_velocities(const ParticleSpan<Dim>& p, const PairScales<Dim>& k,
                      PairArrays<T, Dim>& out) {
  const auto scaled = [&](T* HWY_RESTRICT to, const double* HWY_RESTRICT v) HWY_ATTR {
    for (std::size_t s = p.begin; s < p.end; ++s) to[s] = static_cast<T>(v[s] * k.inverse_speed);
  };
  unroll<Dim>([&](auto axis) HWY_ATTR { scaled(out.velocity[axis].data(), p.velocity[axis]); });
}

template <typename T, int Dim>
void write_densities(const ParticleSpan<Dim>& p, const PairScales<Dim>& k,
                     PairArrays<T, Dim>& out) {
  T* HWY_RESTRICT excess = out.excess.data();
  T* HWY_RESTRICT volume = out.volume.data();
  T* HWY_RESTRICT pressure_term = out.pressure_term.data();
  for (std::size_t i = p.begin; i < p.end; ++i) {
    const T s = static_cast<T>(p.density_excess[i] * k.inverse_density);
    const T v = T{1} / (T{1} + s);
    excess[i] = s;
    volume[i] = v;
    pressure_term[i] = s * v * v;
  }
}

template <typename T, int Dim>
void compare_with_paths(const ParticleSpan<Dim>& p, const PairArrays<T, Dim>& now,
                        const ListPathsView<T, Dim>& paths, const Skin<T>& skin, T elapsed,
                        Motion& out) {
  using D = hn::ScalableTag<T>;
  const D d;
  const auto t = hn::Set(d, elapsed);
  auto expired = hn::FirstN(d, 0);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto x = load_axes<Dim>(d, paths.position, s);
    const auto v = load_axes<Dim>(d, paths.velocity, s);
    const auto off = array_of<Dim>([&](auto axis) HWY_ATTR {
      return hn::NegMulAdd(v[axis], t, hn::LoadU(d, now.position[axis].data() + s) - x[axis]);
    });
    const auto limit =
        hn::MulAdd(hn::Set(d, skin.per_speed), sum_of_sizes(v), hn::Set(d, skin.least));
    const auto used = hn::Abs(x[0]) < hn::Set(d, static_cast<T>(kNowhere));
    expired = hn::Or(expired, hn::And(used, dot(off, off) > limit * limit));
  }
  out.expired |= !hn::AllFalse(d, expired);
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

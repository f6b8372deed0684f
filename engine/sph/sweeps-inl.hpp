// The loops over pairs. Included once per SIMD target by sweeps_float.cpp and sweeps_double.cpp.
//
// A cluster is four particles. Each sum runs one cluster i against a list of clusters j. A vector
// is seen as blocks of 128 bits: every block holds the same particles j (one broadcast load) and
// belongs to its own particle i, so that no lane is a gather and one reduction at the end serves
// all i of the vector. With AVX-512 in single precision a vector is all 4 x 4 pairs of two
// clusters.

#if defined(SLUICE_SWEEPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_SWEEPS_INL
#undef SLUICE_SWEEPS_INL
#else
#define SLUICE_SWEEPS_INL
#endif

#include <hwy/highway.h>

#include "engine/sph/kernel-inl.hpp"
#include "engine/sph/sweeps.hpp"
#include "engine/sph/terms-inl.hpp"
#include "engine/sph/updates-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How a vector of T is cut into blocks.
template <typename T>
struct Blocks {
  using D = hn::CappedTag<T, 64 / sizeof(T)>;
  using V = hn::Vec<D>;
  static constexpr std::size_t lanes = hn::MaxLanes(D());
  static constexpr std::size_t j_lanes = 16 / sizeof(T);        ///< particles j in a block
  static constexpr std::size_t i_count = lanes / j_lanes;       ///< particles i in a vector
  static constexpr std::size_t j_vectors = kCluster / j_lanes;  ///< vectors that hold a cluster j
};

/// Lane k of the result is lane k / j_lanes of what `from` points to: each block gets its particle
/// i.
template <typename T>
HWY_INLINE auto load_i(const T* HWY_RESTRICT from) {
  using B = Blocks<T>;
  const typename B::D d;
  using TI = hwy::MakeSigned<T>;
  HWY_ALIGN static constexpr auto kIndex = [] {
    struct {
      TI lane[B::lanes];
    } index{};
    for (std::size_t k = 0; k < B::lanes; ++k) index.lane[k] = static_cast<TI>(k / B::j_lanes);
    return index;
  }();
  return hn::TableLookupLanes(hn::LoadU(d, from), hn::SetTableIndices(d, kIndex.lane));
}

template <typename T>
HWY_INLINE auto load_j(const T* HWY_RESTRICT from) {
  return hn::LoadDup128(typename Blocks<T>::D(), from);
}

/// Adds up the lanes of each block and writes one value per particle i.
template <typename T, class V>
HWY_INLINE void store_block_sums(V sum, T* HWY_RESTRICT to) {
  using B = Blocks<T>;
  const typename B::D d;
  if constexpr (B::j_lanes == 4) {
    sum = sum + hn::Shuffle1032(sum);
    sum = sum + hn::Shuffle2301(sum);
  } else {
    sum = sum + hn::Shuffle01(sum);
  }
  HWY_ALIGN T lanes[B::lanes];
  hn::Store(sum, d, lanes);
  for (std::size_t i = 0; i < B::i_count; ++i) to[i] = lanes[i * B::j_lanes];
}

/// Positions of the particles i as seen from the tile of a cluster j.
template <typename T>
struct TileShift {
  T x[9];
  T y[9];
  explicit TileShift(T tile_size) {
    for (int code = 0; code < 9; ++code) {
      const int row = code / 3;
      x[code] = -static_cast<T>(code % 3 - 1) * tile_size;
      y[code] = -static_cast<T>(row - 1) * tile_size;
    }
  }
};

/// Calls body(slot of j, x_ij/h, y_ij/h) for every vector of pairs of the list.
template <typename T, class V, class Body>
HWY_INLINE void for_each_pair(const std::uint32_t* HWY_RESTRICT entry, const std::uint32_t* end,
                              const PairView<T>& other, const TileShift<T>& shift, V x_i, V y_i,
                              const Body& body) {
  using B = Blocks<T>;
  const typename B::D d;
  for (; entry != end; ++entry) {
    const std::size_t slot = kCluster * (*entry & PairList::kClusterMask);
    const std::uint32_t code = *entry >> PairList::kShiftBit;
    const V x_seen = x_i + hn::Set(d, shift.x[code]);
    const V y_seen = y_i + hn::Set(d, shift.y[code]);
    for (std::size_t part = 0; part < B::j_vectors; ++part) {
      const std::size_t j = slot + part * B::j_lanes;
      body(j, x_seen - load_j(other.x + j), y_seen - load_j(other.y + j));
    }
  }
}

/// Which terms a rate sweep sums.
enum class Sums { density, acceleration, both };
template <Sums kSums, bool kDiffusion, bool kViscosity, bool kFriction>
struct Terms {
  static constexpr bool density = kSums != Sums::acceleration;
  static constexpr bool acceleration = kSums != Sums::density;
  static constexpr bool diffusion = density && kDiffusion;
  static constexpr bool viscosity = acceleration && kViscosity;
  static constexpr bool friction = acceleration && kFriction;
};

/// What the rate sums need of the particles i of a vector, and the sums.
template <class V>
struct RateOfI {
  V u, v, density, half, diffused, stress;
  V density_sum, x_sum, y_sum;
};

template <class Shape, class Terms, bool kViscous, typename T, class V>
HWY_INLINE void add_rates(const std::uint32_t* entry, const std::uint32_t* end,
                          const PairView<T>& other, const TileShift<T>& shift, V x_i, V y_i,
                          const ArtificialViscosityTerm<T>& viscosity,
                          const DensityDiffusionTerm<T>& diffusion, RateOfI<V>& i) {
  const typename Blocks<T>::D d;
  for_each_pair(entry, end, other, shift, x_i, y_i, [&](std::size_t j, V dx, V dy) HWY_ATTR {
    PairGeometry<V> pair{dx, dy, hn::MulAdd(dx, dx, dy * dy), hn::Zero(d)};
    const V g = Shape::slope(d, pair.r_sq);
    if constexpr (Terms::density || kViscous) {
      pair.approach = hn::MulAdd(i.u - load_j(other.u + j), dx, (i.v - load_j(other.v + j)) * dy);
    }
    if constexpr (Terms::density) {
      V summand = hn::Zero(d);
      if constexpr (Terms::diffusion) {
        summand = diffusion.summand(d, i.diffused, load_j(other.diffused + j));
      }
      summand = Continuity::add_to(summand, pair, i.density);
      i.density_sum = hn::MulAdd(g * load_j(other.volume + j), summand, i.density_sum);
    }
    if constexpr (Terms::acceleration) {
      V summand = PressureGradient::summand(i.stress, load_j(other.stress + j));
      if constexpr (kViscous) {
        summand = viscosity.add_to(d, summand, pair, i.half, load_j(other.excess + j));
      }
      summand = summand * g;
      i.x_sum = hn::MulAdd(summand, dx, i.x_sum);
      i.y_sum = hn::MulAdd(summand, dy, i.y_sum);
    }
  });
}

/// eqs. 4, 5, 7 and 8 for the clusters of a chunk.
template <class Shape, class Terms, typename T>
void sum_rates(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const TermConstants<T>& k = *task.constants;
  const TileShift<T> shift(k.tile_size);
  const DensityDiffusionTerm<T> diffusion{k.two_delta};
  const ArtificialViscosityTerm<T> viscosity{k.viscosity_alpha, k.viscosity_epsilon};
  const ArtificialViscosityTerm<T> friction{k.friction_alpha, k.friction_epsilon};

  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const PairView<T>& self = task.self;
      const V x_i = load_i(self.x + slot);
      const V y_i = load_i(self.y + slot);
      RateOfI<V> i;
      i.u = load_i(self.u + slot);
      i.v = load_i(self.v + slot);
      const V excess = load_i(self.excess + slot);
      i.density = hn::Set(d, T{1}) + excess;
      i.half = hn::MulAdd(hn::Set(d, T{0.5}), excess, hn::Set(d, T{1}));
      if constexpr (Terms::diffusion) i.diffused = load_i(self.diffused + slot);
      if constexpr (Terms::acceleration) i.stress = load_i(self.stress + slot);
      i.density_sum = i.x_sum = i.y_sum = hn::Zero(d);

      const auto& fluid = *task.to_fluid;
      add_rates<Shape, Terms, Terms::viscosity>(
          fluid.entries.data() + fluid.begin[c], fluid.entries.data() + fluid.begin[c + 1],
          task.fluid, shift, x_i, y_i, viscosity, diffusion, i);
      if (task.to_wall != nullptr) {
        const auto& wall = *task.to_wall;
        add_rates<Shape, Terms, Terms::friction>(wall.entries.data() + wall.begin[c],
                                                 wall.entries.data() + wall.begin[c + 1], task.wall,
                                                 shift, x_i, y_i, friction, diffusion, i);
      }
      if constexpr (Terms::density) store_block_sums(i.density_sum, task.density_sum + slot);
      if constexpr (Terms::acceleration) {
        store_block_sums(i.x_sum, task.x_sum + slot);
        store_block_sums(i.y_sum, task.y_sum + slot);
      }
    }
  }
}

/// Quotient of two sums over W, for the particles i of a vector; 0 where nothing is near.
template <typename T, class V>
HWY_INLINE void store_quotient(V numerator, V divisor, T* HWY_RESTRICT to) {
  using B = Blocks<T>;
  T above[B::i_count];
  T below[B::i_count];
  store_block_sums(numerator, above);
  store_block_sums(divisor, below);
  for (std::size_t i = 0; i < B::i_count; ++i) to[i] = below[i] > T{0} ? above[i] / below[i] : T{0};
}

/// eq. 9 for the wall clusters of a chunk.
template <class Shape, typename T>
void sum_wall_pressure(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const TileShift<T> shift(task.constants->tile_size);
  const WallPressureTerm<T> term{task.constants->gravity_x, task.constants->gravity_y};
  const auto& fluid = *task.to_fluid;
  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      V pressure = hn::Zero(d);
      V weight = hn::Zero(d);
      for_each_pair(fluid.entries.data() + fluid.begin[c],
                    fluid.entries.data() + fluid.begin[c + 1], task.fluid, shift,
                    load_i(task.self.x + slot), load_i(task.self.y + slot),
                    [&](std::size_t j, V dx, V dy) HWY_ATTR {
                      const V w = Shape::value(d, hn::MulAdd(dx, dx, dy * dy));
                      const V p = term.summand(d, dx, dy, load_j(task.fluid.excess + j));
                      pressure = hn::MulAdd(w, p, pressure);
                      weight = weight + w;
                    });
      store_quotient(pressure, weight, task.density_sum + slot);
    }
  }
}

/// eq. 10 for the clusters of a chunk.
template <class Shape, typename T>
void sum_reinitialisation(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const TileShift<T> shift(task.constants->tile_size);
  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const V x_i = load_i(task.self.x + slot);
      const V y_i = load_i(task.self.y + slot);
      V excess = hn::Zero(d);
      V weight = hn::Zero(d);
      const auto add = [&](const PairList::Chunk& list, const PairView<T>& other) HWY_ATTR {
        for_each_pair(list.entries.data() + list.begin[c], list.entries.data() + list.begin[c + 1],
                      other, shift, x_i, y_i, [&](std::size_t j, V dx, V dy) HWY_ATTR {
                        const V w = Shape::value(d, hn::MulAdd(dx, dx, dy * dy));
                        const V volume = load_j(other.volume + j);
                        const V s = ShepardTerm::numerator(load_j(other.excess + j), volume);
                        excess = hn::MulAdd(w, s, excess);
                        weight = hn::MulAdd(w, volume, weight);
                      });
      };
      add(*task.to_fluid, task.fluid);
      if (task.to_wall != nullptr) add(*task.to_wall, task.wall);
      store_quotient(excess, weight, task.density_sum + slot);
    }
  }
}

template <typename T>
std::size_t prune_list(const PruneTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const TileShift<T> shift(task.tile_size);
  constexpr std::size_t parts = kCluster / B::i_count;
  V x_i[parts];
  V y_i[parts];
  V reach_i[parts];
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t slot = kCluster * task.cluster + part * B::i_count;
    x_i[part] = load_i(task.self.x + slot);
    y_i[part] = load_i(task.self.y + slot);
    reach_i[part] = load_i(task.self.reach + slot) + hn::Set(d, task.cut_off);
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < task.count; ++n) {
    const std::uint32_t entry = task.candidates[n];
    const std::size_t slot = kCluster * (entry & PairList::kClusterMask);
    const std::uint32_t code = entry >> PairList::kShiftBit;
    bool near = false;
    for (std::size_t part = 0; part < parts; ++part) {
      for (std::size_t k = 0; k < B::j_vectors; ++k) {
        const std::size_t j = slot + k * B::j_lanes;
        const V dx = x_i[part] + hn::Set(d, shift.x[code]) - load_j(task.other.x + j);
        const V dy = y_i[part] + hn::Set(d, shift.y[code]) - load_j(task.other.y + j);
        const V limit = reach_i[part] + load_j(task.other.reach + j);
        near |= !hn::AllFalse(d, hn::MulAdd(dx, dx, dy * dy) < limit * limit);
      }
    }
    task.out[kept] = entry;
    kept += near ? 1U : 0U;
  }
  return kept;
}

template <class Shape, Sums kSums, typename T>
typename Sweeps<T>::Sweep select_rates(const Method& m) {
  const auto with = [&]<bool kDiffusion, bool kViscosity>() -> typename Sweeps<T>::Sweep {
    return m.wall_friction ? &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, true>, T>
                           : &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, false>, T>;
  };
  // What a sweep does not sum is not a choice: the same loop serves both, and is compiled once.
  if constexpr (kSums == Sums::density) {
    return m.diffusion ? &sum_rates<Shape, Terms<kSums, true, false, false>, T>
                       : &sum_rates<Shape, Terms<kSums, false, false, false>, T>;
  } else if constexpr (kSums == Sums::acceleration) {
    return m.viscosity ? with.template operator()<false, true>()
                       : with.template operator()<false, false>();
  } else {
    if (m.diffusion) {
      return m.viscosity ? with.template operator()<true, true>()
                         : with.template operator()<true, false>();
    }
    return m.viscosity ? with.template operator()<false, true>()
                       : with.template operator()<false, false>();
  }
}

template <class Shape, typename T>
void fill_sweeps(const Method& method, Sweeps<T>& out) {
  if (method.integrator == Integrator::modified_leap_frog) {
    out.density_and_acceleration = select_rates<Shape, Sums::both, T>(method);
  } else {
    out.density = select_rates<Shape, Sums::density, T>(method);
    out.acceleration = select_rates<Shape, Sums::acceleration, T>(method);
  }
  out.wall_pressure = &sum_wall_pressure<Shape, T>;
  out.reinitialise = &sum_reinitialisation<Shape, T>;
  out.prune = &prune_list<T>;
  out.target = hwy::TargetName(HWY_TARGET);
}

template <typename T>
void fill(const Method& method, Sweeps<T>& out) {
  fill_updates(out.updates);
  if (method.kernel == KernelKind::truncated_gaussian) {
    fill_sweeps<GaussianShape>(method, out);
  } else {
    fill_sweeps<WendlandShape>(method, out);
  }
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

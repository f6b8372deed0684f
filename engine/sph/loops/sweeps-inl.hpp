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

#include <algorithm>

#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/loops/updates-inl.hpp"
#include "engine/sph/method/kernel-inl.hpp"
#include "engine/sph/terms/terms-inl.hpp"

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

/// Adds up the lanes of each block: one value per particle i.
template <typename T, class V>
HWY_INLINE void add_lanes(V sum, T* HWY_RESTRICT out) {
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
  for (std::size_t i = 0; i < B::i_count; ++i) out[i] += lanes[i * B::j_lanes];
}

/// Adds up the blocks: one value per particle j, in one block.
template <class D, class V>
HWY_INLINE auto add_blocks(D, V v) {
  if constexpr (hn::MaxLanes(D()) * sizeof(hn::TFromD<D>) == 16) {
    return v;
  } else {
    const hn::Half<D> half;
    return add_blocks(half, hn::LowerHalf(half, v) + hn::UpperHalf(half, v));
  }
}

/// What the particles j of an entry get: the sums over i, subtracted, for a pair gives one what it
/// takes from the other. `to` is the entry's place in the sums, at the first of the particles j.
template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V v) {
  const auto sum = add_blocks(typename Blocks<T>::D(), v);
  const hn::CappedTag<T, 16 / sizeof(T)> block;
  hn::StoreU(hn::LoadU(block, to) - sum, block, to);
}

/// The same for two blocks side by side.
template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V first, V second) {
  if constexpr (Blocks<T>::lanes == 4 * kCluster) {
    const hn::Half<typename Blocks<T>::D> half;
    const auto a = hn::LowerHalf(half, first) + hn::UpperHalf(half, first);
    const auto b = hn::LowerHalf(half, second) + hn::UpperHalf(half, second);
    const auto sums = hn::ConcatLowerLower(half, b, a) + hn::ConcatUpperUpper(half, b, a);
    hn::StoreU(hn::LoadU(half, to) - sums, half, to);
  } else {
    subtract_from_j(to, first);
    subtract_from_j(to + kCluster, second);
  }
}

/// For places of which all blocks are one vector: `even` and `odd` hold, in two blocks each, what
/// is to be added up for the blocks 0 and 2, and for 1 and 3.
template <typename T, class V>
HWY_INLINE void subtract_halves(T* HWY_RESTRICT to, V even, V odd) {
  const typename Blocks<T>::D d;
  const V sums =
      hn::OddEvenBlocks(odd, even) + hn::SwapAdjacentBlocks(hn::OddEvenBlocks(even, odd));
  hn::StoreU(hn::LoadU(d, to) - sums, d, to);
}

template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V density, V y, V x) {
  const typename Blocks<T>::D d;
  if constexpr (Blocks<T>::lanes == kRateSums.stride) {
    // The last block is not read.
    const V even = hn::ConcatLowerLower(d, x, density) + hn::ConcatUpperUpper(d, x, density);
    subtract_halves(to, even, V(y + hn::ConcatLowerUpper(d, y, y)));
  } else {
    subtract_from_j(to + kRateSums.density, density);
    subtract_from_j(to + kRateSums.y, y);
    subtract_from_j(to + kRateSums.x, x);
  }
}

template <typename T, class V>
HWY_INLINE void subtract_from_j(T* HWY_RESTRICT to, V density, V y, V x, V trace) {
  const typename Blocks<T>::D d;
  constexpr SumBlocks blocks = kDensityAndShiftingSums;
  if constexpr (Blocks<T>::lanes == blocks.stride) {
    const V even = hn::ConcatLowerLower(d, x, density) + hn::ConcatUpperUpper(d, x, density);
    const V odd = hn::ConcatLowerLower(d, trace, y) + hn::ConcatUpperUpper(d, trace, y);
    subtract_halves(to, even, odd);
  } else {
    subtract_from_j(to + blocks.density, density);
    subtract_from_j(to + blocks.y, y);
    subtract_from_j(to + blocks.x, x);
    subtract_from_j(to + blocks.trace, trace);
  }
}

/// Positions of the particles i as seen from the origin cell of a cluster j.
template <typename T>
struct OriginShift {
  T x[9];
  T y[9];
  explicit OriginShift(T origin_cell_size) {
    for (int code = 0; code < 9; ++code) {
      const int row = code / 3;
      x[code] = -static_cast<T>(code % 3 - 1) * origin_cell_size;
      y[code] = -static_cast<T>(row - 1) * origin_cell_size;
    }
  }
};

/// Place in the sums of the particles j of an entry, or of its vector `part`.
template <typename T>
HWY_INLINE T* place_of(T* sums, std::size_t stride, const PairList::Chunk& list, std::size_t entry,
                       std::size_t part) {
  return sums + stride * list.targets[entry] + part * Blocks<T>::j_lanes;
}

/// Calls body(slot of j, x_ij/h, y_ij/h, entry, part) for every vector of pairs of cluster c, the
/// c-th of the list's chunk.
template <typename T, class V, class Body>
HWY_INLINE void for_each_pair(const PairList::Chunk& list, std::size_t c, const PairView<T>& other,
                              const OriginShift<T>& shift, V x_i, V y_i, const Body& body) {
  using B = Blocks<T>;
  const typename B::D d;
  const std::uint32_t* HWY_RESTRICT entries = list.entries.data();
  std::uint32_t seen_from = kSameOriginCell;
  V x_seen = x_i;
  V y_seen = y_i;
  for (std::size_t n = list.begin[c]; n != list.begin[c + 1]; ++n) {
    const std::size_t slot = kCluster * (entries[n] & PairList::kClusterMask);
    const std::uint32_t code = entries[n] >> PairList::kShiftBit;
    if (HWY_UNLIKELY(code != seen_from)) {
      seen_from = code;
      x_seen = x_i + hn::Set(d, shift.x[code]);
      y_seen = y_i + hn::Set(d, shift.y[code]);
    }
    for (std::size_t part = 0; part < B::j_vectors; ++part) {
      const std::size_t j = slot + part * B::j_lanes;
      body(j, x_seen - load_j(other.x + j), y_seen - load_j(other.y + j), n, part);
    }
  }
}

/// Who gets the sums of a list: the particles i, or both of a pair.
enum class Share { i_alone, both };

/// What holds the fluid back at walls: nothing, eq. 8, a stress that acts in the fluid as well, or
/// a wall law.
enum class Viscosity { none, linear, with_impacts };
enum class Drag { none, wall_artificial_viscosity, laminar_viscosity, wall_shear };

/// Which terms a rate sweep sums.
enum class Sums { density, acceleration, both };
template <Sums kSums, bool kDiffusion, Viscosity kViscosity, Drag kDrag, bool kShifting = false>
struct Terms {
  static_assert(!kShifting || kSums == Sums::density);
  static constexpr bool density = kSums != Sums::acceleration;
  static constexpr bool acceleration = kSums != Sums::density;
  static constexpr bool diffusion = density && kDiffusion;
  static constexpr Viscosity viscosity = acceleration ? kViscosity : Viscosity::none;
  static constexpr Viscosity friction = acceleration && kDrag == Drag::wall_artificial_viscosity
                                            ? Viscosity::linear
                                            : Viscosity::none;
  static constexpr bool laminar = acceleration && kDrag == Drag::laminar_viscosity;
  static constexpr bool wall_shear = acceleration && kDrag == Drag::wall_shear;
  static constexpr bool shifting = kShifting;
  static constexpr SumBlocks blocks = shifting        ? kDensityAndShiftingSums
                                      : !acceleration ? kDensitySums
                                      : !density      ? kAccelerationSums
                                                      : kRateSums;
};

/// What the rate sums need of the particles i of a vector, and the sums.
template <class V>
struct RateOfI {
  V u, v, speed, density, half, volume, diffused, pressure_term;
  V density_sum, x_sum, y_sum, trace_sum;
};

/// Adds the pairs of one list to the particles i and, where `sums` is given, to the particles j.
template <class Shape, class Terms, Viscosity kViscosity, Share kShare, typename T, class V>
HWY_INLINE void add_rates(const PairList::Chunk& list, std::size_t c, const PairView<T>& other,
                          const OriginShift<T>& shift, V x_i, V y_i,
                          const ArtificialViscosityTerm<T>& viscosity,
                          const LaminarViscosityTerm<T>& laminar,
                          const WallShearTerm<T>& wall_shear,
                          const DensityDiffusionTerm<T>& diffusion, RateOfI<V>& i, T* sums) {
  const typename Blocks<T>::D d;
  const auto body = [&](std::size_t j, V dx, V dy, std::size_t n, std::size_t part) HWY_ATTR {
    PairGeometry<V> pair{dx, dy, hn::MulAdd(dx, dx, dy * dy), hn::Zero(d)};
    const V g = Shape::slope(d, pair.r_sq);
    if constexpr (Terms::density || kViscosity != Viscosity::none) {
      pair.approach = hn::MulAdd(i.u - load_j(other.u + j), dx, (i.v - load_j(other.v + j)) * dy);
    }
    V density_j, x_j, y_j, trace_j;
    if constexpr (Terms::density) {
      V exchange = hn::Zero(d);
      if constexpr (Terms::diffusion) {
        exchange = diffusion.summand(d, i.diffused, load_j(other.diffused + j));
      }
      const V summand = Continuity::add_to(exchange, pair, i.density);
      const V volume_j = g * load_j(other.volume + j);
      i.density_sum = hn::MulAdd(volume_j, summand, i.density_sum);
      if constexpr (Terms::shifting) {
        i.x_sum = hn::MulAdd(volume_j, ShiftingTerm::x(pair), i.x_sum);
        i.y_sum = hn::MulAdd(volume_j, ShiftingTerm::y(pair), i.y_sum);
        i.trace_sum = hn::MulAdd(volume_j, ShiftingTerm::trace(pair), i.trace_sum);
      }
      if constexpr (kShare == Share::both) {
        const V density = hn::Set(d, T{1}) + load_j(other.excess + j);
        const V volume_i = g * i.volume;
        density_j = volume_i * Continuity::add_for_j(exchange, pair, density);
        if constexpr (Terms::shifting) {
          x_j = volume_i * ShiftingTerm::x(pair);
          y_j = volume_i * ShiftingTerm::y(pair);
          trace_j = hn::Neg(volume_i * ShiftingTerm::trace(pair));
        }
      }
    }
    if constexpr (Terms::acceleration) {
      V summand = PressureGradient::summand(i.pressure_term, load_j(other.pressure_term + j));
      if constexpr (kViscosity != Viscosity::none) {
        constexpr bool kImpacts = kViscosity == Viscosity::with_impacts;
        summand =
            viscosity.template add_to<kImpacts>(d, summand, pair, i.half, load_j(other.excess + j));
      }
      summand = summand * g;
      x_j = summand * dx;
      y_j = summand * dy;
      if constexpr (Terms::laminar) {
        x_j = hn::NegMulAdd(g, laminar.summand(d, i.u, load_j(other.u + j)), x_j);
        y_j = hn::NegMulAdd(g, laminar.summand(d, i.v, load_j(other.v + j)), y_j);
      }
      if constexpr (Terms::wall_shear && kShare == Share::i_alone) {
        x_j = hn::NegMulAdd(g, wall_shear.summand(d, i.speed, i.u), x_j);
        y_j = hn::NegMulAdd(g, wall_shear.summand(d, i.speed, i.v), y_j);
      }
      i.x_sum = i.x_sum + x_j;
      i.y_sum = i.y_sum + y_j;
    }
    if constexpr (kShare == Share::both) {
      T* const to = place_of(sums, Terms::blocks.stride, list, n, part);
      if constexpr (Terms::density && Terms::acceleration) {
        subtract_from_j(to, density_j, y_j, x_j);
      } else if constexpr (Terms::shifting) {
        subtract_from_j(to, density_j, y_j, x_j, trace_j);
      } else if constexpr (Terms::density) {
        subtract_from_j(to, density_j);
      } else {
        subtract_from_j(to, y_j, x_j);
      }
    }
  };
  for_each_pair(list, c, other, shift, x_i, y_i, body);
}

/// eqs. 4, 5, 7, 8, the viscous stress and the wall law for the clusters of a chunk.
template <class Shape, class Terms, typename T>
void sum_rates(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const TermConstants<T>& k = *task.constants;
  const OriginShift<T> shift(k.origin_cell_size);
  const DensityDiffusionTerm<T> diffusion{k.two_delta};
  const DensityDiffusionTerm<T> wall_diffusion{k.two_delta_wall};
  const ArtificialViscosityTerm<T> viscosity{k.viscosity_alpha, k.viscosity_epsilon,
                                             k.viscosity_beta};
  const ArtificialViscosityTerm<T> friction{k.friction_alpha, k.friction_epsilon, T{0}};
  const LaminarViscosityTerm<T> laminar{k.two_nu};
  const WallShearTerm<T> wall_shear{k.wall_two_nu_by_speed};
  std::fill_n(task.sums, Terms::blocks.stride * task.to_fluid->places(), T{});

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
      if constexpr (Terms::density) i.volume = load_i(self.volume + slot);
      if constexpr (Terms::diffusion) i.diffused = load_i(self.diffused + slot);
      if constexpr (Terms::acceleration) i.pressure_term = load_i(self.pressure_term + slot);
      if constexpr (Terms::wall_shear) i.speed = hn::Sqrt(hn::MulAdd(i.u, i.u, i.v * i.v));
      i.density_sum = i.x_sum = i.y_sum = i.trace_sum = hn::Zero(d);

      add_rates<Shape, Terms, Terms::viscosity, Share::both>(*task.to_fluid, c, task.fluid, shift,
                                                             x_i, y_i, viscosity, laminar,
                                                             wall_shear, diffusion, i, task.sums);
      if (task.to_wall != nullptr) {
        add_rates<Shape, Terms, Terms::friction, Share::i_alone>(
            *task.to_wall, c, task.wall, shift, x_i, y_i, friction, laminar, wall_shear,
            wall_diffusion, i, task.sums);
      }
      T* const sums = task.sums + Terms::blocks.stride * c + part;
      if constexpr (Terms::density) add_lanes(i.density_sum, sums + Terms::blocks.density);
      if constexpr (Terms::acceleration || Terms::shifting) {
        add_lanes(i.x_sum, sums + Terms::blocks.x);
        add_lanes(i.y_sum, sums + Terms::blocks.y);
      }
      if constexpr (Terms::shifting) add_lanes(i.trace_sum, sums + Terms::blocks.trace);
    }
  }
}

/// eq. 9 for the wall clusters of a chunk; 0 where no fluid is near.
template <class Shape, typename T>
void sum_wall_pressure(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T> shift(task.constants->origin_cell_size);
  const WallPressureTerm<T> term{task.constants->gravity_x, task.constants->gravity_y};
  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      V pressure = hn::Zero(d);
      V weight = hn::Zero(d);
      for_each_pair(*task.to_fluid, c, task.fluid, shift, load_i(task.self.x + slot),
                    load_i(task.self.y + slot),
                    [&](std::size_t j, V dx, V dy, std::size_t, std::size_t) HWY_ATTR {
                      const V w = Shape::value(d, hn::MulAdd(dx, dx, dy * dy));
                      const V p = term.summand(d, dx, dy, load_j(task.fluid.excess + j));
                      pressure = hn::MulAdd(w, p, pressure);
                      weight = weight + w;
                    });
      T above[B::i_count] = {};
      T below[B::i_count] = {};
      add_lanes(pressure, above);
      add_lanes(weight, below);
      for (std::size_t i = 0; i < B::i_count; ++i) {
        task.sums[slot + i] = below[i] > T{0} ? above[i] / below[i] : T{0};
      }
    }
  }
}

/// Numerator and divisor of eq. 10 for the clusters of a chunk.
template <class Shape, typename T>
void sum_reinitialisation(const SweepTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T> shift(task.constants->origin_cell_size);
  constexpr SumBlocks blocks = kReinitialisationSums;
  std::fill_n(task.sums, blocks.stride * task.to_fluid->places(), T{});
  for (std::size_t c = 0; c < task.clusters; ++c) {
    for (std::size_t part = 0; part < kCluster; part += B::i_count) {
      const std::size_t slot = kCluster * (task.first_cluster + c) + part;
      const V x_i = load_i(task.self.x + slot);
      const V y_i = load_i(task.self.y + slot);
      const V volume_i = load_i(task.self.volume + slot);
      const V numerator_i = ShepardTerm::numerator(load_i(task.self.excess + slot), volume_i);
      V excess = hn::Zero(d);
      V weight = hn::Zero(d);
      const auto add = [&]<Share kShare>(const PairList::Chunk& list,
                                         const PairView<T>& other) HWY_ATTR {
        for_each_pair(list, c, other, shift, x_i, y_i,
                      [&](std::size_t j, V dx, V dy, std::size_t n, std::size_t of_j) HWY_ATTR {
                        const V w = Shape::value(d, hn::MulAdd(dx, dx, dy * dy));
                        const V volume = load_j(other.volume + j);
                        const V s = ShepardTerm::numerator(load_j(other.excess + j), volume);
                        excess = hn::MulAdd(w, s, excess);
                        weight = hn::MulAdd(w, volume, weight);
                        if constexpr (kShare == Share::both) {
                          const V minus_w = hn::Neg(w);
                          subtract_from_j(place_of(task.sums, blocks.stride, list, n, of_j),
                                          minus_w * numerator_i, minus_w * volume_i);
                        }
                      });
      };
      add.template operator()<Share::both>(*task.to_fluid, task.fluid);
      if (task.to_wall != nullptr) {
        add.template operator()<Share::i_alone>(*task.to_wall, task.wall);
      }
      T* const sums = task.sums + blocks.stride * c + part;
      add_lanes(excess, sums + blocks.density);
      add_lanes(weight, sums + blocks.x);
    }
  }
}

/// Rows hold a few clusters that are near, a vector of them or less.
inline std::size_t search_boxes(const SearchTask& task) {
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const auto left = hn::Set(d, task.left);
  const auto right = hn::Set(d, task.right);
  const auto low = hn::Set(d, task.low);
  const auto high = hn::Set(d, task.high);
  const auto left_after = hn::Set(d, task.left_after);
  const BoxesView& boxes = task.boxes;
  std::size_t found = 0;
  for (SearchTask::Row& row : task.rows) {
    std::uint32_t j = std::max(row.next, task.first);
    for (; j < row.end; j += lanes) {
      const auto reached = hn::LoadU(d, boxes.x_max_before + j) >= left_after;
      const auto first = hn::FindFirstTrue(d, reached);
      if (first < 0) continue;
      j += static_cast<std::uint32_t>(first);
      break;
    }
    row.next = j;
    for (; j < row.end; j += lanes) {
      const auto level =
          hn::And(hn::LoadU(d, boxes.y_max + j) >= low, hn::LoadU(d, boxes.y_min + j) <= high);
      const auto near = hn::And(clusters_within(d, boxes, j, row.end, left, right), level);
      found += list_slots(d, near, j + (kSameOriginCell << PairList::kShiftBit), task.out + found);
      if (j + lanes < row.end && boxes.x_min_after[j + lanes] > task.right) break;
    }
  }
  return found;
}

/// Where the particles i or j of a vector are in the middle of the lists' lifetime, their
/// velocities and what they may be off.
template <class V>
struct PathOf {
  V x, y, u, v, skin;
};

template <typename T, class V, class Load>
HWY_INLINE PathOf<V> load_path(const ListPathsView<T>& paths, std::size_t slot, const Load& load) {
  const typename Blocks<T>::D d;
  constexpr Skin<T> skin = kSkin<T>;
  const V half_life = hn::Set(d, T{0.5} * skin.lifetime);
  const V u = load(paths.u + slot);
  const V v = load(paths.v + slot);
  return {hn::MulAdd(half_life, u, load(paths.x + slot)),
          hn::MulAdd(half_life, v, load(paths.y + slot)), u, v,
          hn::MulAdd(hn::Set(d, skin.per_speed), hn::Abs(u) + hn::Abs(v), hn::Set(d, skin.least))};
}

template <typename T>
std::size_t prune_list(const PruneTask<T>& task) {
  using B = Blocks<T>;
  using V = typename B::V;
  const typename B::D d;
  const OriginShift<T> shift(task.origin_cell_size);
  constexpr std::size_t parts = kCluster / B::i_count;
  const auto of_i = [](const T* from) HWY_ATTR { return load_i(from); };
  const auto of_j = [](const T* from) HWY_ATTR { return load_j(from); };
  const V half_life = hn::Set(d, T{0.5} * kSkin<T>.lifetime);
  PathOf<V> i[parts];
  for (std::size_t part = 0; part < parts; ++part) {
    i[part] = load_path<T, V>(task.self, kCluster * task.cluster + part * B::i_count, of_i);
    i[part].skin = i[part].skin + hn::Set(d, task.cut_off);
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < task.count; ++n) {
    const std::uint32_t entry = task.candidates[n];
    const std::size_t slot = kCluster * (entry & PairList::kClusterMask);
    const std::uint32_t code = entry >> PairList::kShiftBit;
    bool near = false;
    for (std::size_t k = 0; k < B::j_vectors; ++k) {
      const auto j = load_path<T, V>(task.other, slot + k * B::j_lanes, of_j);
      for (std::size_t part = 0; part < parts; ++part) {
        const V dx = i[part].x + hn::Set(d, shift.x[code]) - j.x;
        const V dy = i[part].y + hn::Set(d, shift.y[code]) - j.y;
        const V passing = hn::Abs(i[part].u - j.u) + hn::Abs(i[part].v - j.v);
        const V limit = hn::MulAdd(half_life, passing, i[part].skin + j.skin);
        near |= !hn::AllFalse(d, hn::MulAdd(dx, dx, dy * dy) < limit * limit);
      }
    }
    task.out[kept] = entry;
    kept += near ? 1U : 0U;
  }
  return kept;
}

template <class Shape, Sums kSums, typename T, bool kShifting = false>
typename Sweeps<T>::Sweep select_rates(const Method& m) {
  using enum Viscosity;
  const auto with = [&]<bool kDiffusion, Viscosity kViscosity>() -> typename Sweeps<T>::Sweep {
    if (m.wall_artificial_viscosity) {
      return &sum_rates<Shape,
                        Terms<kSums, kDiffusion, kViscosity, Drag::wall_artificial_viscosity>, T>;
    }
    if (m.wall_shear) {
      return &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, Drag::wall_shear>, T>;
    }
    return m.laminar_viscosity
               ? &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, Drag::laminar_viscosity>, T>
               : &sum_rates<Shape, Terms<kSums, kDiffusion, kViscosity, Drag::none>, T>;
  };
  const auto with_viscosity = [&]<bool kDiffusion>() {
    if (!m.viscosity) return with.template operator()<kDiffusion, none>();
    return m.viscosity->beta > 0.0 ? with.template operator()<kDiffusion, with_impacts>()
                                   : with.template operator()<kDiffusion, linear>();
  };
  // What a sweep does not sum is not a choice: the same loop serves both, and is compiled once.
  if constexpr (kSums == Sums::density) {
    return m.diffusion ? &sum_rates<Shape, Terms<kSums, true, none, Drag::none, kShifting>, T>
                       : &sum_rates<Shape, Terms<kSums, false, none, Drag::none, kShifting>, T>;
  } else if constexpr (kSums == Sums::acceleration) {
    return with_viscosity.template operator()<false>();
  } else {
    return m.diffusion ? with_viscosity.template operator()<true>()
                       : with_viscosity.template operator()<false>();
  }
}

template <class Shape, typename T>
void fill_sweeps(const Method& method, Sweeps<T>& out) {
  if (method.integrator == Integrator::modified_leap_frog) {
    out.density_and_acceleration = select_rates<Shape, Sums::both, T>(method);
  } else {
    out.density = select_rates<Shape, Sums::density, T>(method);
    out.density_and_shift = select_rates<Shape, Sums::density, T, true>(method);
    out.acceleration = select_rates<Shape, Sums::acceleration, T>(method);
  }
  out.wall_pressure = &sum_wall_pressure<Shape, T>;
  out.reinitialise = &sum_reinitialisation<Shape, T>;
  out.updates.sum_around = &sum_around<Shape>;
  out.search = &search_boxes;
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

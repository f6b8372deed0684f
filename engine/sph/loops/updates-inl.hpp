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

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "engine/sph/loops/updates.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// As many state values as a cluster has, or a vector holds.
using State = hn::CappedTag<double, kCluster>;
using StateVec = hn::Vec<State>;

/// Sums of the particles from slot s on.
template <typename T>
HWY_INLINE StateVec load_sums(const Rates<T>& rates, std::size_t block, std::size_t s) {
  const State d;
  const hn::Rebind<T, State> d_sum;
  const std::size_t n = s - rates.first_slot;
  const T* from = rates.sums + rates.blocks.stride * (n / kCluster) + block + n % kCluster;
  if constexpr (std::is_same_v<T, double>) {
    return hn::LoadU(d, from);
  } else {
    return hn::PromoteTo(d, hn::LoadU(d_sum, from));
  }
}

template <typename T>
HWY_INLINE StateVec load_rate(const Rates<T>& rates, std::size_t block, double scale,
                              double constant, std::size_t s) {
  const State d;
  return hn::Set(d, scale) * load_sums(rates, block, s) + hn::Set(d, constant);
}

template <class V>
HWY_INLINE void add_scaled(double* HWY_RESTRICT to, V value, double factor) {
  const hn::DFromV<V> d;
  hn::StoreU(hn::LoadU(d, to) + hn::Set(d, factor) * value, d, to);
}

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

template <typename T>
void write_places(const ParticleSpan& p, const PairScales& k, PairArrays<T>& out) {
  const auto write = [&](auto d, std::size_t begin, std::size_t end) HWY_ATTR {
    const Vec origin = k.grid->origin_cell_center(k.origin_cell[begin / kCluster]);
    write_relative(d, begin, end, out.x.data(), p.x, origin.x(), k.inverse_length);
    write_relative(d, begin, end, out.y.data(), p.y, origin.y(), k.inverse_length);
  };
  if (k.grid->has_one_origin_cell()) {
    write(hn::ScalableTag<double>(), p.begin, p.end);
  } else {
    for (std::size_t s = p.begin; s < p.end; s += kCluster) write(State(), s, s + kCluster);
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
void write_velocities(const ParticleSpan& p, const PairScales& k, PairArrays<T>& out) {
  const auto scaled = [&](T* HWY_RESTRICT to, const double* HWY_RESTRICT v) HWY_ATTR {
    for (std::size_t s = p.begin; s < p.end; ++s) to[s] = static_cast<T>(v[s] * k.inverse_speed);
  };
  scaled(out.u.data(), p.vx);
  scaled(out.v.data(), p.vy);
}

template <typename T>
void write_densities(const ParticleSpan& p, const PairScales& k, PairArrays<T>& out) {
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

template <typename T>
void compare_with_paths(const ParticleSpan& p, const PairArrays<T>& now,
                        const ListPathsView<T>& paths, const Skin<T>& skin, T elapsed,
                        Motion& out) {
  using D = hn::ScalableTag<T>;
  const D d;
  const auto t = hn::Set(d, elapsed);
  auto expired = hn::FirstN(d, 0);
  for (std::size_t s = p.begin; s < p.end; s += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, paths.x + s);
    const auto u = hn::LoadU(d, paths.u + s);
    const auto v = hn::LoadU(d, paths.v + s);
    const auto dx = hn::NegMulAdd(u, t, hn::LoadU(d, now.x.data() + s) - x);
    const auto dy = hn::NegMulAdd(v, t, hn::LoadU(d, now.y.data() + s) - hn::LoadU(d, paths.y + s));
    const auto limit =
        hn::MulAdd(hn::Set(d, skin.per_speed), hn::Abs(u) + hn::Abs(v), hn::Set(d, skin.least));
    const auto used = hn::Abs(x) < hn::Set(d, static_cast<T>(kNowhere));
    expired = hn::Or(expired, hn::And(used, hn::MulAdd(dx, dx, dy * dy) > limit * limit));
  }
  out.expired |= !hn::AllFalse(d, expired);
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

inline void measure(const ParticleSpan& p, const Method& method, Motion& out) {
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
  const Box& domain = method.domain;
  const Box& room = method.room;
  const V over_from = hn::Set(d, method.over_from());
  const V rim_left = hn::Set(d, method.rim_left);
  const V rim_right = hn::Set(d, method.rim_right);
  const V room_left = hn::Set(d, room.min.x());
  const V room_right = hn::Set(d, room.max.x());
  const V room_floor = hn::Set(d, room.min.y());
  const V room_ceiling = hn::Set(d, room.max.y());
  const V walls_reach = hn::Set(d, method.walls_reach);
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
        hn::And(hn::And(x >= hn::Set(d, domain.min.x()), x <= hn::Set(d, domain.max.x())),
                hn::And(y >= hn::Set(d, domain.min.y()), y <= hn::Set(d, domain.max.y())));
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

/// Which of the clusters from j on, before `end`, reach into [left, right].
template <class D, class V>
HWY_INLINE auto clusters_within(D d, const BoxesView& boxes, std::uint32_t j, std::uint32_t end,
                                V left, V right) {
  const auto beside =
      hn::And(hn::LoadU(d, boxes.x_max + j) >= left, hn::LoadU(d, boxes.x_min + j) <= right);
  return hn::And(beside, hn::FirstN(d, end - j));
}

/// Writes first, first + 1, ... for the lanes of the mask, and a vector's worth beyond; returns how
/// many they are.
template <class D, class M>
HWY_INLINE std::size_t list_slots(D, M mask, std::uint32_t first, std::uint32_t* HWY_RESTRICT out) {
  const hn::RebindToUnsigned<D> d_number;
  const auto chosen = hn::RebindMask(d_number, mask);
  const auto numbers = hn::Iota(d_number, 0) + hn::Set(d_number, first);
  hn::StoreU(hn::Compress(numbers, chosen), d_number, out);
  return hn::CountTrue(d_number, chosen);
}

/// The first cluster of a row that reaches `left`, or its end. Clusters lie about evenly along a
/// row, so that it is mostly in the vector that is tried first.
inline std::uint32_t first_near(const BoxesView& boxes, const Surroundings::Row& row) {
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const float* const reach = boxes.x_max_before;
  const float low = boxes.x_min_after[row.begin];
  const float length = reach[row.end - 1] - low;
  const auto count = static_cast<float>(row.end - row.begin);
  const float guess = (row.left - low) / length * count - 0.5F * static_cast<float>(lanes);
  // Written so that no number, too, is a guess within the row.
  const float most = count - 1.0F;
  const auto at =
      row.begin + static_cast<std::uint32_t>(guess > 0.0F ? std::min(guess, most) : 0.0F);
  if (at == row.begin || reach[at - 1] < row.left) {
    const auto found = hn::FindFirstTrue(d, hn::LoadU(d, reach + at) >= hn::Set(d, row.left));
    if (found >= 0) return std::min(row.end, at + static_cast<std::uint32_t>(found));
  }
  const float* const first = std::lower_bound(reach + row.begin, reach + row.end, row.left);
  return static_cast<std::uint32_t>(first - reach);
}

/// Clusters listed before they are summed over: of some rows, so that the two loops seldom end.
constexpr std::size_t kListed = 64;

/// Calls body(clusters) for those near the point, in memory order.
template <class Body>
HWY_INLINE void for_clusters_around(const Surroundings& around, const Body& body) {
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const BoxesView& boxes = around.boxes;
  std::uint32_t listed[kListed + kTail];
  std::size_t count = 0;
  for (const Surroundings::Row& row : around.rows) {
    const auto left = hn::Set(d, row.left);
    const auto right = hn::Set(d, row.right);
    for (std::uint32_t j = first_near(boxes, row); j < row.end; j += lanes) {
      if (boxes.x_min_after[j] > row.right) break;
      count += list_slots(d, clusters_within(d, boxes, j, row.end, left, right), j, listed + count);
      if (count >= kListed) {
        body(std::span<const std::uint32_t>(listed, count));
        count = 0;
      }
    }
  }
  body(std::span<const std::uint32_t>(listed, count));
}

template <class Shape>
PointSums sum_around(const Particles& p, const Surroundings& around) {
  const State d;
  const StateVec inverse_h = hn::Set(d, 1.0 / around.smoothing_length);
  const StateVec x = hn::Set(d, around.point.x());
  const StateVec y = hn::Set(d, around.point.y());
  const StateVec rho_0 = hn::Set(d, around.reference_density);
  StateVec kernel = hn::Zero(d);
  StateVec excess = hn::Zero(d);
  StateVec volumes = hn::Zero(d);
  const auto add = [&](std::size_t s) HWY_ATTR {
    const auto used = hn::LoadU(d, p.id.data() + s) >= hn::Zero(d);
    const StateVec dx = (hn::LoadU(d, p.x.data() + s) - x) * inverse_h;
    const StateVec dy = (hn::LoadU(d, p.y.data() + s) - y) * inverse_h;
    const StateVec w = hn::IfThenElseZero(used, Shape::value(d, dx * dx + dy * dy));
    const StateVec e = hn::IfThenElseZero(used, hn::LoadU(d, p.density_excess.data() + s));
    kernel = kernel + w;
    excess = excess + w * e;
    volumes = volumes + w / (rho_0 + e);
  };
  for_clusters_around(around, [&](std::span<const std::uint32_t> clusters) HWY_ATTR {
    for (const std::uint32_t cluster : clusters) {
      const std::size_t first = kCluster * cluster;
      for (std::size_t s = first; s < first + kCluster; s += hn::Lanes(d)) add(s);
    }
  });
  return {hn::GetLane(hn::SumOfLanes(d, kernel)), hn::GetLane(hn::SumOfLanes(d, excess)),
          hn::GetLane(hn::SumOfLanes(d, volumes))};
}

template <typename T>
void fill_updates(Updates<T>& out) {
  out.leap_frog = &leap_frog<T>;
  out.kick_drift = &kick_drift;
  out.density_drift = &density_drift<T>;
  out.shift = &shift<T>;
  out.kick = &kick<T>;
  out.write_places = &write_places<T>;
  out.write_velocities = &write_velocities<T>;
  out.write_densities = &write_densities<T>;
  out.compare = &compare_with_paths<T>;
  out.gather = &gather<T>;
  out.reinitialise = &reinitialise_density<T>;
  out.measure = &measure;
  out.measure_acceleration = &measure_acceleration;
  out.measure_rates = &measure_rates<T>;
  out.sum_energy = &sum_energy;
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

#include "engine/sph/engine.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "engine/sph/kernel.hpp"

namespace sluice {
namespace {

// A pair list serves until a particle has used up its reach. A particle's reach grows with its
// speed, so that all use theirs up at about the same time and a few fast ones do not force a sort
// at each step.
constexpr double kListLifetime = 5.0;  // h/c
constexpr double kReachMargin = 1.3;   // of the distance at present speed in that time
constexpr double kLeastReach = 0.03;   // h
constexpr double kMostReach = 1.5;     // h
constexpr double kListSlack = 1e-3;    // lists are longer than the reach by more than any rounding

constexpr double kForceCourant = 0.25;  // of the force limit beside eq. 18
constexpr std::uint32_t kManyNeighbours = 200;

/// Adds the wall time of its life to one pass.
class PassClock {
 public:
  PassClock(std::array<double, kPassCount>& seconds, Pass pass)
      : seconds_(seconds[static_cast<std::size_t>(pass)]), start_(Clock::now()) {}
  ~PassClock() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_;
};

template <typename T>
class Engine final : public Solver::Impl {
 public:
  Engine(const Method& m, const SolverState& state, const std::vector<Vec>& walls,
         const Execution& exec);

  void step() override;
  [[nodiscard]] std::vector<double> wall_pressures() const override;
  [[nodiscard]] double pair_lanes() const override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  // Start.
  void place_walls(const std::vector<Vec>& walls);
  void load(const SolverState& state);
  void start_kick_drift_kick();

  // Order in memory.
  void sort();
  void retire(const std::vector<std::uint32_t>& slots);
  void reorder(const Layout& next);
  void set_reach();
  void bind();
  void place_sums();
  [[nodiscard]] std::uint32_t most_neighbours();
  [[nodiscard]] std::uint32_t count_most_neighbours() const;

  // Passes.
  void step_leap_frog();
  void step_kick_drift_kick();
  void sort_if_needed();
  void sum_wall_pressure();
  void reinitialise();
  void run_sweep(typename Sweeps<T>::Sweep loop, const PairList* to_wall);
  void gather(const ParticleSpan& p, std::span<const SumBlock> blocks);
  void measure();
  void note_motion();
  void choose_time_step();
  [[nodiscard]] bool reinitialisation_due(std::uint64_t step) const;

  // Views.
  [[nodiscard]] std::size_t chunks() const { return (layout.clusters() + kChunk - 1) / kChunk; }
  [[nodiscard]] ParticleSpan span(std::size_t chunk);
  [[nodiscard]] static PairView<T> view(const PairArrays<T>& arrays);
  [[nodiscard]] Rates<T> rates() const;
  [[nodiscard]] PairScales scales() const;
  void resize_pairs(PairArrays<T>& arrays, std::size_t slots) const;

  /// Calls body(span, chunk) for every chunk and gathers what each saw.
  template <class Body>
  Motion for_chunks(const Body& body);

  Grid grid_;
  Sweeps<T> sweeps_;
  ThreadTeam team_;
  TermConstants<T> constants_;
  PairArrays<T> pairs_;
  AlignedArray<T> density_sum_, x_sum_, y_sum_;
  std::vector<double> origin_x_, origin_y_;  // per cluster
  PairList fluid_to_fluid_, fluid_to_wall_, wall_to_fluid_;
  std::vector<AlignedArray<T>> chunk_sums_;  // of fluid_to_fluid_, per chunk
  struct Arrival {  // sums that another chunk has for a cluster of this one
    std::uint32_t chunk, place, cluster;
  };
  std::vector<std::vector<Arrival>> arrivals_;  // per chunk, by the chunk they come from
  Motion motion_;

  Layout wall_layout_;
  ClusterBounds wall_bounds_;
  PairArrays<T> walls_;
  AlignedArray<T> wall_excess_;
  std::vector<double> wall_hydrostatic_;  // of psi, per slot
};

template <typename T>
Engine<T>::Engine(const Method& m, const SolverState& state, const std::vector<Vec>& walls,
                  const Execution& exec)
    : grid_(m.domain, m.spacing, m.smoothing_length, state.particles.size() + walls.size()),
      sweeps_(select_sweeps<T>(m, exec.simd_target)),
      team_(exec.threads) {
  method = m;
  execution = exec;
  wall_count = walls.size();
  simd_target = sweeps_.target;

  constants_.tile_size = static_cast<T>(grid_.tile_size() / m.smoothing_length);
  if (m.diffusion) constants_.two_delta = static_cast<T>(2.0 * m.diffusion->delta);
  if (m.viscosity) {
    constants_.viscosity_alpha = static_cast<T>(m.viscosity->alpha);
    constants_.viscosity_epsilon = static_cast<T>(m.viscosity->epsilon);
  }
  if (m.wall_friction) {
    constants_.friction_alpha = static_cast<T>(m.wall_friction->alpha);
    constants_.friction_epsilon = static_cast<T>(m.wall_friction->epsilon);
  }
  const Vec gravity = m.gravity * m.smoothing_length / (m.sound_speed * m.sound_speed);
  constants_.gravity_x = static_cast<T>(gravity.x());
  constants_.gravity_y = static_cast<T>(gravity.y());

  if (wall_count > 0) place_walls(walls);
  load(state);
}

template <typename T>
void Engine<T>::resize_pairs(PairArrays<T>& arrays, std::size_t slots) const {
  for (auto* a : {&arrays.x, &arrays.y, &arrays.u, &arrays.v, &arrays.excess, &arrays.volume,
                  &arrays.stress, &arrays.reach}) {
    a->resize(slots);
  }
  // Molteni-Colagrossi diffuses the excess itself: no field of its own.
  const bool own = method.diffusion && method.diffusion->kind == DiffusionKind::fourtakas;
  if (own) arrays.diffused.resize(slots);
}

template <typename T>
PairView<T> Engine<T>::view(const PairArrays<T>& a) {
  const T* diffused = a.diffused.size() > 0 ? a.diffused.data() : a.excess.data();
  return {a.x.data(),      a.y.data(), a.u.data(),      a.v.data(),    a.excess.data(),
          a.volume.data(), diffused,   a.stress.data(), a.reach.data()};
}

template <typename T>
void Engine<T>::place_walls(const std::vector<Vec>& walls) {
  const std::size_t count = walls.size();
  std::vector<double> x(count);
  std::vector<double> y(count);
  std::vector<double> id(count);
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = walls[i].x();
    y[i] = walls[i].y();
    id[i] = static_cast<double>(i);
  }
  wall_layout_ = sort_into_clusters(team_, grid_, x, y, id, all);
  const std::size_t slots = wall_layout_.slots();
  resize_pairs(walls_, slots);
  wall_excess_.resize(slots);
  const double h = method.smoothing_length;
  std::vector<double> slot_x(slots, 0.0);
  std::vector<double> slot_y(slots, 0.0);
  std::vector<double> slot_id(slots, -1.0);
  const std::vector<double> no_reach(slots, 0.0);
  for (std::size_t s = 0; s < slots; ++s) {
    const std::uint32_t i = wall_layout_.source[s];
    if (i == Layout::kEmpty) continue;
    slot_x[s] = x[i];
    slot_y[s] = y[i];
    slot_id[s] = id[i];
  }
  wall_bounds_.assign(team_, grid_, wall_layout_, h, slot_x.data(), slot_y.data(), no_reach.data(),
                      slot_id.data());
  if (walls_.diffused.size() > 0) wall_hydrostatic_.assign(slots, 0.0);
  for (std::size_t s = 0; s < slots; ++s) {
    const bool used = slot_id[s] >= 0.0;
    const Vec origin = grid_.tile_center(wall_bounds_.tile[s / kCluster]);
    const double far = -1e8 * static_cast<double>(s + 1);
    walls_.x[s] = static_cast<T>(used ? (slot_x[s] - origin.x()) / h : far);
    walls_.y[s] = static_cast<T>(used ? (slot_y[s] - origin.y()) / h : far);
    walls_.volume[s] = T{1};
    if (walls_.diffused.size() > 0) {
      const Vec place(slot_x[s], slot_y[s]);
      wall_hydrostatic_[s] =
          used ? scales().hydrostatic.dot(place) - scales().hydrostatic_middle : 0.0;
    }
  }
}

template <typename T>
void Engine<T>::load(const SolverState& state) {
  step_count = state.step;
  time = state.time;
  time_step = state.time_step;
  retired = state.retired;
  particle_count = state.particles.size();

  Particles source = state.particles;
  const bool fresh = source.x_sorted.empty();
  if (fresh) {
    source.x_sorted = source.x;
    source.y_sorted = source.y;
    source.reach.assign(particle_count, 0.0);
    if (method.integrator == Integrator::modified_leap_frog) {
      source.vx_half = source.vx;
      source.vy_half = source.vy;
      source.density_excess_half = source.density_excess;
    } else {
      source.ax.assign(particle_count, 0.0);
      source.ay.assign(particle_count, 0.0);
    }
  }
  // Sorting what is in order keeps it, so this also restores the slots of a state that was taken.
  std::vector<std::uint32_t> all(particle_count);
  std::iota(all.begin(), all.end(), 0U);
  particles = std::move(source);
  reorder(
      sort_into_clusters(team_, grid_, particles.x_sorted, particles.y_sorted, particles.id, all));
  if (fresh) set_reach();
  bind();
  measure();
  if (method.integrator == Integrator::kick_drift_kick) {
    sum_wall_pressure();
    if (fresh) start_kick_drift_kick();
    measure();
  }
}

/// The acceleration that the first half kick needs.
template <typename T>
void Engine<T>::start_kick_drift_kick() {
  run_sweep(sweeps_.acceleration, wall_count > 0 ? &fluid_to_wall_ : nullptr);
  for_chunks([&](const ParticleSpan& p, Motion&) {
    gather(p, std::array{kXSum, kYSum});
    sweeps_.updates.kick(p, rates(), 0.0);
  });
}

template <typename T>
ParticleSpan Engine<T>::span(std::size_t chunk) {
  Particles& p = particles;
  const auto data = [](std::vector<double>& field) {
    return field.empty() ? nullptr : field.data();
  };
  return {kCluster * kChunk * chunk,
          std::min(kCluster * kChunk * (chunk + 1), layout.slots()),
          data(p.x),
          data(p.y),
          data(p.vx),
          data(p.vy),
          data(p.density_excess),
          data(p.vx_half),
          data(p.vy_half),
          data(p.density_excess_half),
          data(p.ax),
          data(p.ay),
          data(p.x_sorted),
          data(p.y_sorted),
          data(p.reach)};
}

template <typename T>
template <class Body>
Motion Engine<T>::for_chunks(const Body& body) {
  std::vector<Motion> seen(chunks());
  team_.run(seen.size(), [&](std::size_t chunk) { body(span(chunk), seen[chunk]); });
  Motion all;
  for (const Motion& m : seen) all.merge(m);
  return all;
}

template <typename T>
Rates<T> Engine<T>::rates() const {
  // sums -> rates: c/h, c^2/h times the volume of a particle in h^2 and the constant of grad W.
  const double slope_scale = method.kernel == KernelKind::truncated_gaussian
                                 ? TruncatedGaussian::slope_scale
                                 : WendlandC2::slope_scale;
  const double ratio = method.spacing / method.smoothing_length;
  const double scale = ratio * ratio * slope_scale * method.sound_speed / method.smoothing_length;
  return {
      density_sum_.data(),        x_sum_.data(), y_sum_.data(), scale * method.reference_density,
      scale * method.sound_speed, method.gravity};
}

template <typename T>
PairScales Engine<T>::scales() const {
  PairScales k;
  k.inverse_length = 1.0 / method.smoothing_length;
  k.inverse_speed = 1.0 / method.sound_speed;
  k.inverse_density = 1.0 / method.reference_density;
  if (method.diffusion && method.diffusion->kind == DiffusionKind::fourtakas) {
    k.hydrostatic = method.gravity / (method.sound_speed * method.sound_speed);
    k.hydrostatic_middle = k.hydrostatic.dot(method.domain.min + method.domain.max) / 2.0;
  }
  k.origin_x = origin_x_.data();
  k.origin_y = origin_y_.data();
  return k;
}

// ---- order in memory
// ---------------------------------------------------------------------------------------------

template <typename T>
void Engine<T>::sort_if_needed() {
  if (motion_.moved || motion_.outside) sort();
}

template <typename T>
void Engine<T>::sort() {
  const PassClock clock(pass_seconds, Pass::sort);
  std::vector<std::uint32_t> use;
  std::vector<std::uint32_t> gone;
  use.reserve(particle_count);
  for (std::uint32_t s = 0; s < layout.slots(); ++s) {
    if (particles.id[s] < 0.0) continue;
    (method.keeps(particles.position(s)) ? use : gone).push_back(s);
  }
  retire(gone);
  reorder(sort_into_clusters(team_, grid_, particles.x, particles.y, particles.id, use));
  particles.x_sorted = particles.x;
  particles.y_sorted = particles.y;
  set_reach();
  bind();
  ++sort_count;
}

template <typename T>
void Engine<T>::retire(const std::vector<std::uint32_t>& slots) {
  for (const std::uint32_t s : slots) {
    const bool over = method.wall_top && particles.y[s] >= *method.wall_top;
    retired.push_back({particles.id[s], over ? RetireCause::overtopped : RetireCause::leaked,
                       step_count, time, particles.x[s], particles.y[s]});
  }
  particle_count -= slots.size();
}

template <typename T>
void Engine<T>::reorder(const Layout& next) {
  for (const Field& field : kFields) {
    if (!carries(method.integrator, field)) continue;
    std::vector<double>& values = particles.*field.member;
    double empty = 0.0;
    if (field.name == "id") empty = -1.0;
    if (field.name == "reach") empty = kNoReach;
    // Far from everything, and from each other.
    const bool place = field.unit == "m" && field.name != "reach";
    const double apart = place ? 1e8 * method.smoothing_length : 0.0;
    std::vector<double> moved(next.slots());
    constexpr std::size_t kBlock = kCluster * kChunk;
    team_.run((next.slots() + kBlock - 1) / kBlock, [&](std::size_t block) {
      const std::size_t end = std::min(next.slots(), kBlock * (block + 1));
      for (std::size_t s = kBlock * block; s < end; ++s) {
        moved[s] = next.source[s] != Layout::kEmpty ? values[next.source[s]]
                                                    : empty + apart * static_cast<double>(s + 1);
      }
    });
    values = std::move(moved);
  }
  layout = next;
}

template <typename T>
void Engine<T>::set_reach() {
  const double h = method.smoothing_length;
  const double time_span = kReachMargin * kListLifetime * h / method.sound_speed;
  for_chunks([&](const ParticleSpan& p, Motion&) {
    for (std::size_t s = p.begin; s < p.end; ++s) {
      if (particles.id[s] < 0.0) continue;
      const double path = particles.velocity(s).norm() * time_span;
      // In this order a speed that is not a number gives the longest reach, and the guards see it.
      particles.reach[s] = std::min(kMostReach * h, kLeastReach * h + path);
    }
  });
}

/// Everything that follows from the order: tiles, bounds, lists and pair arrays.
template <typename T>
void Engine<T>::bind() {
  const std::size_t slots = layout.slots();
  const double h = method.smoothing_length;
  bounds.assign(team_, grid_, layout, h, particles.x_sorted.data(), particles.y_sorted.data(),
                particles.reach.data(), particles.id.data());
  origin_x_.resize(layout.clusters());
  origin_y_.resize(layout.clusters());
  resize_pairs(pairs_, slots);
  for (auto* sum : {&density_sum_, &x_sum_, &y_sum_}) sum->resize(slots);

  // Lists hold for the sorted places.
  for_chunks([&](ParticleSpan p, Motion&) {
    for (std::size_t c = p.begin / kCluster; c < p.end / kCluster; ++c) {
      const Vec origin = grid_.tile_center(bounds.tile[c]);
      origin_x_[c] = origin.x();
      origin_y_[c] = origin.y();
    }
    for (std::size_t s = p.begin; s < p.end; ++s) {
      pairs_.reach[s] = static_cast<T>(
          particles.id[s] < 0.0 ? 0.0 : (particles.reach[s] / h) * (1.0 + kListSlack) + kListSlack);
    }
    p.x = particles.x_sorted.data();
    p.y = particles.y_sorted.data();
    sweeps_.updates.write_pairs(p, scales(), pairs_);
  });
  const PairRange<T> range{static_cast<T>(method.support_ratio()), constants_.tile_size};
  const PairSet<T> fluid{layout, bounds, view(pairs_)};
  build_pair_list(team_, sweeps_, range, fluid, fluid, fluid_to_fluid_);
  if (wall_count > 0) {
    const PairSet<T> wall{wall_layout_, wall_bounds_, view(walls_)};
    build_pair_list(team_, sweeps_, range, fluid, wall, fluid_to_wall_);
    build_pair_list(team_, sweeps_, range, wall, fluid, wall_to_fluid_);
  }
  place_sums();
  extremes.max_neighbours = most_neighbours();
  for_chunks(
      [&](const ParticleSpan& p, Motion&) { sweeps_.updates.write_pairs(p, scales(), pairs_); });
}

/// Room for every chunk's sums, and who brings what to whom.
template <typename T>
void Engine<T>::place_sums() {
  const auto& lists = fluid_to_fluid_.chunks;
  chunk_sums_.resize(lists.size());
  arrivals_.resize(lists.size());
  for (auto& arrivals : arrivals_) arrivals.clear();
  for (std::uint32_t k = 0; k < lists.size(); ++k) {
    chunk_sums_[k].resize(kSumStride * lists[k].places());
    auto place = static_cast<std::uint32_t>(lists[k].begin.size() - 1);
    for (const std::uint32_t guest : lists[k].guests) {
      arrivals_[guest / kChunk].push_back({k, place++, guest % static_cast<std::uint32_t>(kChunk)});
    }
  }
}

/// Exact where lists are long enough to hold too many neighbours, else the bound that they give.
template <typename T>
std::uint32_t Engine<T>::most_neighbours() {
  const auto& lists = fluid_to_fluid_.chunks;
  // Entries that a cluster takes part in, per place of each chunk.
  std::vector<std::vector<std::uint32_t>> met(lists.size());
  team_.run(lists.size(), [&](std::size_t k) {
    met[k].assign(lists[k].places(), 0);
    for (const std::uint32_t target : lists[k].targets) ++met[k][target];
    for (std::size_t c = 0; c + 1 < lists[k].begin.size(); ++c) {
      met[k][c] += lists[k].begin[c + 1] - lists[k].begin[c];
    }
  });
  std::vector<std::uint32_t> most_of(lists.size(), 0);
  team_.run(lists.size(), [&](std::size_t k) {
    std::array<std::uint32_t, kChunk> all{};
    for (std::size_t c = 0; c + 1 < lists[k].begin.size(); ++c) all[c] = met[k][c];
    for (const Arrival& a : arrivals_[k]) all[a.cluster] += met[a.chunk][a.place];
    most_of[k] = *std::max_element(all.begin(), all.end()) * static_cast<std::uint32_t>(kCluster);
  });
  std::uint32_t most = 0;
  for (const std::uint32_t m : most_of) most = std::max(most, m);
  return most <= kManyNeighbours ? most : count_most_neighbours();
}

/// Over all particles; a neighbour in another tile is left out of this count.
template <typename T>
std::uint32_t Engine<T>::count_most_neighbours() const {
  const auto& lists = fluid_to_fluid_.chunks;
  std::vector<std::uint32_t> count(layout.slots(), 0);
  const T cut_off_sq = static_cast<T>(method.support_ratio() * method.support_ratio());
  for (std::size_t k = 0; k < lists.size(); ++k) {
    for (std::size_t c = 0; c + 1 < lists[k].begin.size(); ++c) {
      const std::size_t first_i = kCluster * (kChunk * k + c);
      for (std::uint32_t e = lists[k].begin[c]; e < lists[k].begin[c + 1]; ++e) {
        const std::size_t first_j = kCluster * (lists[k].entries[e] & PairList::kClusterMask);
        for (std::size_t i = first_i; i < first_i + kCluster; ++i) {
          for (std::size_t j = first_j; j < first_j + kCluster; ++j) {
            const T dx = pairs_.x[i] - pairs_.x[j];
            const T dy = pairs_.y[i] - pairs_.y[j];
            if (!(dx * dx + dy * dy < cut_off_sq)) continue;
            ++count[i];
            if (first_i != first_j) ++count[j];
          }
        }
      }
    }
  }
  return count.empty() ? 0 : *std::max_element(count.begin(), count.end());
}

// ---- passes
// ------------------------------------------------------------------------------------------------------

template <typename T>
void Engine<T>::run_sweep(typename Sweeps<T>::Sweep loop, const PairList* to_wall) {
  team_.run(chunks(), [&](std::size_t chunk) {
    SweepTask<T> task;
    task.self = view(pairs_);
    task.fluid = task.self;
    task.wall = view(walls_);
    task.to_fluid = &fluid_to_fluid_.chunks[chunk];
    task.to_wall = to_wall != nullptr ? &to_wall->chunks[chunk] : nullptr;
    task.first_cluster = chunk * kChunk;
    task.clusters = std::min(kChunk, layout.clusters() - task.first_cluster);
    task.constants = &constants_;
    task.sums = chunk_sums_[chunk].data();
    loop(task);
  });
}

/// Adds up, in a fixed order, what a sweep left for the particles of a chunk: these blocks of the
/// sums.
template <typename T>
void Engine<T>::gather(const ParticleSpan& p, std::span<const SumBlock> blocks) {
  using Values = Eigen::Array<T, static_cast<int>(kCluster), 1>;
  const std::size_t chunk = p.begin / (kCluster * kChunk);
  for (const SumBlock block : blocks) {
    AlignedArray<T>& sum = block == kDensitySum ? density_sum_ : block == kXSum ? x_sum_ : y_sum_;
    T* const out = sum.data() + p.begin;
    const T* const own = chunk_sums_[chunk].data() + block;
    for (std::size_t c = 0; c < (p.end - p.begin) / kCluster; ++c) {
      Eigen::Map<Values>(out + kCluster * c) = Eigen::Map<const Values>(own + kSumStride * c);
    }
    for (const Arrival& a : arrivals_[chunk]) {
      const T* const from = chunk_sums_[a.chunk].data() + kSumStride * a.place + block;
      Eigen::Map<Values>(out + kCluster * a.cluster) += Eigen::Map<const Values>(from);
    }
  }
}

/// eq. 9, and from it the density, volume and stress of the dummy particles (eq. 3).
template <typename T>
void Engine<T>::sum_wall_pressure() {
  if (wall_count == 0) return;
  const PassClock clock(pass_seconds, Pass::wall_pressure);
  team_.run(wall_to_fluid_.chunks.size(), [&](std::size_t chunk) {
    SweepTask<T> task;
    task.self = view(walls_);
    task.fluid = view(pairs_);
    task.to_fluid = &wall_to_fluid_.chunks[chunk];
    task.first_cluster = chunk * kChunk;
    task.clusters = std::min(kChunk, wall_layout_.clusters() - task.first_cluster);
    task.constants = &constants_;
    task.sums = wall_excess_.data();
    sweeps_.wall_pressure(task);
    const std::size_t begin = kCluster * task.first_cluster;
    for (std::size_t s = begin; s < begin + kCluster * task.clusters; ++s) {
      T excess = wall_excess_[s];
      if (method.wall_pressure == WallPressure::clamped) excess = std::max(excess, T{0});
      const T volume = T{1} / (T{1} + excess);
      walls_.excess[s] = excess;
      walls_.volume[s] = volume;
      walls_.stress[s] = excess * volume * volume;
    }
    if (walls_.diffused.size() > 0) {
      for (std::size_t s = begin; s < begin + kCluster * task.clusters; ++s) {
        walls_.diffused[s] =
            static_cast<T>(static_cast<double>(walls_.excess[s]) - wall_hydrostatic_[s]);
      }
    }
  });
}

template <typename T>
bool Engine<T>::reinitialisation_due(std::uint64_t step) const {
  return method.reinitialisation && step > 0 &&
         step % static_cast<std::uint64_t>(method.reinitialisation->interval) == 0;
}

template <typename T>
void Engine<T>::reinitialise() {
  const PassClock clock(pass_seconds, Pass::reinitialisation);
  run_sweep(sweeps_.reinitialise, wall_count > 0 ? &fluid_to_wall_ : nullptr);
  for_chunks([&](const ParticleSpan& p, Motion&) {
    gather(p, std::array{kDensitySum, kXSum});
    for (std::size_t s = p.begin; s < p.end; ++s) {
      density_sum_[s] = x_sum_[s] > T{0} ? density_sum_[s] / x_sum_[s] : T{0};
    }
    sweeps_.updates.reinitialise(p, density_sum_.data(), method.reference_density);
    sweeps_.updates.write_pairs(p, scales(), pairs_);
  });
}

template <typename T>
void Engine<T>::note_motion() {
  extremes.max_speed = std::sqrt(motion_.speed_sq);
  extremes.min_density_excess = particle_count > 0 ? motion_.min_density_excess : 0.0;
  extremes.max_density_excess = particle_count > 0 ? motion_.max_density_excess : 0.0;
  extremes.finite = motion_.finite;
  if (method.integrator == Integrator::kick_drift_kick) {
    extremes.max_acceleration = std::sqrt(motion_.acceleration_sq);
  }
}

template <typename T>
void Engine<T>::measure() {
  motion_ = for_chunks([&](const ParticleSpan& p, Motion& seen) {
    sweeps_.updates.measure(p, method, 0.0, seen);
    if (p.ax != nullptr) sweeps_.updates.measure_acceleration(p, seen);
  });
  note_motion();
}

/// eq. 18 with its unit mended, and the force limit: dt <= C h/(c + |v|), dt <= 0.25 sqrt(h/|a|).
template <typename T>
void Engine<T>::choose_time_step() {
  const double h = method.smoothing_length;
  const double sound = method.courant * h / (method.sound_speed + extremes.max_speed);
  const double force = kForceCourant * std::sqrt(h / extremes.max_acceleration);
  step_limit = force < sound ? StepLimit::force : StepLimit::sound;
  time_step = std::min(force, sound);
}

template <typename T>
void Engine<T>::step() {
  if (method.integrator == Integrator::modified_leap_frog) {
    step_leap_frog();
  } else {
    step_kick_drift_kick();
  }
}

/// eqs. 13-17.
template <typename T>
void Engine<T>::step_leap_frog() {
  sort_if_needed();
  if (reinitialisation_due(step_count)) {
    sum_wall_pressure();
    reinitialise();
  }
  sum_wall_pressure();
  {
    const PassClock clock(pass_seconds, Pass::pair_sums);
    run_sweep(sweeps_.density_and_acceleration, wall_count > 0 ? &fluid_to_wall_ : nullptr);
  }
  const PassClock clock(pass_seconds, Pass::update);
  const Rates<T> r = rates();
  const Motion forces = for_chunks([&](const ParticleSpan& p, Motion& seen) {
    gather(p, std::array{kDensitySum, kXSum, kYSum});
    sweeps_.updates.measure_rates(p, r, seen);
  });
  extremes.max_acceleration = std::sqrt(forces.acceleration_sq);
  const double last = time_step;
  choose_time_step();
  motion_ = for_chunks([&](const ParticleSpan& p, Motion& seen) {
    sweeps_.updates.leap_frog(p, r, 0.5 * (last + time_step), time_step);
    sweeps_.updates.measure(p, method, 0.0, seen);
    sweeps_.updates.write_pairs(p, scales(), pairs_);
  });
  note_motion();
  time += time_step;
  ++step_count;
}

/// Adami et al. 2012: half kick, half drift, density, half drift, wall pressure, acceleration, half
/// kick.
template <typename T>
void Engine<T>::step_kick_drift_kick() {
  choose_time_step();
  {
    const PassClock clock(pass_seconds, Pass::update);
    motion_ = for_chunks([&](const ParticleSpan& p, Motion& seen) {
      sweeps_.updates.kick_drift(p, time_step);
      sweeps_.updates.measure(p, method, 0.5 * time_step, seen);
      sweeps_.updates.write_pairs(p, scales(), pairs_);
    });
  }
  // A sort retires what has no place any more: it is not a leak if that place is not a number.
  const bool finite = motion_.finite;
  sort_if_needed();
  const PairList* to_wall = wall_count > 0 ? &fluid_to_wall_ : nullptr;
  {
    const PassClock clock(pass_seconds, Pass::pair_sums);
    run_sweep(sweeps_.density, to_wall);
  }
  {
    const PassClock clock(pass_seconds, Pass::update);
    const Rates<T> r = rates();
    for_chunks([&](const ParticleSpan& p, Motion&) {
      gather(p, std::array{kDensitySum});
      sweeps_.updates.density_drift(p, r, time_step);
      sweeps_.updates.write_pairs(p, scales(), pairs_);
    });
  }
  sum_wall_pressure();
  if (reinitialisation_due(step_count + 1)) {
    reinitialise();
    sum_wall_pressure();
  }
  {
    const PassClock clock(pass_seconds, Pass::pair_sums);
    run_sweep(sweeps_.acceleration, to_wall);
  }
  const PassClock clock(pass_seconds, Pass::update);
  const Rates<T> r = rates();
  motion_ = for_chunks([&](const ParticleSpan& p, Motion& seen) {
    gather(p, std::array{kXSum, kYSum});
    sweeps_.updates.kick(p, r, time_step);
    sweeps_.updates.measure(p, method, 0.0, seen);
    sweeps_.updates.measure_acceleration(p, seen);
  });
  note_motion();
  extremes.finite = extremes.finite && finite;
  time += time_step;
  ++step_count;
}

// ---- for readers
// -------------------------------------------------------------------------------------------------

template <typename T>
std::vector<double> Engine<T>::wall_pressures() const {
  std::vector<double> pressures(wall_count, 0.0);
  const double scale = method.reference_density * method.sound_speed * method.sound_speed;
  for (std::size_t s = 0; s < wall_layout_.slots(); ++s) {
    if (wall_layout_.source[s] == Layout::kEmpty) continue;
    pressures[wall_layout_.source[s]] = static_cast<double>(walls_.excess[s]) * scale;
  }
  return pressures;
}

template <typename T>
double Engine<T>::pair_lanes() const {
  std::size_t entries = 0;
  for (const PairList::Chunk& chunk : fluid_to_fluid_.chunks) entries += chunk.entries.size();
  const auto pairs = static_cast<double>(kCluster * kCluster * entries);
  return pairs / static_cast<double>(std::max<std::size_t>(particle_count, 1));
}

template <typename T>
std::size_t Engine<T>::memory_bytes() const {
  std::size_t bytes = pairs_.bytes() + walls_.bytes() + density_sum_.bytes() + x_sum_.bytes() +
                      y_sum_.bytes() + fluid_to_fluid_.bytes() + fluid_to_wall_.bytes() +
                      wall_to_fluid_.bytes();
  for (const auto& sums : chunk_sums_) bytes += sums.bytes();
  for (const auto& arrivals : arrivals_) bytes += arrivals.capacity() * sizeof(Arrival);
  for (const Field& field : kFields) bytes += (particles.*field.member).capacity() * sizeof(double);
  return bytes + layout.source.capacity() * sizeof(std::uint32_t);
}

}  // namespace

template <typename T>
std::unique_ptr<Solver::Impl> make_engine(const Method& method, const SolverState& state,
                                          const std::vector<Vec>& walls,
                                          const Execution& execution) {
  return std::make_unique<Engine<T>>(method, state, walls, execution);
}

template std::unique_ptr<Solver::Impl> make_engine<float>(const Method&, const SolverState&,
                                                          const std::vector<Vec>&,
                                                          const Execution&);
template std::unique_ptr<Solver::Impl> make_engine<double>(const Method&, const SolverState&,
                                                           const std::vector<Vec>&,
                                                           const Execution&);

}  // namespace sluice

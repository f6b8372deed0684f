#include "engine/sph/solver/engine.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "engine/sph/method/kernel.hpp"
#include "engine/sph/method/removed.hpp"
#include "engine/sph/pairs/chunk_sums.hpp"
#include "engine/sph/pairs/list_paths.hpp"
#include "engine/sph/solver/dummy_particles.hpp"
#include "engine/sph/stability/neighbour_count.hpp"

namespace sluice {
namespace {

constexpr double kListSlack = 1e-3;  // lists are longer by more than any rounding

// The order in memory is state: when it is renewed is a function of the step alone.
constexpr double kOrderLifetime = 30.0;  // h/c at the largest step

// Solids are looked into by step as well: sound goes not much farther meanwhile than a solid must
// be thick.
constexpr double kSolidInterval = 4.0;  // h/c at the largest step

constexpr double kForceCourant = 0.25;  // of the force limit beside eq. 18

constexpr double kNobody = -1.0;  // id of an empty slot

constexpr double kMostShift = 0.1;  // dx at a time

/// The density of a wall follows from eq. 9 and is not kept: an exchange with it is a source, which
/// lifts still water for ever. Only where the hydrostatic part is diffused as well must the walls
/// hold against it.
bool diffuses_with_walls(const DensityDiffusion& term) {
  return term.kind == DiffusionKind::molteni_colagrossi;
}

/// Whether what is diffused is a field of its own: Molteni and Colagrossi diffuse the excess
/// itself.
bool keeps_diffused(const Method& method) {
  return method.diffusion && method.diffusion->kind == DiffusionKind::fourtakas;
}

/// The stress that a viscous stress puts on fluid sliding along a wall, over 2 rho_0 nu |v|/h, on a
/// lattice that goes on in the wall: (dx/h)^3 sum n slope(R^2), for in n rows of fluid there is a
/// row of the wall n dx below.
double stress_across_wall(const Method& m) {
  const double dx = m.spacing / m.smoothing_length;
  const int reach = static_cast<int>(m.support_ratio() / dx) + 1;
  double sum = 0.0;
  for (int n = 1; n <= reach; ++n) {
    for (int along = -reach; along <= reach; ++along) {
      const double r_sq = dx * dx * static_cast<double>(n * n + along * along);
      if (r_sq < m.support_ratio() * m.support_ratio()) sum += n * kernel_slope(m.kernel, r_sq);
    }
  }
  return dx * dx * dx * sum;
}

/// Whether it is the step for what is done every so many h/c at the largest step.
bool is_step_for(std::uint64_t step, double interval, double courant) {
  const double steps = std::max(1.0, std::round(interval / courant));
  return step % static_cast<std::uint64_t>(steps) == 0;
}

/// What the sums over pairs leave out: the volume of a particle in h^2 times the constant of grad
/// W.
double scale_of_sums(const Method& m) {
  const double ratio = m.spacing / m.smoothing_length;
  return ratio * ratio * kernel_slope_scale(m.kernel);
}

/// Lengths in m.
template <typename T>
TermConstants<T> term_constants(const Method& m, double origin_cell_size) {
  TermConstants<T> k;
  k.origin_cell_size = static_cast<T>(origin_cell_size / m.smoothing_length);
  if (m.diffusion) {
    k.two_delta = static_cast<T>(2.0 * m.diffusion->delta);
    k.two_delta_wall = diffuses_with_walls(*m.diffusion) ? k.two_delta : T{0};
  }
  if (m.viscosity) {
    k.viscosity_alpha = static_cast<T>(m.viscosity->alpha);
    k.viscosity_epsilon = static_cast<T>(m.viscosity->epsilon);
    k.viscosity_beta = static_cast<T>(m.viscosity->beta);
  }
  if (m.wall_artificial_viscosity) {
    k.friction_alpha = static_cast<T>(m.wall_artificial_viscosity->alpha);
    k.friction_epsilon = static_cast<T>(m.wall_artificial_viscosity->epsilon);
  }
  k.two_nu = static_cast<T>(m.scaled_two_nu());
  if (m.wall_shear) {
    k.wall_two_nu_by_speed =
        static_cast<T>(m.wall_shear->coefficient / (2.0 * stress_across_wall(m)));
  }
  const Vec gravity = m.gravity * m.smoothing_length / (m.sound_speed * m.sound_speed);
  k.gravity_x = static_cast<T>(gravity.x());
  k.gravity_y = static_cast<T>(gravity.y());
  return k;
}

/// Adds the wall time of its life to that of a pass.
class PassClock {
 public:
  explicit PassClock(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
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
  [[nodiscard]] Energy energy() override;
  [[nodiscard]] FluidProbe probe() const override;
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body) override {
    team_.run(count, body);
  }
  [[nodiscard]] std::vector<double> wall_pressures() const override;
  [[nodiscard]] double pair_slots() const override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  // Start.
  void load(const SolverState& state);
  void start_kick_drift_kick();

  // Order in memory.
  void sort();
  bool remove();
  [[nodiscard]] bool somebody_in_a_solid();
  void reorder(Order order);
  void bind();
  void make_lists();
  void count_neighbours();

  // Passes.
  void step_leap_frog();
  void step_kick_drift_kick();
  void advance_paths(double duration);
  void compare_with_paths(const ParticleSpan& p, Motion& seen);
  void keep_lists(const Motion& seen);
  [[nodiscard]] bool order_due();
  void sum_wall_pressure();
  void reinitialise();
  double& seconds_of(Pass pass) { return pass_seconds[static_cast<std::size_t>(pass)]; }
  void sweep_chunk(typename Sweeps<T>::Sweep loop, std::size_t chunk);
  /// Whose time a sweep is, and what is done with its sums.
  struct SweepPasses {
    Pass sums;
    Pass update;
  };
  template <class Body>
  Motion sweep(typename Sweeps<T>::Sweep loop, const SumBlocks& blocks, const Body& body,
               SweepPasses passes = {Pass::pair_sums, Pass::update});
  Rates<T> gather(const ParticleSpan& chunk, const SumBlocks& blocks);
  [[nodiscard]] Rates<T> rates_of(const ParticleSpan& chunk, const SumBlocks& blocks) const;
  void measure();
  void write_pairs(const ParticleSpan& p);
  void note_motion(const Motion& seen);
  void choose_time_step();
  [[nodiscard]] Shift shift_of_step() const;
  [[nodiscard]] bool shifting_due() const;
  [[nodiscard]] bool reinitialisation_due(std::uint64_t step) const;

  // Views.
  [[nodiscard]] ParticleSpan span(std::size_t chunk);
  [[nodiscard]] PairScales scales() const;

  /// Calls body(chunk, seen) for the span of every chunk and merges what each saw, in their order.
  template <class Seen = Motion, class Body>
  Seen for_chunks(const Body& body);
  template <class Body>
  Motion update_chunks(const Body& body);
  /// Calls body(block) for parts of a chunk that stay in the first cache from loop to loop.
  template <class Body>
  static void for_blocks(const ParticleSpan& chunk, const Body& body);

  Grid grid_;
  Sweeps<T> sweeps_;
  ThreadTeam team_;
  TermConstants<T> constants_;
  PairArrays<T> pairs_;
  PairScales scales_;
  ListPaths<T> paths_;
  PairList fluid_to_fluid_, fluid_to_wall_, wall_to_fluid_;
  ChunkSums<T> sums_;     // of fluid_to_fluid_
  bool leaving_ = false;  // a particle is to be removed

  DummyParticles<T> walls_;
};

template <typename T>
Engine<T>::Engine(const Method& m, const SolverState& state, const std::vector<Vec>& walls,
                  const Execution& exec)
    : grid_(m.domain, m.spacing, m.smoothing_length, state.particles.size() + walls.size()),
      sweeps_(select_sweeps<T>(m, exec.simd_target)),
      team_(exec.threads),
      constants_(term_constants<T>(m, grid_.origin_cell_size())),
      walls_(team_, grid_, m, walls) {
  method = m;
  execution = exec;
  wall_count = walls.size();
  simd_target = sweeps_.target;

  load(state);
  pass_seconds = {};  // of steps alone
}

template <typename T>
void Engine<T>::load(const SolverState& state) {
  step_count = state.step;
  time = state.time;
  time_step = state.time_step;
  removed = state.removed;
  particle_count = state.particles.size();

  Particles source = state.particles;
  const bool fresh = source.x_sorted.empty();
  if (fresh) {
    source.x_sorted = source.x;
    source.y_sorted = source.y;
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
  particles = std::move(source);
  // Before it spoils what others feel. A state that was taken holds nobody who is to be removed.
  if (fresh) remove();
  reorder(sort_into_clusters(team_, grid_, particles.x_sorted, particles.y_sorted, particles.id));
  walls_.lift(method, time);
  bind();
  // Between sorts nobody counts: a state that is gone on with must not be judged otherwise.
  if (fresh) count_neighbours();
  if (method.integrator == Integrator::kick_drift_kick) {
    sum_wall_pressure();
    if (fresh) start_kick_drift_kick();
  }
  measure();
}

/// The acceleration that the first half kick needs.
template <typename T>
void Engine<T>::start_kick_drift_kick() {
  sweep(sweeps_.acceleration, kAccelerationSums,
        [&](const ParticleSpan& p, const Rates<T>& rates, Motion&) {
          sweeps_.updates.kick(p, rates, 0.0);
        });
}

template <typename T>
ParticleSpan Engine<T>::span(std::size_t chunk) {
  Particles& p = particles;
  const auto data = [](std::vector<double>& field) {
    return field.empty() ? nullptr : field.data();
  };
  return {kCluster * layout.chunk_begin(chunk),
          kCluster * layout.chunk_begin(chunk + 1),
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
          data(p.id)};
}

template <typename T>
template <class Seen, class Body>
Seen Engine<T>::for_chunks(const Body& body) {
  std::vector<Seen> seen(layout.chunks());
  team_.run(seen.size(), [&](std::size_t chunk) { body(span(chunk), seen[chunk]); });
  Seen all;
  for (const Seen& one : seen) all.merge(one);
  return all;
}

template <typename T>
template <class Body>
Motion Engine<T>::update_chunks(const Body& body) {
  const PassClock clock(seconds_of(Pass::update));
  return for_chunks(body);
}

template <typename T>
template <class Body>
void Engine<T>::for_blocks(const ParticleSpan& chunk, const Body& body) {
  constexpr std::size_t kBlock = 128;
  ParticleSpan block = chunk;
  for (; block.begin < chunk.end; block.begin += kBlock) {
    block.end = std::min(block.begin + kBlock, chunk.end);
    body(block);
  }
}

template <typename T>
PairScales Engine<T>::scales() const {
  PairScales k;
  k.inverse_length = 1.0 / method.smoothing_length;
  k.inverse_speed = 1.0 / method.sound_speed;
  k.inverse_density = 1.0 / method.reference_density;
  if (keeps_diffused(method)) {
    k.hydrostatic = method.gravity / (method.sound_speed * method.sound_speed);
    k.hydrostatic_middle = k.hydrostatic.dot(method.domain.min + method.domain.max) / 2.0;
  }
  k.grid = &grid_;
  k.origin_cell = bounds.origin_cell.data();
  return k;
}

// Order in memory.

template <typename T>
bool Engine<T>::somebody_in_a_solid() {
  struct Seen {
    bool somebody = false;
    void merge(const Seen& other) { somebody |= other.somebody; }
  };
  return for_chunks<Seen>([&](const ParticleSpan& p, Seen& seen) {
           for (std::size_t s = p.begin; s < p.end; ++s) {
             seen.somebody |= p.id[s] >= 0.0 && method.in_solid({p.x[s], p.y[s]}, time);
           }
         })
      .somebody;
}

/// Whether particles are to be removed, or their order has served its time.
template <typename T>
bool Engine<T>::order_due() {
  if (method.in_solid && is_step_for(step_count, kSolidInterval, method.courant)) {
    leaving_ |= somebody_in_a_solid();
  }
  return leaving_ || is_step_for(step_count, kOrderLifetime, method.courant);
}

template <typename T>
void Engine<T>::advance_paths(double duration) {
  paths_.age += duration * method.sound_speed / method.smoothing_length;
}

template <typename T>
void Engine<T>::compare_with_paths(const ParticleSpan& p, Motion& seen) {
  sweeps_.updates.compare(p, pairs_, paths_.view(), kSkin<T>, static_cast<T>(paths_.age), seen);
}

/// New lists where the old ones no longer hold.
template <typename T>
void Engine<T>::keep_lists(const Motion& seen) {
  if (!seen.expired && paths_.age <= kSkin<double>.lifetime) return;
  const PassClock clock(seconds_of(Pass::sort));
  make_lists();
}

template <typename T>
void Engine<T>::sort() {
  const PassClock clock(seconds_of(Pass::sort));
  const bool fewer = leaving_ && remove();
  reorder(sort_into_clusters(team_, grid_, particles.x, particles.y, particles.id));
  particles.x_sorted = particles.x;
  particles.y_sorted = particles.y;
  bind();
  count_neighbours();
  ++sort_count;
  // From here on all is as a solver finds it that goes on with this state: the next step sees wall
  // pressures summed in this order, and nothing of what left.
  if (method.integrator == Integrator::kick_drift_kick) sum_wall_pressure();
  if (fewer) measure();
}

/// Takes out who is no particle of the fluid any more; whether there was any.
template <typename T>
bool Engine<T>::remove() {
  const std::size_t before = particle_count;
  for (std::size_t s = 0; s < particles.size(); ++s) {
    if (particles.id[s] < 0.0) continue;
    const auto cause = cause_to_remove(method, particles, s, time);
    if (!cause) continue;
    removed.push_back(record_of(particles, s, *cause, step_count, time));
    particles.id[s] = kNobody;
    --particle_count;
  }
  return particle_count < before;
}

template <typename T>
void Engine<T>::reorder(Order order) {
  const Layout& next = order.layout;
  std::vector<double> moved;  // each field goes where the one before was
  for (const Field& field : kFields) {
    if (!carries(method.integrator, field)) continue;
    std::vector<double>& values = particles.*field.member;
    double empty = 0.0;
    if (field.name == "id") empty = kNobody;
    const double scale = field.unit == "m" ? method.smoothing_length : 0.0;
    resize_closely(moved, next.slots());
    team_.run(next.chunks(), [&](std::size_t chunk) {
      const std::size_t end = kCluster * next.chunk_begin(chunk + 1);
      for (std::size_t s = kCluster * next.chunk_begin(chunk); s < end; ++s) {
        moved[s] =
            order.source[s] != Order::kEmpty ? values[order.source[s]] : empty + scale * nowhere(s);
      }
    });
    values.swap(moved);
  }
  layout = std::move(order.layout);
}

/// Everything that follows from the order: origin cells, pair arrays and lists.
template <typename T>
void Engine<T>::bind() {
  const std::size_t slots = layout.slots();
  bounds.assign_origin_cells(team_, grid_, layout, particles.x_sorted.data(),
                             particles.y_sorted.data(), particles.id.data());
  scales_ = scales();
  pairs_.resize(slots);
  if (keeps_diffused(method)) pairs_.diffused.resize(slots);
  paths_.resize(slots);
  for_chunks([&](const ParticleSpan& p, Motion&) { write_pairs(p); });
  make_lists();
}

/// Pair lists for paths that begin here and now.
template <typename T>
void Engine<T>::make_lists() {
  paths_.age = 0.0;
  bounds.resize(layout);
  for_chunks([&](const ParticleSpan& p, Motion&) {
    paths_.begin(pairs_, p.begin, p.end);
    bounds.assign_boxes(p.begin / kCluster, p.end / kCluster, grid_, method.smoothing_length,
                        paths_.view());
  });
  bounds.assign_rows(team_, layout);
  const PairRange<T> range{static_cast<T>(method.support_ratio() + kListSlack),
                           constants_.origin_cell_size, grid_.has_one_origin_cell()};
  const PairSet<T> fluid{layout, bounds, paths_.view()};
  const PairSet<T> wall = walls_.set();
  const std::array lists{NewPairList<T>{&fluid, &fluid, &fluid_to_fluid_},
                         NewPairList<T>{&fluid, &wall, &fluid_to_wall_},
                         NewPairList<T>{&wall, &fluid, &wall_to_fluid_}};
  build_pair_lists(team_, sweeps_, range, std::span(lists).first(walls_.empty() ? 1 : 3));
  sums_.place(fluid_to_fluid_, layout.chunk,
              method.integrator == Integrator::modified_leap_frog ? kRateSums.stride
              : method.shifting                                   ? kDensityAndShiftingSums.stride
                                                                  : kAccelerationSums.stride);
}

template <typename T>
void Engine<T>::count_neighbours() {
  extremes.max_neighbours =
      most_neighbours(team_, layout, fluid_to_fluid_, sums_, pairs_, method.support_ratio());
}

// Passes.

template <typename T>
void Engine<T>::sweep_chunk(typename Sweeps<T>::Sweep loop, std::size_t chunk) {
  SweepTask<T> task;
  task.self = pairs_.view();
  task.fluid = task.self;
  task.wall = walls_.view();
  task.to_fluid = &fluid_to_fluid_.chunks[chunk];
  task.to_wall = !walls_.empty() ? &fluid_to_wall_.chunks[chunk] : nullptr;
  task.first_cluster = layout.chunk_begin(chunk);
  task.clusters = layout.chunk_begin(chunk + 1) - task.first_cluster;
  task.constants = &constants_;
  task.sums = sums_.of(chunk);
  loop(task);
}

/// Sums over the pairs, and calls body(chunk, rates, seen) for the span of every chunk with what
/// was summed for it. A chunk may be changed as soon as all sweeps that read it are done, for each
/// pair of clusters is in the list of the earlier one's chunk.
template <typename T>
template <class Body>
Motion Engine<T>::sweep(typename Sweeps<T>::Sweep loop, const SumBlocks& blocks, const Body& body,
                        SweepPasses passes) {
  struct Work {
    Motion seen;
    double sums = 0.0;    // s
    double update = 0.0;  // s
  };
  std::vector<Work> work(layout.chunks());
  double passed = 0.0;  // s, once whatever the number of threads
  {
    const PassClock whole(passed);
    team_.run_both(
        work.size(),
        [&](std::size_t chunk) {
          const PassClock clock(work[chunk].sums);
          sweep_chunk(loop, chunk);
        },
        [&](std::size_t chunk) { return sums_.sources(chunk); },
        [&](std::size_t chunk) {
          const PassClock clock(work[chunk].update);
          const ParticleSpan p = span(chunk);
          body(p, gather(p, blocks), work[chunk].seen);
        });
  }
  Work all;
  for (const Work& one : work) {
    all.seen.merge(one.seen);
    all.sums += one.sums;
    all.update += one.update;
  }
  const double worked = all.sums + all.update;
  if (worked > 0.0) {
    seconds_of(passes.sums) += passed * all.sums / worked;
    seconds_of(passes.update) += passed * all.update / worked;
  }
  return all.seen;
}

/// Adds up, in a fixed order, what a sweep left for the particles of a chunk.
template <typename T>
Rates<T> Engine<T>::gather(const ParticleSpan& chunk, const SumBlocks& blocks) {
  const std::size_t n = chunk.begin / (kCluster * layout.chunk);
  sweeps_.updates.gather(sums_.contributions(n), sums_.of_chunks(), blocks.stride, sums_.of(n));
  return rates_of(chunk, blocks);
}

/// What gather() left.
template <typename T>
Rates<T> Engine<T>::rates_of(const ParticleSpan& chunk, const SumBlocks& blocks) const {
  // Times c/h and c^2/h.
  const double scale = scale_of_sums(method) * method.sound_speed / method.smoothing_length;
  return {sums_.of(chunk.begin / (kCluster * layout.chunk)),
          chunk.begin,
          blocks,
          scale * method.reference_density,
          scale * method.sound_speed,
          method.gravity};
}

template <typename T>
void Engine<T>::sum_wall_pressure() {
  if (walls_.empty()) return;
  const PassClock clock(seconds_of(Pass::wall_pressure));
  walls_.sum_pressures(team_, method, sweeps_, constants_, pairs_.view(), wall_to_fluid_);
}

template <typename T>
bool Engine<T>::reinitialisation_due(std::uint64_t step) const {
  return method.reinitialisation && step > 0 &&
         step % static_cast<std::uint64_t>(method.reinitialisation->interval) == 0;
}

template <typename T>
void Engine<T>::reinitialise() {
  sweep(sweeps_.reinitialise, kReinitialisationSums,
        [&](const ParticleSpan& p, const Rates<T>& rates, Motion&) {
          sweeps_.updates.reinitialise(p, rates, method.reference_density);
          sweeps_.updates.write_densities(p, scales_, pairs_);
          if (pairs_.diffused.size() > 0) sweeps_.updates.write_places(p, scales_, pairs_);
        },
        {Pass::reinitialisation, Pass::reinitialisation});
}

template <typename T>
void Engine<T>::note_motion(const Motion& seen) {
  extremes.max_speed = std::sqrt(seen.speed_sq);
  extremes.min_density_excess = particle_count > 0 ? seen.min_density_excess : 0.0;
  extremes.max_density_excess = particle_count > 0 ? seen.max_density_excess : 0.0;
  if (method.integrator == Integrator::kick_drift_kick) {
    extremes.max_acceleration = std::sqrt(seen.acceleration_sq);
  }
  extremes.max_x = seen.max_x;
  leaving_ = seen.leaving;
}

template <typename T>
void Engine<T>::measure() {
  note_motion(for_chunks([&](const ParticleSpan& p, Motion& seen) {
    sweeps_.updates.measure(p, method, seen);
    if (p.ax != nullptr) sweeps_.updates.measure_acceleration(p, seen);
  }));
}

template <typename T>
void Engine<T>::write_pairs(const ParticleSpan& p) {
  sweeps_.updates.write_places(p, scales_, pairs_);
  sweeps_.updates.write_velocities(p, scales_, pairs_);
  sweeps_.updates.write_densities(p, scales_, pairs_);
}

/// eq. 18 with its unit mended, and the force limit: dt <= C h/(c + |v|), dt <= 0.25 sqrt(h/|a|),
/// but for the least step.
template <typename T>
void Engine<T>::choose_time_step() {
  const double h = method.smoothing_length;
  const double sound = method.courant * h / (method.sound_speed + extremes.max_speed);
  const double force = kForceCourant * std::sqrt(h / extremes.max_acceleration);
  step_limit = force < sound ? StepLimit::force : StepLimit::sound;
  time_step = std::max(method.least_time_step(), std::min(force, sound));
}

template <typename T>
bool Engine<T>::shifting_due() const {
  return method.shifting && step_count % ParticleShifting::kInterval == 0;
}

template <typename T>
Shift Engine<T>::shift_of_step() const {
  const double scale = scale_of_sums(method);
  const double duration = static_cast<double>(ParticleShifting::kInterval) * time_step;
  return {method.shifting->coefficient * duration * scale, scale, kMostShift * method.spacing,
          method.reference_density / (method.sound_speed * method.sound_speed) * method.gravity};
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
  if (reinitialisation_due(step_count)) {
    sum_wall_pressure();
    reinitialise();
  }
  sum_wall_pressure();
  const Motion forces = sweep(sweeps_.density_and_acceleration, kRateSums,
                              [&](const ParticleSpan& chunk, const Rates<T>& rates, Motion& seen) {
                                sweeps_.updates.measure_rates(chunk, rates, seen);
                              });
  extremes.max_acceleration = std::sqrt(forces.acceleration_sq);
  const double last = time_step;
  choose_time_step();
  advance_paths(time_step);
  const Motion motion = update_chunks([&](const ParticleSpan& chunk, Motion& seen) {
    const Rates<T> rates = rates_of(chunk, kRateSums);
    for_blocks(chunk, [&](const ParticleSpan& p) {
      sweeps_.updates.leap_frog(p, rates, 0.5 * (last + time_step), time_step);
      sweeps_.updates.measure(p, method, seen);
      write_pairs(p);
      compare_with_paths(p, seen);
    });
  });
  note_motion(motion);
  time += time_step;
  ++step_count;
  walls_.lift(method, time);
  order_due() ? sort() : keep_lists(motion);
}

/// Adami et al. 2012: half kick, half drift, density, half drift, wall pressure, acceleration, half
/// kick.
template <typename T>
void Engine<T>::step_kick_drift_kick() {
  choose_time_step();
  advance_paths(0.5 * time_step);
  keep_lists(update_chunks([&](const ParticleSpan& chunk, Motion& seen) {
    for_blocks(chunk, [&](const ParticleSpan& p) {
      sweeps_.updates.kick_drift(p, time_step);
      sweeps_.updates.write_places(p, scales_, pairs_);
      sweeps_.updates.write_velocities(p, scales_, pairs_);
      compare_with_paths(p, seen);
    });
  }));
  const bool shifting = shifting_due();
  const Shift shift = shifting ? shift_of_step() : Shift{};
  advance_paths(0.5 * time_step);
  keep_lists(sweep(shifting ? sweeps_.density_and_shift : sweeps_.density,
                   shifting ? kDensityAndShiftingSums : kDensitySums,
                   [&](const ParticleSpan& chunk, const Rates<T>& rates, Motion& seen) {
                     for_blocks(chunk, [&](const ParticleSpan& p) {
                       sweeps_.updates.density_drift(p, rates, time_step);
                       if (shifting) sweeps_.updates.shift(p, rates, shift);
                       sweeps_.updates.write_places(p, scales_, pairs_);
                       sweeps_.updates.write_densities(p, scales_, pairs_);
                       compare_with_paths(p, seen);
                     });
                   }));
  sum_wall_pressure();
  if (reinitialisation_due(step_count + 1)) {
    reinitialise();
    sum_wall_pressure();
  }
  note_motion(sweep(sweeps_.acceleration, kAccelerationSums,
                    [&](const ParticleSpan& chunk, const Rates<T>& rates, Motion& seen) {
                      for_blocks(chunk, [&](const ParticleSpan& p) {
                        sweeps_.updates.kick(p, rates, time_step);
                        sweeps_.updates.measure(p, method, seen);
                        sweeps_.updates.measure_acceleration(p, seen);
                      });
                    }));
  time += time_step;
  ++step_count;
  walls_.lift(method, time);
  if (order_due()) sort();
}

// For readers.

template <typename T>
Energy Engine<T>::energy() {
  return for_chunks<Energy>(
      [&](const ParticleSpan& p, Energy& sum) { sweeps_.updates.sum_energy(p, method, sum); });
}

template <typename T>
FluidProbe Engine<T>::probe() const {
  return {method, particles, layout, bounds, sweeps_.updates.sum_around};
}

template <typename T>
std::vector<double> Engine<T>::wall_pressures() const {
  return walls_.pressures(method);
}

template <typename T>
double Engine<T>::pair_slots() const {
  std::size_t entries = 0;
  for (const PairList::Chunk& chunk : fluid_to_fluid_.chunks) entries += chunk.entries.size();
  const auto pairs = static_cast<double>(kCluster * kCluster * entries);
  return pairs / static_cast<double>(std::max<std::size_t>(particle_count, 1));
}

template <typename T>
std::size_t Engine<T>::memory_bytes() const {
  std::size_t bytes = pairs_.bytes() + walls_.bytes() + paths_.bytes() + sums_.bytes() +
                      fluid_to_fluid_.bytes() + fluid_to_wall_.bytes() + wall_to_fluid_.bytes();
  for (const Field& field : kFields) bytes += (particles.*field.member).capacity() * sizeof(double);
  return bytes + bounds.bytes();
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

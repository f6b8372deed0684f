#pragma once

// The engine of one type of pair sums: for the files that its members are defined in. Its order in
// memory is in engine_order-inl.hpp, its sums are in engine_sums-inl.hpp, and each integrator has a
// file.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <vector>

#include "engine/sph/pairs/chunk_sums.hpp"
#include "engine/sph/pairs/list_paths.hpp"
#include "engine/sph/solver/dummy_particles.hpp"
#include "engine/sph/solver/engine.hpp"

namespace sluice {

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

template <typename T, int Dim>
class Engine final : public SolverN<Dim>::Impl {
 public:
  Engine(const MethodN<Dim>& method, const FlowDomainN<Dim>& domain, const SolverStateN<Dim>& state,
         const std::vector<VecN<Dim>>& walls, const Execution& execution);

  void step() override;
  [[nodiscard]] const SolverFacts<Dim>& facts() const override { return facts_; }
  [[nodiscard]] SolverStateN<Dim> state() const override;
  [[nodiscard]] Energy energy() override;
  [[nodiscard]] FluidProbe<Dim> probe() const override;
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body) override {
    team_.run(count, body);
  }
  [[nodiscard]] std::vector<double> wall_pressures() const override;
  [[nodiscard]] double pair_slots() const override;
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  using Span = ParticleSpan<Dim>;
  using Blocks = SumBlocks<Dim>;
  using ChunkRates = Rates<T, Dim>;
  using Sweep = typename Sweeps<T, Dim>::Sweep;

  // Start.
  void load(const SolverStateN<Dim>& state);
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
  void compare_with_paths(const Span& p, Motion& seen);
  void keep_lists(const Motion& seen);
  [[nodiscard]] bool order_due();
  void sum_wall_pressure();
  void reinitialise();
  double& seconds_of(Pass pass) { return facts_.pass_seconds[static_cast<std::size_t>(pass)]; }
  void sweep_chunk(Sweep loop, std::size_t chunk);
  /// Whose time a sweep is, and what is done with its sums.
  struct SweepPasses {
    Pass sums;
    Pass update;
  };
  template <class Body>
  Motion sweep(Sweep loop, const Blocks& blocks, const Body& body,
               SweepPasses passes = {Pass::pair_sums, Pass::update});
  ChunkRates gather(const Span& chunk, const Blocks& blocks);
  [[nodiscard]] ChunkRates rates_of(const Span& chunk, const Blocks& blocks) const;
  void measure();
  void write_pairs(const Span& p);
  void note_motion(const Motion& seen);
  void choose_time_step();
  [[nodiscard]] Shift<Dim> shift_of_step() const;
  [[nodiscard]] bool shifting_due() const;
  [[nodiscard]] bool reinitialisation_due(std::uint64_t step) const;

  // Views.
  [[nodiscard]] Span span(std::size_t chunk);
  [[nodiscard]] PairScales<Dim> scales() const;

  /// Calls body(chunk, seen) for the span of every chunk and merges what each saw, in their order.
  template <class Seen = Motion, class Body>
  Seen for_chunks(const Body& body);
  template <class Body>
  Motion update_chunks(const Body& body);
  /// Calls body(block) for parts of a chunk that stay in the first cache from loop to loop.
  template <class Body>
  static void for_blocks(const Span& chunk, const Body& body);

  MethodN<Dim> method_;
  FlowDomainN<Dim> domain_;
  SolverFacts<Dim> facts_;
  Grid<Dim> grid_;
  Sweeps<T, Dim> sweeps_;
  ThreadTeam team_;
  TermConstants<T, Dim> constants_;

  ParticlesN<Dim> particles_;  // per slot: four to a cluster, empty slots have id kNobody
  Layout layout_;
  ClusterBounds<Dim> bounds_;
  PairArrays<T, Dim> pairs_;
  PairScales<Dim> scales_;
  ListPaths<T, Dim> paths_;
  ListLifetime list_lifetime_;
  PairList fluid_to_fluid_, fluid_to_wall_, wall_to_fluid_;
  ChunkSums<T> sums_;     // of fluid_to_fluid_
  bool leaving_ = false;  // a particle is to be removed

  DummyParticles<T, Dim> walls_;
};

template <typename T, int Dim>
template <class Seen, class Body>
Seen Engine<T, Dim>::for_chunks(const Body& body) {
  std::vector<Seen> seen(layout_.chunks());
  team_.run(seen.size(), [&](std::size_t chunk) { body(span(chunk), seen[chunk]); });
  Seen all;
  for (const Seen& one : seen) all.merge(one);
  return all;
}

template <typename T, int Dim>
template <class Body>
Motion Engine<T, Dim>::update_chunks(const Body& body) {
  const PassClock clock(seconds_of(Pass::update));
  return for_chunks(body);
}

template <typename T, int Dim>
template <class Body>
void Engine<T, Dim>::for_blocks(const Span& chunk, const Body& body) {
  constexpr std::size_t kBlock = 128;
  ParticleSpan<Dim> block = chunk;
  for (; block.begin < chunk.end; block.begin += kBlock) {
    block.end = std::min(block.begin + kBlock, chunk.end);
    body(block);
  }
}

/// Sums over the pairs, and calls body(chunk, rates, seen) for the span of every chunk with what
/// was summed for it. A chunk may be changed as soon as all sweeps that read it are done, for each
/// pair of clusters is in the list of the earlier one's chunk.
template <typename T, int Dim>
template <class Body>
Motion Engine<T, Dim>::sweep(Sweep loop, const Blocks& blocks, const Body& body,
                             SweepPasses passes) {
  struct Work {
    Motion seen;
    double sums = 0.0;    // s
    double update = 0.0;  // s
  };
  std::vector<Work> work(layout_.chunks());
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
          const ParticleSpan<Dim> p = span(chunk);
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

}  // namespace sluice

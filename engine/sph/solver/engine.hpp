#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/solver/neighbours.hpp"
#include "engine/sph/solver/probes.hpp"
#include "engine/sph/solver/solver.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// What Solver hides: the engine for one type of pair sums.
class Solver::Impl {
 public:
  virtual ~Impl() = default;
  virtual void step() = 0;
  [[nodiscard]] virtual Energy energy() = 0;
  [[nodiscard]] virtual FluidProbe probe() const = 0;
  virtual void for_each(std::size_t count, const std::function<void(std::size_t)>& body) = 0;

  Method method;
  FlowDomain domain;
  Execution execution;
  Particles particles;  ///< per slot: four to a cluster, empty slots have id -1
  Layout layout;
  ClusterBounds bounds;
  std::uint64_t step_count = 0;
  double time = 0.0;
  double time_step = 0.0;
  StepLimit step_limit = StepLimit::sound;
  std::vector<RemovedParticle> removed;
  Extremes extremes;
  std::size_t particle_count = 0;
  std::size_t wall_count = 0;
  std::string_view simd_target;
  std::array<double, kPassCount> pass_seconds{};
  std::uint64_t sort_count = 0;

  [[nodiscard]] virtual std::vector<double> wall_pressures() const = 0;
  [[nodiscard]] virtual double pair_slots() const = 0;
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

/// Method and state to an engine whose pair sums run in T.
template <typename T>
[[nodiscard]] std::unique_ptr<Solver::Impl> make_engine(const Method& method,
                                                        const FlowDomain& domain,
                                                        const SolverState& state,
                                                        const std::vector<Vec>& walls,
                                                        const Execution& execution);

}  // namespace sluice

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "engine/sph/solver/probes.hpp"
#include "engine/sph/solver/solver.hpp"

namespace sluice {

/// What a solver knows without a look at its particles.
template <int Dim>
struct SolverFacts {
  std::uint64_t step_count = 0;
  double time = 0.0;       ///< s
  double time_step = 0.0;  ///< s
  StepLimit step_limit = StepLimit::sound;
  std::vector<RemovedParticleN<Dim>> removed;
  Extremes extremes;
  std::size_t particle_count = 0;
  std::size_t wall_count = 0;
  double spacing = 0.0;  ///< m
  int threads = 0;
  std::string_view simd_target;
  std::array<double, kPassCount> pass_seconds{};
  std::uint64_t sort_count = 0;
};

/// What Solver hides: an engine for one type of pair sums.
template <int Dim>
class SolverN<Dim>::Impl {
 public:
  virtual ~Impl() = default;
  virtual void step() = 0;
  [[nodiscard]] virtual const SolverFacts<Dim>& facts() const = 0;
  [[nodiscard]] virtual SolverStateN<Dim> state() const = 0;
  [[nodiscard]] virtual Energy energy() = 0;
  [[nodiscard]] virtual FluidProbe<Dim> probe() const = 0;
  virtual void for_each(std::size_t count, const std::function<void(std::size_t)>& body) = 0;
  [[nodiscard]] virtual std::vector<double> wall_pressures() const = 0;
  [[nodiscard]] virtual double pair_slots() const = 0;
  [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

/// Method and state to an engine whose pair sums run in T.
template <typename T, int Dim>
[[nodiscard]] std::unique_ptr<typename SolverN<Dim>::Impl> make_engine(
    const MethodN<Dim>& method, const FlowDomainN<Dim>& domain, const SolverStateN<Dim>& state,
    const std::vector<VecN<Dim>>& walls, const Execution& execution);

}  // namespace sluice

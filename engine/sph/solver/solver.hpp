#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/sph/method/flow_domain.hpp"
#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"

namespace sluice {

/// What limited the length of a step.
enum class StepLimit { sound, force };
[[nodiscard]] std::string_view to_string(StepLimit limit);

/// The passes of a step, for the account of time.
enum class Pass { sort, wall_pressure, pair_sums, reinitialisation, update, sample };
inline constexpr std::size_t kPassCount = 6;
[[nodiscard]] std::string_view to_string(Pass pass);

/// How the solver uses the machine. Nothing here changes a result but `simd_target`, and that only
/// in rounding.
struct Execution {
  int threads = 1;
  std::string simd_target;  ///< "" best of this machine, else "SSE4", "AVX2" or "AVX3"
};

/// Extremes over all particles at the last step; zero without particles. With the leap-frog the
/// largest acceleration is known from the first step of a Solver on.
struct Extremes {
  double max_speed = 0.0;            ///< m/s
  double max_acceleration = 0.0;     ///< m/s^2
  double min_density_excess = 0.0;   ///< kg/m^3
  double max_density_excess = 0.0;   ///< kg/m^3
  double max_x = 0.0;                ///< m
  std::uint32_t max_neighbours = 0;  ///< of one particle, counted at a sort
                                     ///< that finds lists long enough for more than 200, else 0
};

/// A value estimated from the fluid around a point, with the kernel sum that carried it.
struct Probe {
  double value = 0.0;
  double weight =
      0.0;  ///< sum of W V over the fluid, dimensionless: about 1 inside, 0: dry and no value
};

/// The WCSPH solver: particles, walls and the passes of a step, chosen once for the terms of
/// `Method`. Results depend on `Method`, `FlowDomain`, the initial state and the SIMD target only;
/// any number of threads gives the same bits.
template <int Dim>
class SolverN {
 public:
  /// Starts from particles at rest in time (`state.step == 0`, only x, y, vx, vy, density_excess
  /// and id filled) or goes on from a state taken by `state()`. `walls` are the positions of the
  /// dummy particles, m.
  SolverN(const MethodN<Dim>& method, const FlowDomainN<Dim>& domain,
          const SolverStateN<Dim>& state, const std::vector<VecN<Dim>>& walls,
          const Execution& execution);
  ~SolverN();
  SolverN(SolverN&&) noexcept;
  SolverN& operator=(SolverN&&) noexcept;

  /// One time step.
  void step();

  [[nodiscard]] std::uint64_t step_count() const;
  [[nodiscard]] double time() const;           ///< s
  [[nodiscard]] double time_step() const;      ///< length of the last step, s
  [[nodiscard]] StepLimit step_limit() const;  ///< what limited it
  [[nodiscard]] std::size_t particle_count() const;
  [[nodiscard]] std::size_t wall_count() const;
  [[nodiscard]] const std::vector<RemovedParticleN<Dim>>& removed() const;
  [[nodiscard]] const Extremes& extremes() const;
  [[nodiscard]] std::string_view simd_target() const;
  [[nodiscard]] int threads() const;

  /// A copy of the state, particles in their order.
  [[nodiscard]] SolverStateN<Dim> state() const;

  /// Calls body(i) for each i in [0, count) on the solver's threads, for sensors: `body` may ask
  /// for anything of the point probes below. It must not throw, for an exception ends the process,
  /// nor ask for the energy, which takes the threads itself.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body) const;

  /// Energy now. Summed in the order of particles in memory.
  [[nodiscard]] Energy energy() const;
  /// eq. 11 with smoothing length `h`, Pa.
  [[nodiscard]] Probe pressure_at(const VecN<Dim>& point, double h) const;
  /// Highest point straight above or below `place` where the fluid fills at least half of the
  /// kernel, m; weight 0 when there is none.
  [[nodiscard]] Probe surface_height_at(const VecN<Dim>& place) const;
  /// Largest x of any fluid particle plus half a spacing, m; weight 0 without particles.
  [[nodiscard]] Probe surge_front() const;
  /// Distance of the nearest fluid particle to `point`, m; infinity when there is none within the
  /// support.
  [[nodiscard]] double distance_to_fluid(const VecN<Dim>& point) const;
  /// Pressures of the dummy particles, Pa, in the order of `walls`, as the last step summed them;
  /// zero before the first step of this object.
  [[nodiscard]] std::vector<double> wall_pressures() const;

  /// Seconds of wall time spent in each pass since construction.
  [[nodiscard]] const std::array<double, kPassCount>& pass_seconds() const;
  [[nodiscard]] std::uint64_t sort_count() const;
  /// Vector lanes that a pair sum over the fluid spends per particle; about 28 of them hold a
  /// neighbour (Gaussian).
  [[nodiscard]] double pair_slots() const;
  [[nodiscard]] std::size_t memory_bytes() const;

  class Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// A solver of as many dimensions as the method has, for those who run scenes. All that SolverN
/// says holds. Throws std::invalid_argument when domain, state or walls have another number.
class Solver {
 public:
  Solver(const Method& method, const FlowDomain& domain, const SolverState& state,
         const std::vector<Vec>& walls, const Execution& execution);

  void step();

  [[nodiscard]] int dimensions() const;
  [[nodiscard]] std::uint64_t step_count() const;
  [[nodiscard]] double time() const;           ///< s
  [[nodiscard]] double time_step() const;      ///< length of the last step, s
  [[nodiscard]] StepLimit step_limit() const;  ///< what limited it
  [[nodiscard]] std::size_t particle_count() const;
  [[nodiscard]] std::size_t wall_count() const;
  [[nodiscard]] std::size_t removed_count() const;
  [[nodiscard]] RemovedParticle removed(std::size_t i) const;
  [[nodiscard]] const Extremes& extremes() const;
  [[nodiscard]] std::string_view simd_target() const;
  [[nodiscard]] int threads() const;
  [[nodiscard]] SolverState state() const;
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body) const;
  [[nodiscard]] Energy energy() const;
  [[nodiscard]] Probe pressure_at(const Vec& point, double h) const;
  [[nodiscard]] Probe surface_height_at(const Vec& place) const;
  [[nodiscard]] Probe surge_front() const;
  [[nodiscard]] double distance_to_fluid(const Vec& point) const;
  [[nodiscard]] std::vector<double> wall_pressures() const;
  [[nodiscard]] const std::array<double, kPassCount>& pass_seconds() const;
  [[nodiscard]] std::uint64_t sort_count() const;
  [[nodiscard]] double pair_slots() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::variant<SolverN<2>, SolverN<3>> solver_;
};

}  // namespace sluice

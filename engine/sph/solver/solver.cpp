#include "engine/sph/solver/solver.hpp"

#include <algorithm>

#include "engine/sph/solver/engine.hpp"

namespace sluice {

std::string_view to_string(StepLimit limit) {
  return limit == StepLimit::sound ? "sound" : "force";
}

std::string_view to_string(Pass pass) {
  constexpr std::array<std::string_view, kPassCount> names{
      "sort", "wall_pressure", "pair_sums", "reinitialisation", "update", "sample"};
  return names[static_cast<std::size_t>(pass)];
}

Solver::Solver(const Method& method, const FlowDomain& domain, const SolverState& state,
               const std::vector<Vec>& walls, const Execution& execution)
    : impl_(method.precision == Precision::mixed
                ? make_engine<float, kDim>(method, domain, state, walls, execution)
                : make_engine<double, kDim>(method, domain, state, walls, execution)) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

void Solver::step() { impl_->step(); }

std::uint64_t Solver::step_count() const { return impl_->facts().step_count; }
double Solver::time() const { return impl_->facts().time; }
double Solver::time_step() const { return impl_->facts().time_step; }
StepLimit Solver::step_limit() const { return impl_->facts().step_limit; }
std::size_t Solver::particle_count() const { return impl_->facts().particle_count; }
std::size_t Solver::wall_count() const { return impl_->facts().wall_count; }
const std::vector<RemovedParticle>& Solver::removed() const { return impl_->facts().removed; }
const Extremes& Solver::extremes() const { return impl_->facts().extremes; }
std::string_view Solver::simd_target() const { return impl_->facts().simd_target; }
int Solver::threads() const { return impl_->facts().threads; }
const std::array<double, kPassCount>& Solver::pass_seconds() const {
  return impl_->facts().pass_seconds;
}
std::uint64_t Solver::sort_count() const { return impl_->facts().sort_count; }
double Solver::pair_slots() const { return impl_->pair_slots(); }
std::size_t Solver::memory_bytes() const { return impl_->memory_bytes(); }
std::vector<double> Solver::wall_pressures() const { return impl_->wall_pressures(); }

SolverState Solver::state() const { return impl_->state(); }
Energy Solver::energy() const { return impl_->energy(); }

void Solver::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
  impl_->for_each(count, body);
}

Probe Solver::pressure_at(const Vec& point, double h) const {
  return impl_->probe().pressure(point, h);
}

Probe Solver::surface_height_at(const Vec& place) const {
  return impl_->probe().surface_height(place);
}

Probe Solver::surge_front() const {
  const SolverFacts& facts = impl_->facts();
  if (facts.particle_count == 0) return {};
  return {facts.extremes.max_x + 0.5 * facts.spacing, 1.0};
}

double Solver::distance_to_fluid(const Vec& point) const { return impl_->probe().distance(point); }

}  // namespace sluice

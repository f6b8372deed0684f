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
                ? make_engine<float>(method, domain, state, walls, execution)
                : make_engine<double>(method, domain, state, walls, execution)) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

void Solver::step() { impl_->step(); }

std::uint64_t Solver::step_count() const { return impl_->step_count; }
double Solver::time() const { return impl_->time; }
double Solver::time_step() const { return impl_->time_step; }
StepLimit Solver::step_limit() const { return impl_->step_limit; }
std::size_t Solver::particle_count() const { return impl_->particle_count; }
std::size_t Solver::wall_count() const { return impl_->wall_count; }
const std::vector<RemovedParticle>& Solver::removed() const { return impl_->removed; }
const Extremes& Solver::extremes() const { return impl_->extremes; }
std::string_view Solver::simd_target() const { return impl_->simd_target; }
int Solver::threads() const { return impl_->execution.threads; }
const std::array<double, kPassCount>& Solver::pass_seconds() const { return impl_->pass_seconds; }
std::uint64_t Solver::sort_count() const { return impl_->sort_count; }
double Solver::pair_slots() const { return impl_->pair_slots(); }
std::size_t Solver::memory_bytes() const { return impl_->memory_bytes(); }
std::vector<double> Solver::wall_pressures() const { return impl_->wall_pressures(); }

SolverState Solver::state() const {
  SolverState out;
  out.step = impl_->step_count;
  out.time = impl_->time;
  out.time_step = impl_->time_step;
  out.removed = impl_->removed;
  for (const Field& field : kFields) {
    if (!carries(impl_->method.integrator, field)) continue;
    const std::vector<double>& from = field.values.of(impl_->particles);
    std::vector<double>& to = field.values.of(out.particles);
    to.reserve(impl_->particle_count);
    for (std::size_t s = 0; s < from.size(); ++s) {
      if (impl_->particles.id[s] >= 0.0) to.push_back(from[s]);
    }
  }
  return out;
}

Energy Solver::energy() const { return impl_->energy(); }

void Solver::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
  impl_->for_each(count, body);
}

Probe Solver::pressure_at(const Vec& point, double h) const {
  return impl_->probe().pressure(point, h);
}

Probe Solver::surface_height_at(const Vec& place) const {
  return impl_->probe().surface_height(place.x());
}

Probe Solver::surge_front() const {
  if (impl_->particle_count == 0) return {};
  return {impl_->extremes.max_x + 0.5 * impl_->method.spacing, 1.0};
}

double Solver::distance_to_fluid(const Vec& point) const { return impl_->probe().distance(point); }

}  // namespace sluice

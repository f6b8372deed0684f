#pragma once

#include "engine/sph/solver/engine.hpp"
#include "engine/sph/solver/solver.hpp"

namespace sluice {

template <int Dim>
SolverN<Dim>::SolverN(const MethodN<Dim>& method, const FlowDomainN<Dim>& domain,
                      const SolverStateN<Dim>& state, const std::vector<VecN<Dim>>& walls,
                      const Execution& execution)
    : impl_(method.precision == Precision::mixed
                ? make_engine<float, Dim>(method, domain, state, walls, execution)
                : make_engine<double, Dim>(method, domain, state, walls, execution)) {}
template <int Dim>
SolverN<Dim>::~SolverN() = default;
template <int Dim>
SolverN<Dim>::SolverN(SolverN&&) noexcept = default;
template <int Dim>
SolverN<Dim>& SolverN<Dim>::operator=(SolverN&&) noexcept = default;

template <int Dim>
void SolverN<Dim>::step() {
  impl_->step();
}

template <int Dim>
std::uint64_t SolverN<Dim>::step_count() const {
  return impl_->facts().step_count;
}
template <int Dim>
double SolverN<Dim>::time() const {
  return impl_->facts().time;
}
template <int Dim>
double SolverN<Dim>::time_step() const {
  return impl_->facts().time_step;
}
template <int Dim>
StepLimit SolverN<Dim>::step_limit() const {
  return impl_->facts().step_limit;
}
template <int Dim>
std::size_t SolverN<Dim>::particle_count() const {
  return impl_->facts().particle_count;
}
template <int Dim>
std::size_t SolverN<Dim>::wall_count() const {
  return impl_->facts().wall_count;
}
template <int Dim>
const std::vector<RemovedParticleN<Dim>>& SolverN<Dim>::removed() const {
  return impl_->facts().removed;
}
template <int Dim>
const Extremes& SolverN<Dim>::extremes() const {
  return impl_->facts().extremes;
}
template <int Dim>
std::string_view SolverN<Dim>::simd_target() const {
  return impl_->facts().simd_target;
}
template <int Dim>
int SolverN<Dim>::threads() const {
  return impl_->facts().threads;
}
template <int Dim>
const std::array<double, kPassCount>& SolverN<Dim>::pass_seconds() const {
  return impl_->facts().pass_seconds;
}
template <int Dim>
std::uint64_t SolverN<Dim>::sort_count() const {
  return impl_->facts().sort_count;
}
template <int Dim>
double SolverN<Dim>::pair_slots() const {
  return impl_->pair_slots();
}
template <int Dim>
std::size_t SolverN<Dim>::memory_bytes() const {
  return impl_->memory_bytes();
}
template <int Dim>
std::vector<double> SolverN<Dim>::wall_pressures() const {
  return impl_->wall_pressures();
}

template <int Dim>
SolverStateN<Dim> SolverN<Dim>::state() const {
  return impl_->state();
}
template <int Dim>
Energy SolverN<Dim>::energy() const {
  return impl_->energy();
}

template <int Dim>
void SolverN<Dim>::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
  impl_->for_each(count, body);
}

template <int Dim>
Probe SolverN<Dim>::pressure_at(const VecN<Dim>& point, double h) const {
  return impl_->probe().pressure(point, h);
}

template <int Dim>
Probe SolverN<Dim>::surface_height_at(const VecN<Dim>& place) const {
  return impl_->probe().surface_height(place);
}

template <int Dim>
Probe SolverN<Dim>::surge_front() const {
  const SolverFacts<Dim>& facts = impl_->facts();
  if (facts.particle_count == 0) return {};
  return {facts.extremes.max_x + 0.5 * facts.spacing, 1.0};
}

template <int Dim>
double SolverN<Dim>::distance_to_fluid(const VecN<Dim>& point) const {
  return impl_->probe().distance(point);
}

}  // namespace sluice

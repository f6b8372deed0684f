#include "engine/sph/solver/solver.hpp"

#include <utility>

namespace sluice {
namespace {

void require(bool alike) {
  if (!alike) {
    throw std::invalid_argument("method, domain, particles and walls differ in their dimensions");
  }
}

template <int Dim>
SolverN<Dim> make_solver(const Method& method, const FlowDomain& domain, const SolverState& state,
                         const std::vector<Vec>& walls, const Execution& execution) {
  require(dimensions_of(domain.box) == Dim && state.particles.position.size() == Dim);
  std::vector<VecN<Dim>> places;
  places.reserve(walls.size());
  for (const Vec& wall : walls) {
    require(dimensions_of(wall) == Dim);
    places.emplace_back(wall);
  }
  return {method_as<Dim>(method), domain_as<Dim>(domain), state_as<Dim>(state), places, execution};
}

}  // namespace

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
    : solver_([&]() -> std::variant<SolverN<2>, SolverN<3>> {
        if (method.dimensions() == 3)
          return make_solver<3>(method, domain, state, walls, execution);
        return make_solver<2>(method, domain, state, walls, execution);
      }()) {}

void Solver::step() {
  std::visit([](auto& solver) { solver.step(); }, solver_);
}
int Solver::dimensions() const { return static_cast<int>(solver_.index()) + 2; }
std::uint64_t Solver::step_count() const {
  return std::visit([](const auto& solver) { return solver.step_count(); }, solver_);
}
double Solver::time() const {
  return std::visit([](const auto& solver) { return solver.time(); }, solver_);
}
double Solver::time_step() const {
  return std::visit([](const auto& solver) { return solver.time_step(); }, solver_);
}
StepLimit Solver::step_limit() const {
  return std::visit([](const auto& solver) { return solver.step_limit(); }, solver_);
}
std::size_t Solver::particle_count() const {
  return std::visit([](const auto& solver) { return solver.particle_count(); }, solver_);
}
std::size_t Solver::wall_count() const {
  return std::visit([](const auto& solver) { return solver.wall_count(); }, solver_);
}
std::size_t Solver::removed_count() const {
  return std::visit([](const auto& solver) { return solver.removed().size(); }, solver_);
}
RemovedParticle Solver::removed(std::size_t i) const {
  return std::visit([i](const auto& solver) { return removed_as<kAnyDim>(solver.removed()[i]); },
                    solver_);
}
const Extremes& Solver::extremes() const {
  return std::visit([](const auto& solver) -> const Extremes& { return solver.extremes(); },
                    solver_);
}
std::string_view Solver::simd_target() const {
  return std::visit([](const auto& solver) { return solver.simd_target(); }, solver_);
}
int Solver::threads() const {
  return std::visit([](const auto& solver) { return solver.threads(); }, solver_);
}
SolverState Solver::state() const {
  return std::visit([](const auto& solver) { return state_as<kAnyDim>(solver.state()); }, solver_);
}
void Solver::for_each(std::size_t count, const std::function<void(std::size_t)>& body) const {
  std::visit([&](const auto& solver) { solver.for_each(count, body); }, solver_);
}
Energy Solver::energy() const {
  return std::visit([](const auto& solver) { return solver.energy(); }, solver_);
}
Probe Solver::pressure_at(const Vec& point, double h) const {
  return std::visit([&](const auto& solver) { return solver.pressure_at(point, h); }, solver_);
}
Probe Solver::surface_height_at(const Vec& place) const {
  return std::visit([&](const auto& solver) { return solver.surface_height_at(place); }, solver_);
}
Probe Solver::surge_front() const {
  return std::visit([](const auto& solver) { return solver.surge_front(); }, solver_);
}
double Solver::distance_to_fluid(const Vec& point) const {
  return std::visit([&](const auto& solver) { return solver.distance_to_fluid(point); }, solver_);
}
std::vector<double> Solver::wall_pressures() const {
  return std::visit([](const auto& solver) { return solver.wall_pressures(); }, solver_);
}
const std::array<double, kPassCount>& Solver::pass_seconds() const {
  return std::visit(
      [](const auto& solver) -> const auto& { return solver.pass_seconds(); }, solver_);
}
std::uint64_t Solver::sort_count() const {
  return std::visit([](const auto& solver) { return solver.sort_count(); }, solver_);
}
double Solver::pair_slots() const {
  return std::visit([](const auto& solver) { return solver.pair_slots(); }, solver_);
}
std::size_t Solver::memory_bytes() const {
  return std::visit([](const auto& solver) { return solver.memory_bytes(); }, solver_);
}

}  // namespace sluice

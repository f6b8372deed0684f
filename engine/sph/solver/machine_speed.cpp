#include "engine/sph/solver/machine_speed.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <mutex>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/space/lattice.hpp"
#include "engine/sph/solver/solver.hpp"

namespace sluice {
namespace {

// Large enough that what a step costs beside its particles is a small part, as it is in a run.
/// Particles along each axis, of about as many in all.
template <int Dim>
constexpr std::array<int, Dim> kSize{};
template <>
constexpr std::array<int, 2> kSize<2>{96, 32};
template <>
constexpr std::array<int, 3> kSize<3>{20, 16, 16};
constexpr int kLayers = 3;
constexpr int kParts = 3;  // the fastest counts: the others were disturbed
constexpr double kPartSeconds = 0.008;
/// What a run in motion takes beside steps of particles at rest: sorts, longer lists, samples. In
/// space 1.8 in dambreak-3d, 2.5 in SPHERIC test 2 at 40, 30 and 20 mm.
template <int Dim>
constexpr double kMotion = Dim == 2 ? 1.3 : 2.1;
constexpr std::size_t kKept = 32;

double processor_seconds() {
  std::timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The choices that the cost of a step depends on: of a term, whether it is there, its form, and
/// its words and intervals, but not its strength.
std::vector<double> cost_of(const Method& m) {
  std::vector<double> cost{static_cast<double>(m.dimensions()), static_cast<double>(m.kernel),
                           static_cast<double>(m.integrator), static_cast<double>(m.precision),
                           m.smoothing_length / m.spacing};
  for_each_term(AllTerms{}, [&]<class Term>() {
    const auto& term = m.term<Term>();
    const auto add = [&](const auto& parameter) {
      using Value = std::remove_cvref_t<decltype((*term).*parameter.member)>;
      if constexpr (!std::is_same_v<Value, double>) {
        cost.push_back(term ? static_cast<double>((*term).*parameter.member) : 0.0);
      }
    };
    cost.push_back(term ? 1.0 + form_of(*term) : 0.0);
    std::apply([&](const auto&... each) { (add(each), ...); }, Term::kParameters);
  });
  return cost;
}

/// The same scheme for particles one unit apart, at rest without gravity.
template <int Dim>
MethodN<Dim> unit_method(const Method& wanted) {
  MethodN<Dim> m = method_as<Dim>(wanted);
  m.smoothing_length = wanted.smoothing_length / wanted.spacing;
  m.spacing = m.sound_speed = m.reference_density = 1.0;
  m.gravity.setZero();
  if (m.laminar_viscosity) m.laminar_viscosity->nu = 1e-3;
  return m;
}

template <int Dim>
SolverN<Dim> small_tank(const MethodN<Dim>& method, std::string_view simd) {
  SolverStateN<Dim> state;
  std::vector<VecN<Dim>> walls;
  ParticlesN<Dim>& p = state.particles;
  FlowDomainN<Dim> domain;
  domain.box = {filled_vec<Dim>(-2.0 * kLayers), filled_vec<Dim>(2.0 * kLayers)};
  CellN<Dim> last{};
  for (int axis = 0; axis < Dim; ++axis) {
    const int size = kSize<Dim>[static_cast<std::size_t>(axis)];
    domain.box.max[axis] += size;
    last[static_cast<std::size_t>(axis)] = axis == kUpAxis ? size - 1 : size + kLayers - 1;
  }
  for_each_cell<Dim>(shifted<Dim>({}, -kLayers), last, [&](const CellN<Dim>& cell) {
    const VecN<Dim> place = as_vector<Dim>(cell).array() + 0.5;
    bool inside = true;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      inside = inside && cell[axis] >= 0 && cell[axis] < kSize<Dim>[axis];
    }
    if (!inside) {
      walls.push_back(place);
      return;
    }
    p.id.push_back(static_cast<double>(p.size()));
    append(p.position, place);
    append(p.velocity, filled_vec<Dim>(0.0));
    p.density_excess.push_back(0.0);
  });
  return {method, domain, state, walls, {1, std::string(simd)}};
}

template <int Dim>
double measure(const Method& method, std::string_view simd) {
  SolverN<Dim> solver = small_tank(unit_method<Dim>(method), simd);
  solver.step();  // sorts and allocates
  double best = 0.0;
  for (int part = 0; part < kParts; ++part) {
    const double start = processor_seconds();
    double steps = 0.0;
    double seconds = 0.0;
    while (seconds < kPartSeconds) {
      solver.step();
      ++steps;
      seconds = processor_seconds() - start;
    }
    best = std::max(best, steps * static_cast<double>(solver.particle_count()) / seconds);
  }
  return best / kMotion<Dim>;
}

}  // namespace

double particle_steps_per_core_second(const Method& method, std::string_view simd) {
  using Known = std::pair<std::pair<std::vector<double>, std::string>, double>;
  static std::mutex mutex;
  static std::vector<Known> known;
  const std::pair cost{cost_of(method), std::string(simd)};
  const std::scoped_lock lock(mutex);
  const auto found = std::ranges::find(known, cost, &Known::first);
  if (found != known.end()) return found->second;
  const double speed =
      in_dimensions(method.dimensions(), [&]<int Dim>() { return measure<Dim>(method, simd); });
  if (known.size() == kKept) known.clear();
  known.emplace_back(cost, speed);
  return speed;
}

}  // namespace sluice

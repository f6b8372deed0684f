#include "engine/scene/model/scheme.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sluice {
namespace {

// The paper's, for modified_leap_frog: the limit for particles at rest is 0.6.
constexpr double kPaperCourant = 0.25;

Method recommended_method() {
  Method m;
  m.kernel = KernelKind::wendland_c2;
  m.integrator = Integrator::kick_drift_kick;
  m.courant = 1.0;
  m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.1};
  m.viscosity = ArtificialViscosity{.alpha = 0.02, .epsilon = 0.01, .beta = 0.5};
  m.wall_shear = WallShear{0.01};
  m.wall_pressure = WallPressure::clamped;
  m.shifting = ParticleShifting{2.0};
  return m;
}

Method paper_method() {
  Method m;
  m.kernel = KernelKind::truncated_gaussian;
  m.integrator = Integrator::modified_leap_frog;
  m.courant = kPaperCourant;
  m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.1};
  m.viscosity = ArtificialViscosity{.alpha = 0.02, .epsilon = 0.01, .beta = 0.0};
  m.wall_pressure = WallPressure::extrapolated;
  m.reinitialisation = Reinitialisation{20};
  return m;
}

template <class Term>
bool is_named(const NumericsSource& source) {
  return source.names(fmt::format("/{}", Term::kText.key));
}

/// Whether the scene itself has a term that holds the fluid at walls.
bool is_held_at_walls(const Method& method, const NumericsSource& source) {
  bool found = false;
  for_each_term(RateTerms{}, [&]<class Term>() {
    found |= Term::kSummation.holds_at_walls && method.term<Term>() && is_named<Term>(source);
  });
  return found;
}

}  // namespace

Method method_of(std::optional<Scheme> scheme) {
  if (!scheme) return {};
  switch (*scheme) {
    case Scheme::recommended:
      return recommended_method();
    case Scheme::paper:
      return paper_method();
  }
  return {};
}

bool NumericsSource::names(std::string_view pointer) const {
  return std::any_of(named.begin(), named.end(), [&](std::string_view each) {
    return each.starts_with(pointer) &&
           (each.size() == pointer.size() || each[pointer.size()] == '/');
  });
}

void leave_out_excluded(Method& method, const NumericsSource& source) {
  if (!source.scheme) return;
  const bool leap_frog = method.integrator == Integrator::modified_leap_frog;
  if (leap_frog && !source.names("/particle_shifting")) method.shifting.reset();
  if (leap_frog && !source.names("/courant")) method.courant = kPaperCourant;
  for_each_term(RateTerms{}, [&]<class Term>() {
    if (is_named<Term>(source) || !Term::kSummation.holds_at_walls) return;
    if (is_held_at_walls(method, source)) method.term<Term>().reset();
  });
}

}  // namespace sluice

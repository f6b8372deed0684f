// The predicted limits of the Courant number against noise in blocks of particles.

#include <fmt/format.h>

#include <array>

#include "engine/sph/stability/von_neumann.hpp"
#include "engine/verify/stability_case.hpp"
#include "engine/verify/stability_map.hpp"

namespace sluice {
namespace {

/// A method with unit scales, as the analysis sees it.
template <int Dim>
Method bare_method(Integrator integrator, KernelKind kernel, double smoothing_ratio) {
  Method m;
  m.gravity = filled_vec<kAnyDim>(0.0, Dim);
  m.spacing = m.reference_density = m.sound_speed = 1.0;
  m.smoothing_length = smoothing_ratio;
  m.kernel = kernel;
  m.integrator = integrator;
  m.precision = Precision::double_precision;
  return m;
}

template <int Dim>
double predicted_limit(const Method& m) {
  return LatticeStabilityN<Dim>(method_as<Dim>(m), Surface::free).courant_limit();
}

/// Of the verdicts 3 % below and above the predicted limit, how many differ from it.
template <int Dim>
int wrong_verdicts(Method m) {
  const double limit = predicted_limit<Dim>(m);
  int wrong = 0;
  for (const double side : {0.97, 1.03}) {
    m.courant = side * limit;
    wrong += measure_noise(m, 2500).grows == (side > 1.0) ? 0 : 1;
  }
  return wrong;
}

CaseResult limits(CaseRunner&) {
  int wrong = 0;
  for (const Integrator integrator :
       {Integrator::modified_leap_frog, Integrator::kick_drift_kick}) {
    for (const double alpha : {0.02, 0.5}) {
      for (const double delta : {0.1, 0.5}) {
        Method m = bare_method<2>(integrator, KernelKind::truncated_gaussian, 1.0);
        m.viscosity = ArtificialViscosity{alpha, 0.01};
        m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, delta};
        wrong += wrong_verdicts<2>(m);
      }
    }
  }
  CaseResult result;
  result.figures.push_back({"verdicts of 16 that differ", static_cast<double>(wrong), 0});
  return result;
}

CaseResult limits_in_space(CaseRunner&) {
  int wrong = 0;
  for (const double alpha : {0.02, 0.5}) {
    Method m = bare_method<3>(Integrator::kick_drift_kick, KernelKind::wendland_c2, 1.5);
    m.viscosity = ArtificialViscosity{alpha, 0.01};
    m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.1};
    wrong += wrong_verdicts<3>(m);
  }
  CaseResult result;
  result.figures.push_back({"verdicts of 4 that differ", static_cast<double>(wrong), 0});
  return result;
}

/// Largest Courant number over its predicted limit at which noise does not grow among particles
/// displaced by up to half their distance, to 2 %.
template <int Dim>
double share_in_disorder(Method m) {
  m.viscosity = ArtificialViscosity{};
  m.diffusion = DensityDiffusion{};
  const double limit = predicted_limit<Dim>(m);
  double stable = 0.1;
  double grows = 1.1;
  while (grows - stable > 0.02) {
    const double middle = 0.5 * (stable + grows);
    m.courant = middle * limit;
    (measure_noise(m, 1500, 0.5).grows ? grows : stable) = middle;
  }
  return stable;
}

Figure lost_in_disorder(std::string_view name, double share) {
  return {fmt::format("{} lost", name), 1.0 - share, 0.4};
}

/// Particles out of order have neighbours nearer than a lattice has, and so faster waves.
CaseResult limits_in_disorder(CaseRunner&) {
  using enum KernelKind;
  using enum Integrator;
  struct Choice {
    std::string_view name;
    KernelKind kernel;
    double ratio;  ///< h/dx
    Integrator integrator;
  };
  CaseResult result;
  for (const Choice& choice : {Choice{"wendland 1.2", wendland_c2, 1.2, kick_drift_kick},
                               Choice{"wendland 1.5", wendland_c2, 1.5, kick_drift_kick},
                               Choice{"gauss", truncated_gaussian, 1.0, kick_drift_kick},
                               Choice{"leap-frog", truncated_gaussian, 1.0, modified_leap_frog}}) {
    const Method m = bare_method<2>(choice.integrator, choice.kernel, choice.ratio);
    result.figures.push_back(lost_in_disorder(choice.name, share_in_disorder<2>(m)));
  }
  return result;
}

CaseResult limits_in_disorder_in_space(CaseRunner&) {
  const Method m = bare_method<3>(Integrator::kick_drift_kick, KernelKind::wendland_c2, 1.5);
  CaseResult result;
  result.figures.push_back(lost_in_disorder("wendland 1.5", share_in_disorder<3>(m)));
  return result;
}

constexpr std::string_view kDisordered =
    "the limits with particles displaced by half their distance";
constexpr std::array kLimitCases{
    StabilityCase{"limits", "C at both sides of the predicted limits", "verdict as predicted",
                  limits},
    StabilityCase{"limits-3d", "the same in space", "verdict as predicted", limits_in_space},
    StabilityCase{"limits-in-disorder", kDisordered, "at most 40 % lost", limits_in_disorder},
    StabilityCase{"limits-in-disorder-3d", "the same in space", "at most 40 % lost",
                  limits_in_disorder_in_space},
};

}  // namespace

std::span<const StabilityCase> limit_cases() { return kLimitCases; }

}  // namespace sluice

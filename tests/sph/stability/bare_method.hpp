#pragma once

#include "engine/sph/method/method.hpp"

namespace sluice {

/// Pressure and density alone, with the truncated Gaussian and h = dx = 0.1 m; c = 20 m/s.
template <int Dim>
[[nodiscard]] MethodN<Dim> bare_method(Integrator integrator) {
  MethodN<Dim> m;
  m.spacing = 0.1;
  m.smoothing_length = 0.1;
  m.reference_density = 1000.0;
  m.sound_speed = 20.0;
  m.kernel = KernelKind::truncated_gaussian;
  m.integrator = integrator;
  return m;
}

/// What a wave is damped by in the schemes that scenes name.
template <int Dim>
[[nodiscard]] MethodN<Dim> damped_method(Integrator integrator) {
  MethodN<Dim> m = bare_method<Dim>(integrator);
  m.viscosity = ArtificialViscosity{0.02, 0.01};
  m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, 0.1};
  return m;
}

}  // namespace sluice

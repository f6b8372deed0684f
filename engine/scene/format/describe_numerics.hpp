#pragma once

#include "engine/scene/format/describe_ranges.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

namespace sluice {

// Part of the scene format (describe.hpp): the terms of the method, and the scheme.

template <class Archive>
void describe(Archive& a, DensityDiffusion& term) {
  a.word("kind", kDiffusionWords, term.kind, {.about = "what is diffused"});
  a.number("delta", term.delta, {.about = "strength delta of eq. 7", .range = from(0, 2)});
}

template <class Archive>
void describe_viscosity(Archive& a, double& alpha, double& epsilon) {
  a.number("alpha", alpha, {.about = "strength alpha of eq. 8", .range = from(0, 10)});
  a.number(
      "epsilon", epsilon,
      {.about = "keeps the denominator of eq. 8 from zero: epsilon h^2", .range = above(0, 1)});
}
template <class Archive>
void describe(Archive& a, ArtificialViscosity& term) {
  describe_viscosity(a, term.alpha, term.epsilon);
  a.number("beta", term.beta,
           {.about = "strength of the quadratic part, which acts where particles collide and keeps "
                     "them apart at impacts; 0 leaves it out",
            .range = from(0, 10)});
}
template <class Archive>
void describe(Archive& a, WallArtificialViscosity& term) {
  describe_viscosity(a, term.alpha, term.epsilon);
}

template <class Archive>
void describe(Archive& a, LaminarViscosity& term) {
  a.number("nu", term.nu,
           {.about = "kinematic viscosity: 1e-6 m^2/s is water's own, a turbulent flow's is larger",
            .unit = "m^2/s",
            .range = from(0, 1e12)});
}

template <class Archive>
void describe(Archive& a, WallShear& term) {
  a.number("coefficient", term.coefficient,
           {.about = "skin friction coefficient: stress at the wall over rho v^2/2; 0.004 is a "
                     "smooth wall's, more stands for walls in front and behind as well",
            .range = from(0, 1)});
}

template <class Archive>
void describe(Archive& a, ParticleShifting& term) {
  a.number("coefficient", term.coefficient,
           {.about = "A: a particle moves by A h |v| dt grad C against the gradient of the "
                     "concentration C, at most 0.1 particle distances in a step",
            .range = above(0, 10)});
}

template <class Archive>
void describe(Archive& a, Reinitialisation& term) {
  a.integer("interval", term.interval,
            {.about = "steps from one reinitialisation to the next", .range = from(1, 1e6)});
}

/// Of a scheme, and of single keys beside it. A term takes null: left out.
template <class Archive>
void describe_numerics(Archive& a, Scene& scene) {
  Method& method = scene.method;
  a.word("scheme", kSchemeWords, scene.numerics.scheme,
         {.about = "what the keys that are missing here are; defaults below are those of "
                   "recommended"});
  a.word("kernel", kKernelWords, method.kernel, {.about = "smoothing function W"});
  a.word("integrator", kIntegratorWords, method.integrator, {.about = "time integration"});
  a.number("courant", method.courant,
           {.about = "Courant number C of the time step, eq. 18; 0.25 with modified_leap_frog; "
                     "impacts need it below about two thirds of the limit that linear analysis "
                     "gives for particles at rest (sluice plan)",
            .range = above(0, 2)});
  a.word("precision", kPrecisionWords, method.precision, {.about = "arithmetic"});
  a.term("density_diffusion", method.diffusion, {.about = "density diffusion D_i, eq. 7"});
  a.term("artificial_viscosity", method.viscosity,
         {.about = "artificial viscosity Pi_ij between fluid particles, eq. 8"});
  a.term("wall_artificial_viscosity", method.wall_artificial_viscosity,
         {.about = "Pi_ij of eq. 8 against walls at rest; not beside laminar_viscosity; in place "
                   "of wall_shear"});
  a.term("laminar_viscosity", method.laminar_viscosity,
         {.about = "viscous stress in the fluid, no slip at walls; in place of wall_shear"});
  a.term("wall_shear", method.wall_shear,
         {.about = "stress at walls that grows with the square of the speed"});
  a.word("wall_pressure", kWallPressureWords, method.wall_pressure,
         {.about = "pressure of the walls' dummy particles, eq. 9"});
  a.term("particle_shifting", method.shifting,
         {.about = "moves particles inside the fluid to where others lack; with kick_drift_kick"});
  a.term("reinitialisation", method.reinitialisation,
         {.about = "density reinitialisation, eq. 10"});
}

}  // namespace sluice

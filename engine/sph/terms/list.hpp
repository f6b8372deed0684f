// The list of the terms. Included once, and once per SIMD target by terms-inl.hpp for the summands.

#include "engine/sph/terms/artificial_viscosity.hpp"
#include "engine/sph/terms/density_diffusion.hpp"
#include "engine/sph/terms/laminar_viscosity.hpp"
#include "engine/sph/terms/particle_shifting.hpp"
#include "engine/sph/terms/reinitialisation.hpp"
#include "engine/sph/terms/wall_shear.hpp"

#ifndef SLUICE_SPH_TERMS_LIST
#define SLUICE_SPH_TERMS_LIST

#include "engine/sph/terms/term.hpp"

namespace sluice {

/// Terms of the rates, eqs. 4 and 5: each sums over pairs, and all in one loop. Method, sums, scene
/// format, plan and report walk this list; what they write has its order.
using RateTerms = TermList<DensityDiffusion, ArtificialViscosity, WallArtificialViscosity,
                           LaminarViscosity, WallShear>;

/// Terms that correct the state between two steps. Each has loops and a place in a step of its own,
/// written out in loops and solver; all else walks this list too.
using Corrections = TermList<ParticleShifting, Reinitialisation>;

/// All of them.
using AllTerms = Joined<RateTerms, Corrections>;

}  // namespace sluice

#endif

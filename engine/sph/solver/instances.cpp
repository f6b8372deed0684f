// The templates of this room for the dimensions that runs have; each for both types of pair sums.

#include "engine/sph/solver/engine-inl.hpp"
#include "engine/sph/solver/solver-inl.hpp"

namespace sluice {

template class SolverN<2>;
template class SolverN<3>;

}  // namespace sluice

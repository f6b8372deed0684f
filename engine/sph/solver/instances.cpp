// The templates of this room for the types of pair sums and the dimensions that runs have.

#include "engine/sph/solver/engine-inl.hpp"

namespace sluice {

template std::unique_ptr<Solver::Impl> make_engine<float, 2>(const Method&, const FlowDomain&,
                                                             const SolverState&,
                                                             const std::vector<Vec>&,
                                                             const Execution&);
template std::unique_ptr<Solver::Impl> make_engine<double, 2>(const Method&, const FlowDomain&,
                                                              const SolverState&,
                                                              const std::vector<Vec>&,
                                                              const Execution&);
template class FluidProbe<2>;

}  // namespace sluice

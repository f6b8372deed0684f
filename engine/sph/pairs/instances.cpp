// The templates of this room for the dimensions that runs have.

#include "engine/sph/pairs/grid-inl.hpp"
#include "engine/sph/pairs/layout-inl.hpp"

namespace sluice {

template class Grid<2>;
template class Grid<3>;
template Order sort_into_clusters<2>(ThreadTeam&, const Grid<2>&, const AxisSpans<2>&,
                                     std::span<const double>);
template Order sort_into_clusters<3>(ThreadTeam&, const Grid<3>&, const AxisSpans<3>&,
                                     std::span<const double>);

}  // namespace sluice

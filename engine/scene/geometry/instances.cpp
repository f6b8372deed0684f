// The templates of this room for the dimensions that scenes have.

#include "engine/scene/geometry/solids-inl.hpp"
#include "engine/scene/geometry/too_thin-inl.hpp"
#include "engine/scene/geometry/ways-inl.hpp"

namespace sluice {

template class SolidsN<2>;
template class WaysN<2>;
template bool is_long_way(WaysN<2>&, const VecN<2>&, double);
template bool keeps_apart(const SolidsN<2>&, const VecN<2>&, const VecN<2>&, double, double);

template class SolidsN<3>;
template class WaysN<3>;
template bool is_long_way(WaysN<3>&, const VecN<3>&, double);
template bool keeps_apart(const SolidsN<3>&, const VecN<3>&, const VecN<3>&, double, double);

}  // namespace sluice

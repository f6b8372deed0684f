// The templates of this room for the dimensions that scenes have.

#include "engine/scene/filling/body_fill-inl.hpp"
#include "engine/scene/filling/cells-inl.hpp"
#include "engine/scene/filling/packing-inl.hpp"
#include "engine/scene/filling/solid_walls-inl.hpp"

namespace sluice {

template class BodyFillN<2>;
template class CellSetN<2>;
template PackingReport pack(std::vector<VecN<2>>&, const std::vector<FixedPointN<2>>&, double);
template std::vector<VecN<2>> walls_around(const TankRoomN<2>&, const WallLayers&);
template double count_walls_around(const TankRoomN<2>&, const WallLayers&);
template std::vector<VecN<2>> walls_of_solids<2>(const std::vector<ShapeN<2>>&, const WallLayers&,
                                                 const OwnWallsN<2>&);

template class BodyFillN<3>;
template class CellSetN<3>;
template PackingReport pack(std::vector<VecN<3>>&, const std::vector<FixedPointN<3>>&, double);
template std::vector<VecN<3>> walls_around(const TankRoomN<3>&, const WallLayers&);
template double count_walls_around(const TankRoomN<3>&, const WallLayers&);
template std::vector<VecN<3>> walls_of_solids<3>(const std::vector<ShapeN<3>>&, const WallLayers&,
                                                 const OwnWallsN<3>&);

}  // namespace sluice

#include "engine/scene/filling/body_fill.hpp"

#include "engine/scene/filling/walls.hpp"

namespace sluice {

template <int Dim>
BodyFillN<Dim> body_fill_of(const Scene& scene) {
  std::vector<ShapeN<Dim>> regions;
  for (const FluidRegion& region : scene.fluid) regions.push_back(shape_as<Dim>(region.shape));
  return {std::move(regions), shapes_as<Dim>(solid_bodies(scene)), room_of<Dim>(scene),
          scene.method.spacing};
}

template BodyFillN<2> body_fill_of<2>(const Scene&);
template BodyFillN<3> body_fill_of<3>(const Scene&);

}  // namespace sluice

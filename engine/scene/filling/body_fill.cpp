#include "engine/scene/filling/body_fill.hpp"

#include "engine/scene/filling/walls.hpp"

namespace sluice {

BodyFill body_fill_of(const Scene& scene) {
  std::vector<Shape> regions;
  for (const FluidRegion& region : scene.fluid) regions.push_back(region.shape);
  return {std::move(regions), solid_bodies(scene), room_of(scene), scene.method.spacing};
}

}  // namespace sluice

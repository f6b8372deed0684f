#include "engine/scene/filling/bodies.hpp"

#include <algorithm>
#include <utility>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {

std::vector<Body> bodies(const Scene& scene) {
  const std::size_t count = scene.fluid.size();
  std::vector<std::size_t> owner(count);
  for (std::size_t i = 0; i < count; ++i) {
    owner[i] = i;
    const Box box = grown(bounds(scene.fluid[i].shape), 1.001 * scene.method.spacing);
    for (std::size_t other = 0; other < i; ++other) {
      const bool apart = !overlap(bounds(scene.fluid[other].shape), box);
      if (apart || owner[other] == owner[i]) continue;
      std::replace(owner.begin(), owner.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   std::max(owner[other], owner[i]), std::min(owner[other], owner[i]));
    }
  }
  std::vector<Body> result;
  for (std::size_t first = 0; first < count; ++first) {
    Body body;
    for (std::size_t i = 0; i < count; ++i) {
      if (owner[i] == first) body.push_back(i);
    }
    if (!body.empty()) result.push_back(std::move(body));
  }
  return result;
}

}  // namespace sluice

#include "engine/scene/initial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "engine/scene/cells.hpp"
#include "engine/scene/geometry.hpp"
#include "engine/scene/walls.hpp"
#include "engine/scene/water_level.hpp"

namespace sluice {
namespace {

/// Obstacles with their bounding boxes, widened by half a spacing.
class Displacement {
 public:
  Displacement(const std::vector<Shape>& obstacles, double spacing)
      // A particle half a spacing above a flat face stays, whatever rounding says.
      : gap_((0.5 - 1e-6) * spacing) {
    for (const Shape& shape : obstacles) {
      Box box = bounds(shape);
      box.min.array() -= spacing;
      box.max.array() += spacing;
      bodies_.push_back({&shape, box});
    }
  }

  [[nodiscard]] bool takes(const Vec& point) const {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
      return body.box.contains(point) && signed_distance(*body.shape, point) < gap_;
    });
  }

 private:
  struct Body {
    const Shape* shape;
    Box box;
  };
  double gap_;
  std::vector<Body> bodies_;
};

void require_apart(const std::vector<CellSet>& earlier, const Vec& point, std::size_t region) {
  for (std::size_t other = 0; other < earlier.size(); ++other) {
    if (!earlier[other].covers(point)) continue;
    throw SceneError({fmt::format("/fluid/{}", region),
                      fmt::format("overlaps /fluid/{} at ({:.6g}, {:.6g}) m: particles would lie "
                                  "closer than half a spacing; move or shrink one of the two",
                                  other, point.x(), point.y())});
  }
}

/// A number in [-1, 1) that the arguments determine (SplitMix64, Steele et al. 2014).
double noise(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed * 0xD1342543DE82EF95U + (counter + 1) * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  z ^= z >> 31U;
  return static_cast<double>(z >> 11U) * 0x1p-52 - 1.0;
}

void displace(const Jitter& jitter, double spacing, Particles& particles) {
  const auto seed = static_cast<std::uint64_t>(jitter.seed);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles.x[i] += jitter.amplitude * spacing * noise(seed, 2 * i);
    particles.y[i] += jitter.amplitude * spacing * noise(seed, 2 * i + 1);
  }
}

void append(Particles& particles, const Vec& point, const Vec& velocity, double excess) {
  particles.id.push_back(static_cast<double>(particles.size()));
  particles.x.push_back(point.x());
  particles.y.push_back(point.y());
  particles.vx.push_back(velocity.x());
  particles.vy.push_back(velocity.y());
  particles.density_excess.push_back(excess);
}

void fill(const Scene& scene, const Displacement& solid, Particles& particles) {
  std::vector<CellSet> earlier;
  const WaterLevels levels(scene);
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    const FluidRegion& region = scene.fluid[i];
    const std::size_t before = particles.size();
    CellSet cells(region.shape, scene.method.spacing, CellFit::exact_spacing);
    cells.for_each([&](const Vec& point, std::int64_t, std::int64_t) {
      if (solid.takes(point)) return;
      require_apart(earlier, point, i);
      append(particles, point, region.velocity_at(point), levels.pressure(i, point) / c2);
    });
    if (particles.size() == before) {
      throw SceneError({fmt::format("/fluid/{}", i),
                        "no particle lies in this region: it is narrower than the lattice or "
                        "filled by obstacles; enlarge it or lower /resolution/spacing"});
    }
    earlier.push_back(std::move(cells));
  }
}

}  // namespace

InitialParticles create_particles(const Scene& scene) {
  InitialParticles result;
  fill(scene, Displacement(solid_bodies(scene), scene.method.spacing), result.state.particles);
  if (scene.jitter) displace(*scene.jitter, scene.method.spacing, result.state.particles);
  result.walls = scene_walls(scene);
  return result;
}

std::optional<Problem> problem_when_filled(const Scene& scene) {
  try {
    (void)create_particles(scene);
    return std::nullopt;
  } catch (const SceneError& error) {
    return error.problem();
  }
}

}  // namespace sluice

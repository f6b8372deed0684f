#include "engine/scene/filling/initial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "engine/scene/filling/body_fill.hpp"
#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/lattice_fit.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/filling/water_level.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

/// Obstacles with their bounding boxes, widened by half a spacing.
class Displacement {
 public:
  Displacement(const std::vector<Shape>& obstacles, double spacing)
      // A particle half a spacing above a flat face stays, whatever rounding says.
      : gap_((0.5 - 1e-6) * spacing) {
    for (const Shape& shape : obstacles) {
      bodies_.push_back({&shape, grown(bounds(shape), spacing)});
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

void displace(const Perturbation& perturbation, double spacing, Particles& particles) {
  const auto seed = static_cast<std::uint64_t>(perturbation.seed);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t axis = 0; axis < particles.position.size(); ++axis) {
      particles.position[axis][i] +=
          perturbation.amplitude * spacing * noise(seed, kDim * i + axis);
    }
  }
}

/// Places of the particles of each region.
using Places = std::vector<std::vector<Vec>>;

Places on_lattice(const Scene& scene) {
  const std::vector<Shape> bodies = solid_bodies(scene);
  const Displacement solid(bodies, scene.method.spacing);
  std::vector<CellSet> earlier;
  Places places;
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    std::vector<Vec>& points = places.emplace_back();
    CellSet cells(scene.fluid[i].shape, scene.method.spacing, CellFit::exact_spacing);
    cells.for_each([&](const Vec& point, const auto&) {
      if (solid.takes(point)) return;
      require_apart(earlier, point, i);
      points.push_back(point);
    });
    if (points.empty()) {
      throw SceneError({fmt::format("/fluid/{}", i),
                        "no particle lies in this region: it is narrower than the lattice or "
                        "filled by obstacles; enlarge it or lower /resolution/spacing"});
    }
    earlier.push_back(std::move(cells));
  }
  return places;
}

PackingReport pack_body(const Scene& scene, const Body& body, const std::vector<Vec>& walls,
                        Places& places) {
  const BodyFill fill = body_fill_of(scene);
  std::vector<FixedPoint> fixed = fill.outside(body);
  for (const Vec& wall : walls) fixed.push_back({wall, 1.0});
  std::vector<Vec> points;
  for (const std::size_t region : body) {
    places[region] = fill.places(region);
    points.insert(points.end(), places[region].begin(), places[region].end());
  }
  const PackingReport report = pack(points, fixed, scene.method.spacing);
  auto next = points.begin();
  for (const std::size_t region : body) {
    for (Vec& point : places[region]) point = *next++;
  }
  return report;
}

/// Packs every body that its lattice does not fit.
std::optional<PackingReport> pack_misfits(const Scene& scene, const std::vector<Vec>& walls,
                                          Places& places) {
  std::optional<PackingReport> all;
  for (const Body& body : bodies(scene)) {
    if (!lattice_misfit(scene, body)) continue;
    const PackingReport one = pack_body(scene, body, walls, places);
    if (!all) all.emplace();
    all->particles += one.particles;
    all->iterations = std::max(all->iterations, one.iterations);
    all->residual = std::max(all->residual, one.residual);
  }
  return all;
}

Particles particles_at(const Scene& scene, const Places& places) {
  const WaterLevels levels(scene);
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  Particles particles;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const Vec& point : places[i]) {
      particles.id.push_back(static_cast<double>(particles.size()));
      append(particles.position, point);
      append(particles.velocity, velocity_at(scene.fluid[i], point));
      particles.density_excess.push_back(levels.pressure(i, point) / c2);
    }
  }
  return particles;
}

}  // namespace

InitialParticles create_particles(const Scene& scene) {
  InitialParticles result;
  result.walls = scene_walls(scene);
  Places places = on_lattice(scene);
  result.packing = pack_misfits(scene, result.walls, places);
  result.state.particles = particles_at(scene, places);
  if (scene.perturbation)
    displace(*scene.perturbation, scene.method.spacing, result.state.particles);
  return result;
}

StartPlan start_plan(const Scene& scene) {
  const Places places = on_lattice(scene);
  StartPlan plan;
  for (const Body& body : bodies(scene)) {
    const std::optional<std::string> misfit = lattice_misfit(scene, body);
    if (misfit && !plan.packed) plan.reason = *misfit;
    plan.packed = plan.packed || misfit.has_value();
    const BodyFill fill = body_fill_of(scene);
    for (const std::size_t region : body) {
      plan.fluid_particles += misfit ? fill.count(region) : places[region].size();
    }
  }
  return plan;
}

std::optional<Problem> problem_when_filled(const Scene& scene) {
  try {
    (void)on_lattice(scene);
    return std::nullopt;
  } catch (const SceneError& error) {
    return error.problem();
  }
}

}  // namespace sluice

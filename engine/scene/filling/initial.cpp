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
template <int Dim>
class Displacement {
 public:
  Displacement(const std::vector<ShapeN<Dim>>& obstacles, double spacing)
      // A particle half a spacing above a flat face stays, whatever rounding says.
      : gap_((0.5 - 1e-6) * spacing) {
    for (const ShapeN<Dim>& shape : obstacles) {
      bodies_.push_back({shape, grown(bounds(shape), spacing)});
    }
  }

  [[nodiscard]] bool takes(const VecN<Dim>& point) const {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
      return body.box.contains(point) && signed_distance(body.shape, point) < gap_;
    });
  }

 private:
  struct Body {
    ShapeN<Dim> shape;
    BoxN<Dim> box;
  };
  double gap_;
  std::vector<Body> bodies_;
};

template <int Dim>
void require_apart(const std::vector<CellSetN<Dim>>& earlier, const VecN<Dim>& point,
                   std::size_t region) {
  for (std::size_t other = 0; other < earlier.size(); ++other) {
    if (!earlier[other].covers(point)) continue;
    throw SceneError({fmt::format("/fluid/{}", region),
                      fmt::format("overlaps /fluid/{} at ({:.6g}) m: particles would lie "
                                  "closer than half a spacing; move or shrink one of the two",
                                  other, fmt::join(point, ", "))});
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
  const std::size_t axes = particles.position.size();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      particles.position[axis][i] +=
          perturbation.amplitude * spacing * noise(seed, axes * i + axis);
    }
  }
}

/// Places of the particles of each region.
template <int Dim>
using PlacesN = std::vector<std::vector<VecN<Dim>>>;

template <int Dim>
PlacesN<Dim> on_lattice(const Scene& scene) {
  const Displacement<Dim> solid(shapes_as<Dim>(solid_bodies(scene)), scene.method.spacing);
  std::vector<CellSetN<Dim>> earlier;
  PlacesN<Dim> places;
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    std::vector<VecN<Dim>>& points = places.emplace_back();
    CellSetN<Dim> cells(shape_as<Dim>(scene.fluid[i].shape), scene.method.spacing,
                        CellFit::exact_spacing);
    cells.for_each([&](const VecN<Dim>& point, const auto&) {
      if (solid.takes(point)) return;
      require_apart<Dim>(earlier, point, i);
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

template <int Dim>
PackingReport pack_body(const Scene& scene, const Body& body, const std::vector<Vec>& walls,
                        PlacesN<Dim>& places) {
  const BodyFillN<Dim> fill = body_fill_of<Dim>(scene);
  std::vector<FixedPointN<Dim>> fixed = fill.outside(body);
  for (const Vec& wall : walls) fixed.push_back({wall, 1.0});
  std::vector<VecN<Dim>> points;
  for (const std::size_t region : body) {
    places[region] = fill.places(region);
    points.insert(points.end(), places[region].begin(), places[region].end());
  }
  const PackingReport report = pack(points, fixed, scene.method.spacing);
  auto next = points.begin();
  for (const std::size_t region : body) {
    for (VecN<Dim>& point : places[region]) point = *next++;
  }
  return report;
}

/// Packs every body that its lattice does not fit.
template <int Dim>
std::optional<PackingReport> pack_misfits(const Scene& scene, const std::vector<Vec>& walls,
                                          PlacesN<Dim>& places) {
  std::optional<PackingReport> all;
  for (const Body& body : bodies(scene)) {
    if (!lattice_misfit(scene, body)) continue;
    const PackingReport one = pack_body<Dim>(scene, body, walls, places);
    if (!all) all.emplace();
    all->particles += one.particles;
    all->iterations = std::max(all->iterations, one.iterations);
    all->residual = std::max(all->residual, one.residual);
  }
  return all;
}

template <int Dim>
Particles particles_at(const Scene& scene, const PlacesN<Dim>& places) {
  const WaterLevels levels(scene);
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  Particles particles = no_particles(Dim);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const VecN<Dim>& point : places[i]) {
      particles.id.push_back(static_cast<double>(particles.size()));
      append(particles.position, point);
      append(particles.velocity, velocity_at(scene.fluid[i], point));
      particles.density_excess.push_back(levels.pressure(i, point) / c2);
    }
  }
  return particles;
}

template <int Dim>
InitialParticles initial_particles(const Scene& scene) {
  InitialParticles result;
  result.walls = scene_walls(scene);
  PlacesN<Dim> places = on_lattice<Dim>(scene);
  result.packing = pack_misfits<Dim>(scene, result.walls, places);
  result.state.particles = particles_at<Dim>(scene, places);
  if (scene.perturbation)
    displace(*scene.perturbation, scene.method.spacing, result.state.particles);
  return result;
}

template <int Dim>
StartPlan plan_of_start(const Scene& scene) {
  const PlacesN<Dim> places = on_lattice<Dim>(scene);
  StartPlan plan;
  for (const Body& body : bodies(scene)) {
    const std::optional<std::string> misfit = lattice_misfit(scene, body);
    if (misfit && !plan.packed) plan.reason = *misfit;
    plan.packed = plan.packed || misfit.has_value();
    const BodyFillN<Dim> fill = body_fill_of<Dim>(scene);
    for (const std::size_t region : body) {
      plan.fluid_particles += misfit ? fill.count(region) : places[region].size();
    }
  }
  return plan;
}

}  // namespace

InitialParticles create_particles(const Scene& scene) {
  return in_dimensions(scene.dimensions(),
                       [&]<int Dim>() { return initial_particles<Dim>(scene); });
}

StartPlan start_plan(const Scene& scene) {
  return in_dimensions(scene.dimensions(), [&]<int Dim>() { return plan_of_start<Dim>(scene); });
}

std::optional<Problem> problem_when_filled(const Scene& scene) {
  try {
    in_dimensions(scene.dimensions(), [&]<int Dim>() { (void)on_lattice<Dim>(scene); });
    return std::nullopt;
  } catch (const SceneError& error) {
    return error.problem();
  }
}

}  // namespace sluice

#include "engine/scene/forecast/workload.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/filling/walls.hpp"
#include "engine/scene/format/written_scene.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

template <int Dim>
double count_cells_of(const ShapeN<Dim>& shape, double spacing) {
  if (const auto* cuboid = std::get_if<Cuboid<Dim>>(&shape)) {
    const VecN<Dim> cells = (cuboid->size / spacing).array().round().max(1.0);
    return cells.prod();
  }
  return measure(shape) / cell_measure<Dim>(spacing);
}

double count_cells(const Shape& shape, double spacing) {
  return in_dimensions(dimensions_of(shape), [&]<int Dim>() {
    return count_cells_of<Dim>(shape_as<Dim>(shape), spacing);
  });
}

/// Cells of a layer around a shape.
double count_surface_cells(const Shape& shape, double spacing) {
  double cells = perimeter(shape) / spacing;
  return dimensions_of(shape) == 3 ? cells / spacing : cells;
}

// The factor of both parts of eq. 18 that the paper gives for the force condition.
constexpr double kForceFactor = 0.25;

}  // namespace

double count_fluid_cells(const Scene& scene) {
  double sum = 0.0;
  for (const FluidRegion& region : scene.fluid) {
    sum += count_cells(region.shape, scene.method.spacing);
  }
  return sum;
}

double count_obstacle_cells(const Scene& scene) {
  double sum = 0.0;
  for (const Shape& shape : scene.obstacles) sum += count_cells(shape, scene.method.spacing);
  return sum;
}

double count_wall_cells(const Scene& scene) {
  const double dx = scene.method.spacing;
  const auto layers = static_cast<double>(wall_layers(scene.method));
  double sum = scene.tank ? count_tank_walls(*scene.tank, scene.method) : 0.0;
  for (const Shape& shape : scene.obstacles) {
    sum += std::min(count_cells(shape, dx), count_surface_cells(shape, dx) * layers);
  }
  if (scene.gate) sum += count_cells(gate_body(scene), dx);
  return sum;
}

double expected_time_step(const Scene& scene) {
  const Method& method = scene.method;
  const double strength = method.gravity.norm();
  double speed = std::sqrt(2 * strength * fluid_height(scene));
  for (const FluidRegion& region : scene.fluid) speed = std::max(speed, greatest_speed(region));
  const double sound = method.courant * method.smoothing_length / (method.sound_speed + speed);
  return std::min(sound, force_time_step(method));
}

double force_time_step(const Method& method) {
  return kForceFactor * std::sqrt(method.smoothing_length / method.gravity.norm());
}

double count_samples(const Scene& scene) {
  const double steps = scene.end_time / expected_time_step(scene);
  double sum = 0.0;
  for (const Sensor& sensor : scene.sensors) {
    const double due = sensor.interval > 0 ? scene.end_time / sensor.interval : steps;
    sum += std::floor(std::min(due, steps)) + 1;
  }
  return sum;
}

double count_frames(const Scene& scene) {
  return scene.frames ? std::floor(scene.end_time / scene.frames->interval) + 1 : 0.0;
}

}  // namespace sluice

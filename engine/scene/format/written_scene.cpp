#include "engine/scene/format/written_scene.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/space/axes.hpp"

namespace sluice {
namespace {

constexpr double kWaterDensity = 1000.0;  // kg/m^3

// h/dx with the fewest digits of which the product with dx is h again.
double ratio_of(double smoothing_length, double spacing) {
  const double quotient = smoothing_length / spacing;
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    std::array<char, 40> text{};
    char* const end = text.data() + text.size();
    const auto written =
        std::to_chars(text.data(), end, quotient, std::chars_format::general, digits);
    double ratio = 0.0;
    std::from_chars(text.data(), written.ptr, ratio);
    if (ratio * spacing == smoothing_length) return ratio;
  }
  for (const double ratio : {std::nextafter(quotient, 0.0), std::nextafter(quotient, 10.0)}) {
    if (ratio * spacing == smoothing_length) return ratio;
  }
  return quotient;
}

Box fluid_bounds(const Scene& scene) {
  Box box = bounds(scene.fluid.front().shape);
  for (const FluidRegion& region : scene.fluid) {
    const Box other = bounds(region.shape);
    box.min = box.min.cwiseMin(other.min);
    box.max = box.max.cwiseMax(other.max);
  }
  return box;
}

// Largest value of direction . x over the fluid.
double farthest_fluid(const Scene& scene, const Vec& direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (const FluidRegion& region : scene.fluid) {
    most = std::max(most, farthest_along(region.shape, direction));
  }
  return most;
}

Box domain_of_tank(const Scene& scene) {
  const Method& method = scene.method;
  const double walls =
      static_cast<double>(wall_layers(method)) * method.spacing + method.smoothing_length;
  const Tank& tank = *scene.tank;
  const double above = tank.open_top
                           ? 2 * std::max(fluid_height(scene), fluid_bounds(scene).size()[kUpAxis])
                           : walls;
  Box box = grown(tank.interior(), walls);
  box.max[kUpAxis] = tank.height + std::max(above, walls);
  return box;
}

// Where the fluid starts and where it flies to with nothing in its way.
Box domain_of_flight(const Scene& scene) {
  const Box start = fluid_bounds(scene);
  Box box = start;
  const double t = scene.end_time;
  const Vec fall = scene.method.gravity * (t * t / 2);
  for (const FluidRegion& region : scene.fluid) {
    const Vec flight = region.velocity * t + fall;
    // An arc may rise above both of its ends: v^2/2f at the most along each axis.
    const Vec rise = region.velocity.binaryExpr(scene.method.gravity, [t](double v, double f) {
      const bool turns = v * f < 0 && -v / f < t;
      return turns ? -v * v / (2 * f) : 0.0;
    });
    const double spread = (greatest_speed(region) - region.velocity.norm()) * t;
    for (const Vec& shift : {flight, rise}) {
      const Box moved = grown(Box{start.min + shift, start.max + shift}, spread);
      box.min = box.min.cwiseMin(moved.min);
      box.max = box.max.cwiseMax(moved.max);
    }
  }
  const double margin = start.size().maxCoeff() + scene.method.support();
  return grown(box, margin);
}

}  // namespace

WrittenScene::WrittenScene(std::optional<Scheme> scheme, int of_dimensions) {
  scene.numerics.scheme = scheme;
  scene.method = method_of(scheme);
  scene.method.gravity = filled_vec<kAnyDim>(0.0, of_dimensions);
  scene.method.reference_density = kWaterDensity;
}

WrittenScene::WrittenScene(const Scene& from)
    : scene(from),
      dimensions(from.dimensions() == kPlaneDim ? std::nullopt : std::optional(from.dimensions())),
      domain(from.domain.box),
      sound_speed(from.method.sound_speed),
      smoothing_ratio(ratio_of(from.method.smoothing_length, from.method.spacing)) {
  if (!from.method.gravity.isZero(0.0)) gravity = from.method.gravity;
  scene.numerics = {};  // every key is there now
}

double default_smoothing_ratio(KernelKind kernel) {
  return kernel == KernelKind::truncated_gaussian ? 1.0 : 1.5;
}

double fluid_height(const Scene& scene) {
  const Vec& f = scene.method.gravity;
  const double strength = f.norm();
  if (strength == 0.0) return 0.0;
  const Vec down = f / strength;
  const double lowest =
      scene.tank ? down.cwiseMax(0.0).dot(scene.tank->size()) : farthest_fluid(scene, down);
  return lowest + farthest_fluid(scene, -down);
}

double default_sound_speed(const Scene& scene) {
  return 10 * std::sqrt(2 * scene.method.gravity.norm() * fluid_height(scene));
}

Box default_domain(const Scene& scene) {
  return scene.tank ? domain_of_tank(scene) : domain_of_flight(scene);
}

Scene resolve(const WrittenScene& written) {
  Scene scene = written.scene;
  Method& method = scene.method;
  if (written.gravity) method.gravity = *written.gravity;
  method.smoothing_length =
      written.smoothing_ratio.value_or(default_smoothing_ratio(method.kernel)) * method.spacing;
  method.sound_speed = written.sound_speed ? *written.sound_speed : default_sound_speed(scene);
  scene.domain.box = written.domain ? *written.domain : default_domain(scene);
  scene.domain.rim = scene.domain.room = Box::everywhere(scene.dimensions());
  // Nothing passes over a lid: what leaves a closed tank has leaked, wherever.
  if (scene.tank && scene.tank->open_top) {
    scene.domain.wall_top = scene.tank->height;
    const double middle = static_cast<double>(wall_layers(method)) / 2 * method.spacing;
    const Box sides = grown(scene.tank->interior(), middle);
    for (const int axis : floor_axes(scene.dimensions())) {
      scene.domain.rim.min[axis] = sides.min[axis];
      scene.domain.rim.max[axis] = sides.max[axis];
    }
  }
  if (scene.gate && scene.tank) {
    if (scene.gate->height == 0.0) scene.gate->height = scene.tank->height;
    scene.domain.gate = GateMotion{bounds(gate_body(scene)), scene.gate->speed};
  }
  for (Sensor& sensor : scene.sensors) {
    const bool wants_length = sensor.kind == SensorKind::pressure;
    if (wants_length && sensor.smoothing_length == 0.0) {
      sensor.smoothing_length = method.smoothing_length;
    }
  }
  return scene;
}

}  // namespace sluice

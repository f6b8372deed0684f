#include "engine/scene/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/scene/describe.hpp"
#include "engine/scene/geometry.hpp"
#include "engine/scene/walls.hpp"
#include "engine/scene/work.hpp"

namespace sluice {
namespace {

// Sides of the domain and distance from the origin, in spacings: rows of cells are kept in memory,
// and positions must stay exact to a small part of dx.
constexpr double kMaxDomainCells = 1e6;
constexpr double kMaxOffsetCells = 1e9;
constexpr double kMaxSteps = 1e9;
constexpr double kMaxSamples = 2e7;  // all sensors; 640 MB
constexpr double kMaxFrames = 1e5;
// Below this the fluid's own weight compresses it by a quarter.
constexpr double kMinSoundRatio = 2.0;
// Lengths that are meant to be equal may differ by rounding: 0.1 + 0.2 against 0.3.
constexpr double kSlack = 1e-9;

std::string show(const Box& box) {
  return fmt::format("({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) m", box.min.x(), box.min.y(),
                     box.max.x(), box.max.y());
}

bool within(const Box& inner, const Box& outer) {
  const double slack = kSlack * outer.size().maxCoeff();
  return (inner.min.array() >= outer.min.array() - slack).all() &&
         (inner.max.array() <= outer.max.array() + slack).all();
}

/// Calls f(pointer, shape) for each region and obstacle that reads well.
template <class F>
void for_each_shape(const Scene& scene, const Problems& problems, const F& f) {
  const auto visit = [&](std::string pointer, const Shape& shape) {
    if (problems.clean({pointer})) f(pointer, shape);
  };
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    visit(at("/fluid", i), scene.fluid[i].shape);
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    visit(at("/obstacles", i), scene.obstacles[i]);
  }
}

void check_polygons(const Scene& scene, Problems& problems) {
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    const auto* polygon = std::get_if<Polygon>(&shape);
    if (polygon != nullptr && (!is_simple(*polygon) || area(shape) <= 0)) {
      problems.add(at(pointer, "points"),
                   "the outline crosses, touches or folds back on itself; give the corners in "
                   "order around an area, each once");
    }
  });
}

void check_sizes(const Scene& scene, Problems& problems) {
  if (!problems.clean({"/resolution"})) return;
  const double dx = scene.method.spacing;
  const auto check_size = [&](std::string pointer, const Vec& size) {
    if (size.minCoeff() >= dx * (1 - kSlack)) return;
    problems.add(std::move(pointer),
                 fmt::format("is {:.6g} m x {:.6g} m; must be at least one /resolution/spacing, "
                             "{:.6g} m, either way",
                             size.x(), size.y(), dx));
  };
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    check_size(pointer, bounds(shape).size());
  });
  if (scene.tank && problems.clean({"/tank"})) {
    check_size("/tank", Vec(scene.tank->width, scene.tank->height));
  }
}

void check_tank(const Scene& scene, Problems& problems) {
  if (!scene.tank || !problems.clean({"/tank"})) return;
  const Box inside{Vec::Zero(), Vec(scene.tank->width, scene.tank->height)};
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    if (within(bounds(shape), inside)) return;
    problems.add(pointer, fmt::format("reaches from {}; must lie inside /tank, {}",
                                      show(bounds(shape)), show(inside)));
  });
}

void check_gravity(const Document& document, Problems& problems) {
  if (!problems.clean({"/gravity", "/material"}) || document.sound_speed) return;
  if (document.gravity.value_or(Vec::Zero()).isZero(0.0)) {
    problems.add("/material/sound_speed",
                 "is missing; must be given where there is no gravity to derive it from: about "
                 "ten times the largest flow speed");
  }
}

void check_sound_speed(const Scene& scene, const Document& document, Problems& problems) {
  const double c = scene.method.sound_speed;
  if (!document.sound_speed && (c < kSoundSpeed.low || c > kSoundSpeed.high)) {
    problems.add("/gravity", fmt::format("asks for a sound speed of {:.6g} m/s; must be {}; scale "
                                         "the scene",
                                         c, to_text(kSoundSpeed, "m/s")));
    return;
  }
  const double gravity_wave = std::sqrt(scene.method.gravity.norm() * fluid_height(scene));
  if (c <= kMinSoundRatio * gravity_wave * (1 + kSlack)) {
    problems.add("/material/sound_speed",
                 fmt::format("is {:.6g} m/s; must be above {} sqrt(|gravity| H) = {:.6g} m/s, or "
                             "the fluid's weight compresses it by a quarter; 14 times the root is "
                             "usual",
                             c, kMinSoundRatio, kMinSoundRatio * gravity_wave));
  }
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    const double speed = scene.fluid[i].velocity.norm();
    if (speed <= c) continue;
    problems.add(
        at(at("/fluid", i), "velocity"),
        fmt::format("is {:.6g} m/s; must be at most the sound speed, {:.6g} m/s", speed, c));
  }
}

void check_particle_count(const Scene& scene, Problems& problems) {
  const double fluid = count_fluid_cells(scene);
  const double solid = count_wall_cells(scene) + count_obstacle_cells(scene);
  if (fluid + solid <= kMaxParticles) return;
  problems.add("/resolution/spacing",
               fmt::format("is {:.6g} m, which makes {:.3g} fluid and {:.3g} solid particles; at "
                           "most {:.3g} in all; a spacing near {:.3g} m is possible",
                           scene.method.spacing, fluid, solid, kMaxParticles,
                           scene.method.spacing * std::sqrt((fluid + solid) / kMaxParticles)));
}

/// Everything that must lie in the domain: the tank with its walls, else the fluid and obstacles.
void check_domain_holds(const Scene& scene, const Document& document, Problems& problems) {
  const Box& domain = scene.method.domain;
  if (scene.tank) {
    const double walls = static_cast<double>(wall_layers(scene.method)) * scene.method.spacing;
    const double lid = scene.tank->open_top ? 0.0 : walls;
    const Box solid{Vec::Constant(-walls),
                    Vec(scene.tank->width + walls, scene.tank->height + lid)};
    if (!within(solid, domain)) {
      problems.add("/domain", fmt::format("is {}; must hold the tank and its walls, {}",
                                          show(domain), show(solid)));
    }
    return;
  }
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    if (within(bounds(shape), domain)) return;
    problems.add(pointer,
                 fmt::format("reaches from {}; must lie in /domain, {}{}", show(bounds(shape)),
                             show(domain), document.domain ? "" : " (the default)"));
  });
}

void check_domain(const Scene& scene, const Document& document, Problems& problems) {
  const Box& domain = scene.method.domain;
  const double dx = scene.method.spacing;
  if ((domain.min.array() >= domain.max.array()).any()) {
    problems.add("/domain", fmt::format("is {}; min must be below max both ways", show(domain)));
    return;
  }
  const double sides = domain.size().maxCoeff() / dx;
  const double offset =
      std::max(domain.min.cwiseAbs().maxCoeff(), domain.max.cwiseAbs().maxCoeff()) / dx;
  if (!(sides <= kMaxDomainCells && offset <= kMaxOffsetCells)) {
    problems.add("/domain",
                 fmt::format("is {}{}; each side may be at most {:.0e} and each corner at most "
                             "{:.0e} spacings of {:.6g} m from the origin",
                             show(domain), document.domain ? "" : " (the default)", kMaxDomainCells,
                             kMaxOffsetCells, dx));
    return;
  }
  check_domain_holds(scene, document, problems);
}

void check_names(const Scene& scene, Problems& problems) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const std::string pointer = at("/sensors", i);
    if (!problems.clean({pointer}) || names.insert(scene.sensors[i].name).second) continue;
    problems.add(at(pointer, "name"), fmt::format("is \"{}\", which another sensor has; names "
                                                  "must be unique",
                                                  scene.sensors[i].name));
  }
}

void check_sensor(const Sensor& sensor, const std::string& pointer, const Method& method,
                  Problems& problems) {
  const bool point = sensor.kind == SensorKind::pressure || sensor.kind == SensorKind::arrival;
  const bool line =
      sensor.kind == SensorKind::surface_height || sensor.kind == SensorKind::column_height;
  const Box& domain = method.domain;
  const double x = sensor.position.x();
  if (point && !domain.contains(sensor.position)) {
    problems.add(at(pointer, "position"),
                 fmt::format("is ({:.6g}, {:.6g}) m; must lie in /domain, {}", x,
                             sensor.position.y(), show(domain)));
  }
  if (line && (x < domain.min.x() || x > domain.max.x())) {
    problems.add(at(pointer, "x"), fmt::format("is {:.6g} m; must lie in /domain, {:.6g} to {:.6g} "
                                               "m",
                                               x, domain.min.x(), domain.max.x()));
  }
  const double ratio = sensor.smoothing_length / method.smoothing_length;
  if (sensor.kind == SensorKind::pressure && !(ratio >= 0.5 && ratio <= 10)) {
    problems.add(at(pointer, "smoothing_length"),
                 fmt::format("is {:.6g} m; must be from 0.5 to 10 smoothing lengths of {:.6g} m",
                             sensor.smoothing_length, method.smoothing_length));
  }
}

void check_sensors(const Scene& scene, Problems& problems) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const std::string pointer = at("/sensors", i);
    if (problems.clean({pointer})) {
      check_sensor(scene.sensors[i], pointer, scene.method, problems);
    }
  }
}

void check_work(const Scene& scene, Problems& problems) {
  const double steps = scene.end_time / expected_time_step(scene);
  if (!(steps <= kMaxSteps)) {
    problems.add("/end_time",
                 fmt::format("is {:.6g} s, about {:.3g} steps of {:.3g} s; at most "
                             "{:.0e} steps",
                             scene.end_time, steps, expected_time_step(scene), kMaxSteps));
    return;
  }
  if (const double samples = count_samples(scene);
      problems.clean({"/sensors"}) && samples > kMaxSamples) {
    problems.add("/sensors", fmt::format("ask for {:.3g} samples; at most {:.0e} in all; lengthen "
                                         "their intervals",
                                         samples, kMaxSamples));
  }
  if (const double frames = count_frames(scene);
      problems.clean({"/output"}) && frames > kMaxFrames) {
    problems.add("/output/frames/interval",
                 fmt::format("is {:.6g} s, which makes {:.3g} snapshots; at most {:.0e}",
                             scene.frames->interval, frames, kMaxFrames));
  }
}

}  // namespace

void check(const Document& document, Problems& problems) {
  const Scene& written = document.scene;
  check_polygons(written, problems);
  check_sizes(written, problems);
  check_tank(written, problems);
  check_gravity(document, problems);
  check_names(written, problems);
  if (!problems.clean(
          {"/tank", "/fluid", "/obstacles", "/gravity", "/material", "/resolution", "/numerics"})) {
    return;
  }
  const bool placed = problems.clean({"/domain", "/end_time"});
  const Scene scene = resolve(document);
  check_sound_speed(scene, document, problems);
  check_particle_count(scene, problems);
  if (!placed) return;
  check_domain(scene, document, problems);
  if (problems.clean({"/domain"})) check_sensors(scene, problems);
  if (problems.clean({"/material"})) check_work(scene, problems);
}

}  // namespace sluice

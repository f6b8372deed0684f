#include "engine/scene/checks/check.hpp"
#include "engine/scene/geometry/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/scene/checks/check_regions.hpp"
#include "engine/scene/checks/check_shapes.hpp"
#include "engine/scene/checks/check_solids.hpp"
#include "engine/scene/checks/warnings.hpp"
#include "engine/scene/forecast/stability.hpp"
#include "engine/scene/forecast/workload.hpp"
#include "engine/scene/format/describe.hpp"
#include "engine/space/axes.hpp"

namespace sluice {
namespace {

constexpr double kMaxSteps = 1e9;
constexpr double kMaxSamples = 2e7;  // all sensors; 2 GB of memory at most
constexpr double kMaxFrames = 1e5;
// Below this the fluid's own weight compresses it by a quarter.
constexpr double kMinSoundRatio = 2.0;

bool falls(const WrittenScene& written) { return written.gravity && !written.gravity->isZero(0.0); }

void check_gravity(const WrittenScene& written, Problems& problems) {
  if (!problems.clean({"/gravity", "/material"}) || written.sound_speed) return;
  if (!falls(written)) {
    problems.add("/material/sound_speed",
                 "is missing; must be given where there is no gravity to derive it from: about "
                 "ten times the largest flow speed");
  }
}

void check_sound_speed(const Scene& scene, const WrittenScene& written, Problems& problems) {
  const double c = scene.method.sound_speed;
  if (!written.sound_speed && (c < kSoundSpeed.low || c > kSoundSpeed.high)) {
    problems.add("/gravity", fmt::format("asks for a sound speed of {:.6g} m/s; must be {}; scale "
                                         "the scene",
                                         c, to_text(kSoundSpeed, "m/s")));
    return;
  }
  const double gravity_wave = std::sqrt(scene.method.gravity.norm() * fluid_height(scene));
  if (c <= kMinSoundRatio * gravity_wave * (1 + 1e-9)) {
    problems.add("/material/sound_speed",
                 fmt::format("is {:.6g} m/s; must be above {} sqrt(|gravity| H) = {:.6g} m/s, or "
                             "the fluid's weight compresses it by a quarter; 14 times the root is "
                             "usual",
                             c, kMinSoundRatio, kMinSoundRatio * gravity_wave));
  }
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    const double speed = greatest_speed(scene.fluid[i]);
    if (speed <= c) continue;
    problems.add(
        at("/fluid", i),
        fmt::format("moves at up to {:.6g} m/s; must be at most the sound speed, {:.6g} m/s", speed,
                    c));
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
                           scene.method.spacing * std::pow((fluid + solid) / kMaxParticles,
                                                           1.0 / scene.dimensions())));
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

void check_sensor(const Sensor& sensor, const std::string& pointer, const Scene& scene,
                  Problems& problems) {
  const bool point = sensor.kind == SensorKind::pressure || sensor.kind == SensorKind::arrival;
  const bool line =
      sensor.kind == SensorKind::surface_height || sensor.kind == SensorKind::column_height;
  const Box& domain = scene.domain.box;
  if (point && !domain.contains(sensor.position)) {
    problems.add(at(pointer, "position"),
                 fmt::format("is ({:.6g}) m; must lie in /domain, {}",
                             fmt::join(sensor.position, ", "), show(domain)));
  }
  for (const int axis : floor_axes(scene.dimensions())) {
    const double along = sensor.position[axis];
    if (!line || (along >= domain.min[axis] && along <= domain.max[axis])) continue;
    problems.add(at(pointer, axis_name(axis)),
                 fmt::format("is {:.6g} m; must lie in /domain, {:.6g} to {:.6g} m", along,
                             domain.min[axis], domain.max[axis]));
  }
  const double ratio = sensor.smoothing_length / scene.method.smoothing_length;
  if (sensor.kind == SensorKind::pressure && !(ratio >= 0.5 && ratio <= 10)) {
    problems.add(at(pointer, "smoothing_length"),
                 fmt::format("is {:.6g} m; must be from 0.5 to 10 smoothing lengths of {:.6g} m",
                             sensor.smoothing_length, scene.method.smoothing_length));
  }
}

void check_sensors(const Scene& scene, Problems& problems) {
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const std::string pointer = at("/sensors", i);
    if (problems.clean({pointer})) {
      check_sensor(scene.sensors[i], pointer, scene, problems);
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

/// Told of the term that acts at walls alone, rather than of one that acts in the fluid as well.
template <class First, class Second>
void check_beside(const Method& m, Problems& problems) {
  if constexpr (!First::kSummation.over_walls_alone() && Second::kSummation.over_walls_alone()) {
    check_beside<Second, First>(m, problems);
  } else if (m.term<First>() && m.term<Second>()) {
    problems.add(fmt::format("/numerics/{}", First::kText.key),
                 fmt::format("stands beside {}, which holds the fluid at walls already; remove one "
                             "of the two",
                             Second::kText.key));
  }
}

void check_holding_at_walls(const Method&, TermList<>, Problems&) {}
template <class First, class... Rest>
void check_holding_at_walls(const Method& m, TermList<First, Rest...>, Problems& problems) {
  const auto against = [&]<class Other>() {
    if constexpr (First::kSummation.holds_at_walls && Other::kSummation.holds_at_walls) {
      check_beside<First, Other>(m, problems);
    }
  };
  for_each_term(TermList<Rest...>{}, against);
  check_holding_at_walls(m, TermList<Rest...>{}, problems);
}

void check_shifting(const Scene& scene, Problems& problems) {
  const Method& m = scene.method;
  if (!m.shifting || m.integrator == Integrator::kick_drift_kick) return;
  problems.add("/numerics/particle_shifting",
               "stands beside the integrator modified_leap_frog, whose half level it would leave "
               "behind; remove it or write \"integrator\": \"kick_drift_kick\"");
}

/// A scheme whose errors fill the flow within the run is refused; slower growth is only told.
void check_stability(const Scene& scene, Problems& problems) {
  if (stability_outlook(scene) != Outlook::unstable) return;
  const StabilityPrediction p = predict_stability(scene);
  const std::string remedy =
      p.courant_limit > 0.0
          ? fmt::format("must be at most {:.3g} for this integrator, kernel, alpha, nu and delta",
                        p.courant_limit)
          : "no step of this integrator is stable without damping; name "
            "numerics.artificial_viscosity and numerics.density_diffusion, or use kick_drift_kick";
  problems.add("/numerics/courant",
               fmt::format("is {:.6g}; {} (von Neumann analysis: errors would grow by {:.2g} a "
                           "step, 10^{:.2g} over the run)",
                           p.courant, remedy, p.growth_per_step, p.growth_decades));
}

void check_curve(const ReferenceCurve& curve, const std::string& pointer, const Scene& scene,
                 Problems& problems) {
  const auto named = [&](const Sensor& sensor) { return sensor.name == curve.sensor; };
  if (std::none_of(scene.sensors.begin(), scene.sensors.end(), named)) {
    std::vector<std::string_view> names;
    for (const Sensor& sensor : scene.sensors) names.push_back(sensor.name);
    problems.add(at(pointer, "sensor"),
                 fmt::format("is \"{}\", which is no sensor of this scene; {}", curve.sensor,
                             hint(curve.sensor, names)));
  }
  for (std::size_t i = 1; i < curve.time.size(); ++i) {
    if (curve.time[i - 1] < curve.time[i]) continue;
    problems.add(at(at(pointer, "time"), i), fmt::format("is {:.6g} after {:.6g}; times must "
                                                         "increase",
                                                         curve.time[i], curve.time[i - 1]));
    break;
  }
  const auto check_length = [&](std::string_view key, const std::vector<double>& values) {
    if (values.size() == curve.time.size()) return;
    problems.add(at(pointer, key), fmt::format("has {} numbers; must have one for each of the {} "
                                               "times",
                                               values.size(), curve.time.size()));
  };
  check_length("value", curve.value);
  if (!curve.low.empty() || !curve.high.empty()) {
    check_length("low", curve.low);
    check_length("high", curve.high);
  }
}

void check_reference(const WrittenScene& written, Problems& problems) {
  const auto& reference = written.scene.reference;
  if (!reference || !problems.clean({"/reference", "/sensors"})) return;
  const bool scaled = written.scene.scales && falls(written);
  const bool wants_scales = reference->kind == ReferenceKind::experiment ||
                            (reference->kind == ReferenceKind::series &&
                             reference->units == ReferenceUnits::dimensionless);
  if (wants_scales && !scaled) {
    problems.add("/reference",
                 "is dimensionless, but the scene has no scales or no gravity to "
                 "make its series so: add the keys scales and gravity");
  }
  for (std::size_t i = 0; i < reference->curves.size(); ++i) {
    check_curve(reference->curves[i], at("/reference/curves", i), written.scene, problems);
  }
}

}  // namespace

void check(const WrittenScene& written, const CheckedAs& as, Problems& problems,
           Problems& warnings) {
  const Scene& given = written.scene;
  check_insides(given, problems);
  check_sizes(given, problems);
  check_tank(given, problems);
  check_gravity(written, problems);
  check_names(given, problems);
  check_reference(written, problems);
  if (!problems.clean(
          {"/tank", "/fluid", "/obstacles", "/gravity", "/material", "/resolution", "/numerics"})) {
    return;
  }
  const bool placed = problems.clean({"/domain", "/end_time"});
  const Scene scene = resolve(written);
  check_sound_speed(scene, written, problems);
  check_particle_count(scene, problems);
  check_gate(scene, problems);
  check_holding_at_walls(scene.method, RateTerms{}, problems);
  check_shifting(scene, problems);
  if (!placed) return;
  check_domain(scene, written, problems);
  if (problems.clean({"/domain"})) check_sensors(scene, problems);
  if (problems.clean({"/material"})) check_work(scene, problems);
  if (problems.clean({"/material", "/end_time", "/resolution"}) &&
      as.stability == StabilityCheck::refuse) {
    check_stability(scene, problems);
  }
  if (as.origin != SceneOrigin::user || !problems.empty()) return;
  check_solids(scene, problems, warnings);
  check_sensor_places(scene, warnings);
  warn_of_gaps(scene, warnings);
  warn_of_growth(scene, warnings);
  warn_of_slow_sound(scene, warnings);
  warn_of_short_intervals(scene, warnings);
}

}  // namespace sluice

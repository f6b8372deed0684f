#include "engine/scene/checks/warnings.hpp"
#include "engine/scene/geometry/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/forecast/stability.hpp"
#include "engine/scene/forecast/workload.hpp"
#include "engine/scene/format/written_scene.hpp"

namespace sluice {
namespace {

/// A limit with three digits, rounded down: what is written as a limit must keep it.
std::string below(double limit) {
  const double unit = std::pow(10.0, std::floor(std::log10(limit)) - 2);
  return fmt::format("{:.6g}", std::floor(limit / unit * (1 + 1e-12)) * unit);
}

void warn_of_no_damping(const Scene& scene, Problems& warnings) {
  const Method& m = scene.method;
  if (m.viscosity || m.laminar_viscosity || m.diffusion) return;
  warnings.add(
      "/numerics",
      "names neither a viscosity nor density_diffusion: nothing damps what an impact stirs "
      "up, and the energy guard may end the run; name one of artificial_viscosity, "
      "laminar_viscosity and density_diffusion");
}

}  // namespace

void warn_of_growth(const Scene& scene, Problems& warnings) {
  if (!is_beyond_flow_limit(scene)) return warn_of_no_damping(scene, warnings);
  const StabilityPrediction p = predict_stability(scene);
  if (p.outlook != Outlook::stable && p.courant_limit <= 0.0) {
    warnings.add("/numerics", fmt::format("makes errors at rest grow by 10^{:.2g} over the run at "
                                          "any step; name the terms artificial_viscosity and "
                                          "density_diffusion, or write \"scheme\": \"recommended\"",
                                          p.growth_decades));
  } else if (p.outlook != Outlook::stable) {
    warnings.add(
        "/numerics/courant",
        fmt::format("is {:.6g}; errors at rest grow by 10^{:.2g} over the run above {}, "
                    "and an impact may fail above {}; write the latter or less",
                    p.courant, p.growth_decades, below(p.courant_limit), below(p.flow_limit)));
  } else if (p.courant > p.flow_limit) {
    warnings.add("/numerics/courant",
                 fmt::format("is {:.6g}; stable at rest up to {}, but where an impact throws "
                             "particles about it may fail above {}; write that or less",
                             p.courant, below(p.courant_limit), below(p.flow_limit)));
  }
}

void warn_of_slow_sound(const Scene& scene, Problems& warnings) {
  constexpr double kLeast = 5.0;
  constexpr double kUsual = 10.0;
  double speed = std::sqrt(2.0 * scene.method.gravity.norm() * fluid_height(scene));
  for (const FluidRegion& region : scene.fluid) speed = std::max(speed, greatest_speed(region));
  const double c = scene.method.sound_speed;
  if (c >= kLeast * speed * (1 - 1e-9)) return;
  warnings.add("/material/sound_speed",
               fmt::format("is {:.4g} m/s, {:.2g} times the speed that the fluid has or falls to, "
                           "{:.4g} m/s: an impact then compresses it as no liquid is, and the run "
                           "may fail; write {:.4g}, {} times that speed",
                           c, c / speed, speed, kUsual * speed, kUsual));
}

void warn_of_short_intervals(const Scene& scene, Problems& warnings) {
  const double step = expected_time_step(scene);
  std::string first;
  double interval = 0.0;
  std::size_t more = 0;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const Sensor& sensor = scene.sensors[i];
    if (!(sensor.interval > 0.0 && sensor.interval < step)) continue;
    if (first.empty()) {
      first = at(at("/sensors", i), "interval");
      interval = sensor.interval;
    } else {
      ++more;
    }
  }
  if (first.empty()) return;
  warnings.add(first, fmt::format("is {:.3g} s, shorter than a time step of about {:.3g} s: each "
                                  "step is sampled, no more{}; write 0 to say so",
                                  interval, step,
                                  more > 0 ? fmt::format(", as with {} more sensors", more) : ""));
}

}  // namespace sluice

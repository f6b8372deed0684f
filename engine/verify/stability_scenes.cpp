#include "engine/verify/stability_scenes.hpp"

#include <array>
#include <cmath>
#include <string>

#include "engine/scene/format/numerics_json.hpp"
#include "engine/scene/model/scheme.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kProbeDepths{0.25, 0.5, 0.75};

Json pair(const Vec2& vec) { return Json::array({vec.x(), vec.y()}); }

std::string probe_name(std::size_t index) { return "p" + std::to_string(index); }

}  // namespace

Json recommended_scheme() {
  return {{"resolution", {{"smoothing_ratio", 1.5}}},
          {"numerics", numerics_json(method_of(Scheme::recommended))}};
}

Json paper_scheme() {
  return {{"resolution", {{"smoothing_ratio", 1.0}}},
          {"numerics", numerics_json(method_of(Scheme::paper))}};
}

Json scheme_of(const Json& scene) {
  Json scheme{{"numerics", scene.value("numerics", Json::object())}};
  const Json resolution = scene.value("resolution", Json::object());
  if (resolution.contains("smoothing_ratio")) {
    scheme["resolution"]["smoothing_ratio"] = resolution["smoothing_ratio"];
  }
  return scheme;
}

Json with_scheme(Json scene, const Json& scheme) {
  scene.merge_patch(scheme);
  if (scene.contains("tank")) return scene;
  // Shifting conserves no angular momentum: the coarse rotating patch lost 0.003 of its own. Where
  // nothing is hit there is nothing to mend either.
  for (const char* term :
       {"wall_pressure", "wall_artificial_viscosity", "wall_shear", "particle_shifting"}) {
    scene["numerics"].erase(term);
  }
  return scene;
}

Json rectangle(Vec2 corner, Vec2 size) {
  return {{"shape", "rectangle"}, {"corner", pair(corner)}, {"size", pair(size)}};
}

Json circle(Vec2 center, double radius) {
  return {{"shape", "circle"}, {"center", pair(center)}, {"radius", radius}, {"pressure", "zero"}};
}

Json tank_scene(std::string_view name, Vec2 size, Json fluid, double spacing, double sound,
                double end_time) {
  return {{"name", name},
          {"tank", {{"width", size.x()}, {"height", size.y()}}},
          {"fluid", std::move(fluid)},
          {"gravity", {0.0, -kGravity}},
          {"material", {{"sound_speed", sound}}},
          {"resolution", {{"spacing", spacing}}},
          {"sensors", {{{"name", "energy"}, {"kind", "energy"}, {"interval", end_time / 200}}}},
          {"end_time", end_time}};
}

Json in_space(std::string_view name, Json shape, double spacing, double sound, double end_time) {
  shape["pressure"] = "zero";
  return {{"name", name},
          {"fluid", Json::array({std::move(shape)})},
          {"material", {{"sound_speed", sound}}},
          {"resolution", {{"spacing", spacing}}},
          {"sensors", {{{"name", "energy"}, {"kind", "energy"}, {"interval", end_time / 100}}}},
          {"end_time", end_time}};
}

Json still_water(std::string_view name, const StillWater& w) {
  const double wave = std::sqrt(w.gravity * w.depth);
  const double end = w.time * w.depth / wave;
  const Vec2 size = w.depth * Vec2(w.width, 1.0);
  Json scene = tank_scene(name, size.cwiseProduct(Vec2(1.0, 1.3)),
                          Json::array({rectangle(Vec2::Zero(), size)}), w.depth / w.per_depth,
                          w.sound_ratio * wave, end);
  scene["gravity"] = {0.0, -w.gravity};
  scene["material"]["density"] = w.density;
  for (std::size_t i = 0; i < kProbeDepths.size(); ++i) {
    const Vec2 place(0.5 * size.x(), w.depth * (1.0 - kProbeDepths[i]));
    scene["sensors"].push_back({{"name", probe_name(i)},
                                {"kind", "pressure"},
                                {"position", pair(place)},
                                {"interval", end / 200}});
  }
  scene["sensors"].push_back({{"name", "surface"},
                              {"kind", "surface_height"},
                              {"x", 0.5 * size.x()},
                              {"interval", end / 200}});
  return scene;
}

double pressure_error(const CaseRun& run, const StillWater& w, double from) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kProbeDepths.size(); ++i) {
    const Series& probe = run.sensor(probe_name(i));
    for (std::size_t n = 0; n < probe.size(); ++n) {
      if (probe.time[n] < from * run.scene.end_time) continue;
      const double scaled = probe.values[n] / (w.density * w.gravity * w.depth);
      sum += std::pow(scaled - kProbeDepths[i], 2);
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : HUGE_VAL;
}

Json dam_break(std::string_view name, double width, double height, double per_length,
               double end_in_root_h_over_g) {
  const double spacing = std::min(width, height) / per_length;
  const double sound = 10 * std::sqrt(2 * kGravity * height);
  const Vec2 tank(std::max(4 * width, 2 * height), 2 * height);
  return tank_scene(name, tank, Json::array({rectangle(Vec2::Zero(), Vec2(width, height))}),
                    spacing, sound, end_in_root_h_over_g * std::sqrt(height / kGravity));
}

}  // namespace sluice

#include "engine/verify/stability_scenes.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "engine/scene/format/numerics_json.hpp"
#include "engine/scene/model/scheme.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kProbeDepths{0.25, 0.5, 0.75};

Json numbers(const Vec& vec) { return std::vector<double>(vec.begin(), vec.end()); }

/// The first components of a vector of the plane or of space.
Vec of_dimensions(int dimensions, const Vec3& vec) { return vec.head(dimensions); }

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

Json cuboid(const Vec& corner, const Vec& size) {
  return {{"shape", dimensions_of(size) == 3 ? "box" : "rectangle"},
          {"corner", numbers(corner)},
          {"size", numbers(size)}};
}

Json ball(const Vec& center, double radius) {
  return {{"shape", dimensions_of(center) == 3 ? "sphere" : "circle"},
          {"center", numbers(center)},
          {"radius", radius},
          {"pressure", "zero"}};
}

Json tank_scene(std::string_view name, const Vec& size, Json fluid, double spacing, double sound,
                double end_time) {
  const int dimensions = dimensions_of(size);
  Json tank{{"width", size[0]}, {"height", size[1]}};
  if (dimensions == 3) tank["depth"] = size[2];
  return {{"name", name},
          {"dimensions", dimensions},
          {"tank", tank},
          {"fluid", std::move(fluid)},
          {"gravity", numbers(of_dimensions(dimensions, {0.0, -kGravity, 0.0}))},
          {"material", {{"sound_speed", sound}}},
          {"resolution", {{"spacing", spacing}}},
          {"sensors", {{{"name", "energy"}, {"kind", "energy"}, {"interval", end_time / 200}}}},
          {"end_time", end_time}};
}

Json without_tank(std::string_view name, Json shape, double spacing, double sound,
                  double end_time) {
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
  const int dimensions = w.breadth > 0.0 ? 3 : 2;
  const auto sized = [&](double height) {
    return of_dimensions(dimensions, w.depth * Vec3(w.width, height, w.breadth));
  };
  Json scene = tank_scene(name, sized(1.3),
                          Json::array({cuboid(filled_vec<kAnyDim>(0.0, dimensions), sized(1.0))}),
                          w.depth / w.per_depth, w.sound_ratio * wave, end);
  scene["gravity"][1] = -w.gravity;
  scene["material"]["density"] = w.density;
  for (std::size_t i = 0; i < kProbeDepths.size(); ++i) {
    const Vec3 place = w.depth * Vec3(0.5 * w.width, 1.0 - kProbeDepths[i], 0.5 * w.breadth);
    scene["sensors"].push_back({{"name", probe_name(i)},
                                {"kind", "pressure"},
                                {"position", numbers(of_dimensions(dimensions, place))},
                                {"interval", end / 200}});
  }
  Json surface{{"name", "surface"},
               {"kind", "surface_height"},
               {"x", 0.5 * w.depth * w.width},
               {"interval", end / 200}};
  if (dimensions == 3) surface["z"] = 0.5 * w.depth * w.breadth;
  scene["sensors"].push_back(std::move(surface));
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

Json dam_break(std::string_view name, const Vec& column, double per_length,
               double end_in_root_h_over_g) {
  const double width = column[0], height = column[1];
  Vec tank = column;
  tank.head<2>() << std::max(4 * width, 2 * height), 2 * height;
  return tank_scene(name, tank,
                    Json::array({cuboid(filled_vec<kAnyDim>(0.0, dimensions_of(column)), column)}),
                    std::min(width, height) / per_length, 10 * std::sqrt(2 * kGravity * height),
                    end_in_root_h_over_g * std::sqrt(height / kGravity));
}

}  // namespace sluice

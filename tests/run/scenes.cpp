#include "tests/run/scenes.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/scene/checks/parse.hpp"

namespace sluice::testing {
namespace {

using Json = nlohmann::json;

Json numerics_of(const SmallScene& choice) {
  Json numerics{{"integrator", choice.integrator},
                {"precision", choice.precision},
                {"courant", choice.courant},
                {"reinitialisation", {{"interval", 20}}}};
  if (choice.viscous) {
    numerics["density_diffusion"] = {{"kind", "molteni_colagrossi"}, {"delta", 0.1}};
    numerics["artificial_viscosity"] = {{"alpha", 0.02}, {"epsilon", 0.01}};
  }
  return numerics;
}

Json sensors() {
  return Json::parse(R"([
    {"name": "P", "kind": "pressure", "position": [0.4, 0.01], "interval": 0.0005},
    {"name": "H", "kind": "surface_height", "x": 0.2, "interval": 0.003},
    {"name": "front", "kind": "surge_front", "interval": 0.001},
    {"name": "column", "kind": "column_height", "interval": 0.002},
    {"name": "energy", "kind": "energy", "interval": 0},
    {"name": "arrival", "kind": "arrival", "position": [0.4, 0.01], "interval": 0.0005}])");
}

}  // namespace

Scene small_dam_break(const SmallScene& choice) {
  Json scene{{"name", "small"},
             {"tank", {{"width", 0.4}, {"height", 0.3}}},
             {"gravity", {0.0, -9.81}},
             {"material", {{"density", 1000.0}}},
             {"resolution", {{"spacing", 0.0075}}},
             {"numerics", numerics_of(choice)},
             {"sensors", sensors()},
             {"end_time", choice.end_time}};
  scene["fluid"] =
      Json::array({{{"shape", "rectangle"}, {"corner", {0.0, 0.0}}, {"size", {0.15, 0.15}}}});
  if (choice.frames) scene["output"] = {{"frames", {{"interval", 0.01}}}};
  // Some tests want a run that fails.
  ParseResult result = parse_scene(scene.dump(), StabilityCheck::skip, SceneOrigin::job);
  if (result.scene) return *std::move(result.scene);
  std::string problems;
  for (const Problem& problem : result.problems) {
    problems.append(problem.pointer).append(": ").append(problem.message).append("\n");
  }
  throw std::logic_error("the test's scene is invalid: " + problems);
}

}  // namespace sluice::testing

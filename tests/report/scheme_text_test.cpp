#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "engine/report/report_tables.hpp"
#include "engine/scene/checks/parse.hpp"

namespace sluice {
namespace {

std::string scheme_of(const nlohmann::json& numerics) {
  const nlohmann::json scene = {
      {"name", "tank"},
      {"tank", {{"width", 2}, {"height", 1}}},
      {"fluid", {{{"shape", "rectangle"}, {"corner", {0, 0}}, {"size", {1, 0.5}}}}},
      {"gravity", {0, -9.81}},
      {"resolution", {{"spacing", 0.05}}},
      {"numerics", numerics},
      {"end_time", 1}};
  return scheme_text(parse_scene(scene.dump()).scene.value());
}

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(SchemeText, NamesTheTermsWithTheirStrengths) {
  const std::string text = scheme_of({{"scheme", "recommended"},
                                      {"density_diffusion", {{"delta", 0.25}}},
                                      {"artificial_viscosity", {{"alpha", 0.125}, {"beta", 0.5}}},
                                      {"wall_shear", {{"coefficient", 0.0625}}}});
  expect_part(text,
              ", diffusion fourtakas delta 0.25, viscosity alpha 0.125, beta 0.5, wall drag Cf "
              "0.0625, wall pressure clamped, shifting A 2");
  EXPECT_EQ(text.find("free slip"), std::string::npos) << text;
}

TEST(SchemeText, SaysFreeSlipWhereNoTermHoldsTheFluidAtWalls) {
  nlohmann::json numerics = {{"scheme", "paper"}};
  expect_part(scheme_of(numerics),
              ", viscosity alpha 0.02, free slip, reinitialisation every 20 steps");
  numerics["laminar_viscosity"] = {{"nu", 0.001}};
  expect_part(scheme_of(numerics), ", nu 0.001 m^2/s and no slip, reinitialisation");
  numerics["laminar_viscosity"] = nullptr;
  numerics["wall_artificial_viscosity"] = {{"alpha", 0.5}};
  expect_part(scheme_of(numerics), ", wall friction alpha 0.5, reinitialisation");
}

}  // namespace
}  // namespace sluice

#include "engine/scene/checks/parse.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using testing::base_scene;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_at;
using ::testing::Not;
using testing::parse;
using testing::parsed;
using testing::pointers;

TEST(ParseScene, ReadsEachKeyIntoItsMember) {
  const std::string text =
      testing::read_text(testing::source_dir() / "tests/scene/fixtures/valid/every_key.json");
  const ParseResult result = parse_scene(text);
  ASSERT_TRUE(result.scene) << testing::list(result.problems);
  const Scene& s = *result.scene;
  EXPECT_EQ(s.name, "base");
  EXPECT_EQ(s.description, "Wasser, \u6c34, \U0001F30A");
  ASSERT_TRUE(s.tank);
  EXPECT_EQ(s.tank->width, 2);
  EXPECT_EQ(s.tank->height, 1);
  EXPECT_FALSE(s.tank->open_top);

  ASSERT_EQ(s.fluid.size(), 4U);
  EXPECT_EQ(std::get<Rectangle>(s.fluid[0].shape).size, Vec2(0.5, 0.5));
  EXPECT_EQ(s.fluid[0].velocity, Vec2(0.5, 0));
  EXPECT_EQ(s.fluid[0].pressure, InitialPressure::hydrostatic);
  EXPECT_EQ(std::get<Circle>(s.fluid[1].shape).center, Vec2(0.9, 0.8));
  EXPECT_EQ(std::get<Circle>(s.fluid[1].shape).radius, 0.15);
  EXPECT_EQ(s.fluid[1].pressure, InitialPressure::zero);
  EXPECT_EQ(std::get<Ellipse>(s.fluid[2].shape).semi_axes, Vec2(0.2, 0.1));
  EXPECT_EQ(s.fluid[2].velocity, Vec2(0, 0));
  EXPECT_EQ(std::get<Polygon>(s.fluid[3].shape).points[2], Vec2(1.7, 0.4));
  ASSERT_EQ(s.obstacles.size(), 4U);
  EXPECT_EQ(std::get<Ellipse>(s.obstacles[2]).center, Vec2(1.3, 0.5));

  const Method& m = s.method;
  EXPECT_EQ(m.gravity, Vec2(0, -9.81));
  EXPECT_EQ(s.domain.box.min, Vec2(-1, -1));
  EXPECT_EQ(s.domain.box.max, Vec2(3, 2));
  EXPECT_EQ(m.reference_density, 998.2);
  EXPECT_EQ(m.sound_speed, 50);
  EXPECT_EQ(m.spacing, 0.05);
  EXPECT_EQ(m.smoothing_length, 1.3 * 0.05);
  EXPECT_EQ(m.kernel, KernelKind::wendland_c2);
  EXPECT_EQ(m.integrator, Integrator::kick_drift_kick);
  EXPECT_EQ(m.courant, 0.8);
  EXPECT_EQ(m.precision, Precision::double_precision);
  ASSERT_TRUE(m.diffusion && m.viscosity && m.wall_artificial_viscosity && m.reinitialisation);
  EXPECT_EQ(m.diffusion->kind, DiffusionKind::fourtakas);
  EXPECT_EQ(m.diffusion->delta, 0.2);
  EXPECT_EQ(m.viscosity->alpha, 0.05);
  EXPECT_EQ(m.viscosity->epsilon, 0.02);
  EXPECT_EQ(m.viscosity->beta, 0.4);
  EXPECT_EQ(m.wall_artificial_viscosity->alpha, 0.03);
  EXPECT_EQ(m.wall_artificial_viscosity->epsilon, 0.03);
  EXPECT_EQ(m.wall_pressure, WallPressure::clamped);
  EXPECT_EQ(m.reinitialisation->interval, 7);

  ASSERT_EQ(s.sensors.size(), 6U);
  EXPECT_EQ(s.sensors[0].kind, SensorKind::pressure);
  EXPECT_EQ(s.sensors[0].position, Vec2(2, 0.1));
  EXPECT_EQ(s.sensors[0].smoothing_length, 0.1);
  EXPECT_EQ(s.sensors[1].kind, SensorKind::surface_height);
  EXPECT_EQ(s.sensors[1].position.x(), 0.3);
  EXPECT_EQ(s.sensors[2].kind, SensorKind::surge_front);
  EXPECT_EQ(s.sensors[2].interval, 0);
  EXPECT_EQ(s.sensors[3].kind, SensorKind::column_height);
  EXPECT_EQ(s.sensors[3].position.x(), 0.1);
  EXPECT_EQ(s.sensors[4].kind, SensorKind::energy);
  EXPECT_EQ(s.sensors[5].kind, SensorKind::arrival);
  EXPECT_EQ(s.sensors[5].name, "f");
  ASSERT_TRUE(s.frames && s.scales);
  EXPECT_EQ(s.frames->interval, 0.1);
  EXPECT_EQ(s.scales->height, 0.5);
  EXPECT_EQ(s.scales->width, 1);
  EXPECT_EQ(s.end_time, 1);
}

TEST(ParseScene, RefusesWhatFollowsAZeroByte) {
  for (const std::string_view tail : {std::string_view("\0", 1), std::string_view("\0{]", 3)}) {
    const ParseResult result = parse_scene("{}" + std::string(tail));
    EXPECT_FALSE(result.scene);
    ASSERT_EQ(result.problems.size(), 1U);
    EXPECT_NE(result.problems[0].message.find("byte 3: a byte of value zero"), std::string::npos);
  }
}

TEST(ParseScene, LeavesOutWhatHasNoKey) {
  const Scene s = parsed(base_scene());
  EXPECT_FALSE(s.domain.gate);
  EXPECT_TRUE(s.sensors.empty());
  EXPECT_TRUE(s.obstacles.empty());
  EXPECT_FALSE(s.frames || s.scales);
}

TEST(ParseScene, TurnsAGateIntoAWallOfThreeSpacingsThatIsLifted) {
  json text = base_scene();
  text["gate"] = {{"x", 1.0}, {"speed", 3.46}};
  text["numerics"] = {{"scheme", "recommended"}, {"laminar_viscosity", {{"nu", 1e-4}}}};
  const Scene s = parsed(text);
  ASSERT_TRUE(s.gate && s.domain.gate && s.method.laminar_viscosity);
  EXPECT_EQ(s.gate->height, 1.0) << "the tank's";
  EXPECT_EQ(s.domain.gate->place.min, Vec2(1.0, 0.0));
  EXPECT_NEAR(s.domain.gate->place.max.x(), 1.15, 1e-12);
  EXPECT_EQ(s.domain.gate->place.max.y(), 1.0);
  EXPECT_EQ(s.domain.gate->speed, 3.46);
  EXPECT_EQ(s.method.laminar_viscosity->nu, 1e-4);
}

TEST(ParseScene, GivesAnEmptyTermItsDefaults) {
  json text = base_scene();
  text["numerics"] = json::parse(R"({"scheme": "paper", "density_diffusion": {},
      "artificial_viscosity": {}, "wall_artificial_viscosity": {}, "reinitialisation": {}})");
  const Method m = parsed(text).method;
  ASSERT_TRUE(m.diffusion && m.viscosity && m.wall_artificial_viscosity && m.reinitialisation);
  EXPECT_EQ(m.diffusion->delta, 0.1);
  EXPECT_EQ(m.viscosity->alpha, 0.02);
  EXPECT_EQ(m.wall_artificial_viscosity->epsilon, 0.01);
  EXPECT_EQ(m.reinitialisation->interval, 20);
}

TEST(ParseScene, DerivesTheSoundSpeedFromAFallThroughTheFluidsHeight) {
  EXPECT_DOUBLE_EQ(parsed(base_scene()).method.sound_speed, 10 * std::sqrt(2 * 9.81 * 0.5));
}

TEST(ParseScene, CountsTheFluidsHeightFromTheFloorOfTheTank) {
  json text = base_scene();
  text["fluid"][0]["corner"] = {0.5, 0.4};
  EXPECT_DOUBLE_EQ(parsed(text).method.sound_speed, 10 * std::sqrt(2 * 9.81 * 0.9));
  text.erase("tank");
  EXPECT_DOUBLE_EQ(parsed(text).method.sound_speed, 10 * std::sqrt(2 * 9.81 * 0.5));
}

TEST(ParseScene, MeasuresTheHeightAgainstTiltedGravity) {
  // Gravity along the diagonal of a square: from corner to corner, sqrt(2).
  json text = testing::free_scene({{"shape", "rectangle"}, {"corner", {0, 0}}, {"size", {1, 1}}});
  text.erase("material");
  text["gravity"] = {3, 3};
  const double fall = 2 * std::sqrt(18.0) * std::sqrt(2.0);
  EXPECT_DOUBLE_EQ(parsed(text).method.sound_speed, 10 * std::sqrt(fall));
}

TEST(ParseScene, GivesBothKernelsASupportOfThreeSpacings) {
  json text = base_scene();
  EXPECT_DOUBLE_EQ(parsed(text).method.support(), 0.15);
  text["numerics"]["kernel"] = "wendland_c2";
  EXPECT_DOUBLE_EQ(parsed(text).method.support(), 0.15);
}

TEST(ParseScene, GivesAPressureSensorTheScenesSmoothingLength) {
  json text = base_scene();
  text["resolution"]["smoothing_ratio"] = 1.2;
  text["sensors"] =
      json::parse(R"([{"name": "P", "kind": "pressure", "position": [2, 0.1], "interval": 0.01}])");
  EXPECT_EQ(parsed(text).sensors[0].smoothing_length, 1.2 * 0.05);
}

TEST(ParseScene, PutsAColumnHeightAtTheLeftWall) {
  json text = base_scene();
  text["sensors"] = json::parse(R"([{"name": "c", "kind": "column_height", "interval": 0.01}])");
  EXPECT_EQ(parsed(text).sensors[0].position.x(), 0.0);
}

TEST(ParseScene, DrawsADomainAroundTankWallsAndTheRoomAbove) {
  const Box domain = parsed(base_scene()).domain.box;
  EXPECT_LE(domain.min.x(), -0.15);
  EXPECT_LE(domain.min.y(), -0.15);
  EXPECT_GE(domain.max.x(), 2.15);
  EXPECT_GE(domain.max.y(), 1 + 0.5);
}

TEST(ParseScene, DrawsADomainAroundTheWholeFlightOfADrop) {
  // Thrown up at 3 m/s under 9.81 m/s^2 for 1 s: rises by 9/19.62 m, ends 1.905 m below the start.
  json text = testing::free_scene(
      {{"shape", "circle"}, {"center", {0, 0}}, {"radius", 0.2}, {"velocity", {2, 3}}});
  text["gravity"] = {0, -9.81};
  const Box domain = parsed(text).domain.box;
  EXPECT_LT(domain.min.x(), -0.2);
  EXPECT_GT(domain.max.x(), 2.2);
  EXPECT_GT(domain.max.y(), 9 / 19.62 + 0.2);
  EXPECT_LT(domain.min.y(), 3 - 9.81 / 2 - 0.2);
}

TEST(ParseScene, DrawsADomainAroundWhatAStrainedDropReaches) {
  json text = testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 0.2}});
  const Box at_rest = parsed(text).domain.box;
  text["fluid"][0]["strain_rate"] = -5;
  const Box strained = parsed(text).domain.box;
  // The pole moves at |A| R for 1 s.
  EXPECT_GE(strained.max.y(), at_rest.max.y() + 5 * 0.2);
  EXPECT_LE(strained.min.x(), at_rest.min.x() - 5 * 0.2);
}

TEST(ParseScene, RefusesARotationFasterThanSound) {
  json text = base_scene();
  text["fluid"][0]["rotation_rate"] = 1e6;
  const ParseResult result = parse_scene(text.dump());
  ASSERT_EQ(result.problems.size(), 1U);
  EXPECT_EQ(result.problems[0].pointer, "/fluid/0");
}

TEST(ParseScene, MarksTheRimOfAnOpenTankOnly) {
  json text = base_scene();
  EXPECT_EQ(parsed(text).domain.wall_top, 1.0);
  text["tank"]["open_top"] = false;
  EXPECT_FALSE(parsed(text).domain.wall_top);
  EXPECT_FALSE(parsed(testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 1}}))
                   .domain.wall_top);
}

TEST(ParseScene, NamesAllProblemsAtOnce) {
  const ParseResult result = parse_scene(R"({
    "name": "a b",
    "tank": {"width": 1, "height": -0.6, "open_topp": true},
    "fluid": [{"shape": "rectange", "corner": [0, 0]},
              {"shape": "polygon", "points": [[0, 0], [1, 1], [1, 0], [0, 1]]}],
    "gravity": [0, -9.81],
    "resolution": {"spacing": 0.01},
    "numerics": {"kernel": 3, "courant": 3},
    "sensors": [{"name": "P1", "kind": "energy", "interval": 0},
                {"name": "P1", "kind": "energy", "interval": 0}],
    "end_time": "x", "end_time": 2
  })");
  EXPECT_FALSE(result.scene);
  // The second of two equal keys is the one that is read.
  EXPECT_THAT(pointers(result), ElementsAre("/end_time", "/fluid/0/shape", "/fluid/1/points",
                                            "/name", "/numerics/courant", "/numerics/kernel",
                                            "/sensors/1/name", "/tank/height", "/tank/open_topp"));
}

TEST(ParseScene, TellsTheValueTheRangeAndTheUnit) {
  json text = base_scene();
  text["resolution"]["spacing"] = -0.003;
  EXPECT_THAT(message_at(parse(text), "/resolution/spacing"),
              AllOf(HasSubstr("-0.003"), HasSubstr("from 1e-09 to 1e+05 m")));
}

TEST(ParseScene, TellsTheNearestWordAndKey) {
  json text = base_scene();
  text["numerics"]["integrator"] = "kick_drift_kik";
  text["numerics"]["precison"] = "mixed";
  text["Tank"] = text["tank"];
  const ParseResult result = parse(text);
  EXPECT_THAT(message_at(result, "/numerics/integrator"),
              HasSubstr("did you mean \"kick_drift_kick\""));
  EXPECT_THAT(message_at(result, "/numerics/precison"), HasSubstr("did you mean \"precision\""));
  EXPECT_THAT(message_at(result, "/Tank"), HasSubstr("did you mean \"tank\""));
}

TEST(ParseScene, GuessesNoWordThatIsFarFromAll) {
  json text = base_scene();
  text["numerics"]["integrator"] = "euler";
  EXPECT_THAT(message_at(parse(text), "/numerics/integrator"),
              AllOf(Not(HasSubstr("did you mean")), HasSubstr("modified_leap_frog"),
                    HasSubstr("kick_drift_kick")));
}

TEST(ParseScene, EscapesKeysInPointers) {
  json text = base_scene();
  text["a/b~c"] = 1;
  EXPECT_THAT(pointers(parse(text)), ElementsAre("/a~1b~0c"));
}

TEST(ParseScene, FindsADuplicateKeyAtAnyDepth) {
  const ParseResult result = parse_scene(R"({"a": [{"b": 1, "b": 2}]})");
  EXPECT_THAT(message_at(result, "/a/0/b"), HasSubstr("twice"));
}

TEST(ParseScene, AcceptsLengthsThatDifferByRounding) {
  json text = base_scene();
  text["tank"] = {{"width", 0.3}, {"height", 1}};
  text["fluid"] =
      json::parse(R"([{"shape": "rectangle", "corner": [0.1, 0], "size": [0.2, 0.5]}])");
  ASSERT_GT(0.1 + 0.2, 0.3);
  EXPECT_TRUE(parse(text).scene);
}

TEST(ParseScene, AcceptsANumberAtTheEndOfItsRangeAndNoneBeyond) {
  json text = base_scene();
  text["numerics"] = json::parse(R"({"scheme": "paper", "integrator": "kick_drift_kick",
      "density_diffusion": null, "artificial_viscosity": null})");  // stable to C = 2.3
  for (const double courant : {2.0, 1e-6}) {
    text["numerics"]["courant"] = courant;
    EXPECT_TRUE(parse(text).scene) << courant;
  }
  for (const double courant : {std::nextafter(2.0, 3.0), 0.0, -0.0}) {
    text["numerics"]["courant"] = courant;
    EXPECT_THAT(pointers(parse(text)), ElementsAre("/numerics/courant")) << courant;
  }
}

TEST(ParseScene, HoldsTheSoundSpeedAboveTwiceTheGravityWave) {
  json text = base_scene();
  const double wave = std::sqrt(9.81 * 0.5);
  text["material"]["sound_speed"] = 2 * wave;
  EXPECT_THAT(pointers(parse(text)), ElementsAre("/material/sound_speed"));
  text["material"]["sound_speed"] = 2.01 * wave;
  EXPECT_TRUE(parse(text).scene);
}

TEST(ParseScene, AcceptsAPolygonEitherWayRound) {
  for (const char* points : {"[[0, 0], [1, 0], [0, 1]]", "[[0, 1], [1, 0], [0, 0]]"}) {
    const json region = {{"shape", "polygon"}, {"points", json::parse(points)}};
    EXPECT_TRUE(parse(testing::free_scene(region)).scene) << points;
  }
}

}  // namespace
}  // namespace sluice

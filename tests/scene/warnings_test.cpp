// What is refused because fluid would pass through it, and what is only warned of.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/stability.hpp"
#include "engine/scene/work.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::base_scene;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::parse;
using testing::pointers;

// dx = 0.05 m in a tank of 2 m x 1 m with fluid to x = 1 m.
json with_obstacles(const std::string& obstacles) {
  json scene = base_scene();
  scene["obstacles"] = json::parse(obstacles);
  return scene;
}

json rectangle(double x, double y, double width, double height) {
  return {{"shape", "rectangle"}, {"corner", {x, y}}, {"size", {width, height}}};
}

json with_one(const json& obstacle) {
  json scene = base_scene();
  scene["obstacles"] = {obstacle};
  return scene;
}

std::vector<std::string> warned(const json& scene) {
  const ParseResult result = parse(scene);
  EXPECT_TRUE(result.scene) << testing::list(result.problems);
  std::vector<std::string> found;
  for (const Problem& each : result.warnings) found.push_back(each.pointer);
  return found;
}

std::string warning_at(const json& scene, const std::string& pointer) {
  for (const Problem& each : parse(scene).warnings) {
    if (each.pointer == pointer) return each.message;
  }
  return "";
}

/// A plate of this many spacings from the floor to the rim, turned by an angle.
json plate(double spacings, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const double wide = spacings * 0.05 / std::cos(angle);
  const double lean = std::tan(angle);
  const double x = 1.0;
  return {{"shape", "polygon"},
          {"points", {{x, 0}, {x + wide, 0}, {x + wide + 0.5 * lean, 0.5}, {x + 0.5 * lean, 0.5}}}};
}

TEST(ThinSolids, AreRefusedBelowTwoSpacingsAtAnyAngleWithTheSpacingThatWouldDo) {
  for (const double degrees : {-45, -30, 0, 10, 30, 45}) {
    for (const double spacings : {1.1, 1.4, 1.9}) {
      const ParseResult result = parse(with_one(plate(spacings, degrees)));
      EXPECT_THAT(pointers(result), ElementsAre("/obstacles/0")) << spacings << " " << degrees;
    }
    for (const double spacings : {2.0, 2.5, 3.0, 5.0}) {
      EXPECT_TRUE(parse(with_one(plate(spacings, degrees))).scene) << spacings << " " << degrees;
    }
  }
  json scene = with_one(rectangle(1.3, 0, 0.07, 1));
  EXPECT_THAT(testing::message_at(parse(scene), "/obstacles/0"),
              ::testing::AllOf(HasSubstr("0.07 m, 1.4 spacings"), HasSubstr("0.1 m thick"),
                               HasSubstr("0.0348 m")));
  scene["resolution"]["spacing"] = 0.0348;
  EXPECT_TRUE(parse(scene).scene) << "the spacing that it names";
}

TEST(ThinSolids, AreRefusedWhateverTheirShape) {
  EXPECT_FALSE(parse(with_obstacles(R"([{"shape": "circle", "center": [1.5, 0.5],
                                         "radius": 0.04}])"))
                   .scene);
  EXPECT_FALSE(parse(with_obstacles(R"([{"shape": "ellipse", "center": [1.5, 0.5],
                                         "semi_axes": [0.3, 0.04]}])"))
                   .scene);
  EXPECT_FALSE(parse(with_obstacles(R"([{"shape": "polygon", "points": [[1.2, 0], [1.8, 0],
      [1.8, 0.3], [1.53, 0.3], [1.53, 0.8], [1.47, 0.8], [1.47, 0.3], [1.2, 0.3]]}])"))
                   .scene)
      << "a thick foot with a thin mast";
}

TEST(ThinSolids, MayLieAgainstAWallOrOneAnother) {
  EXPECT_TRUE(parse(with_one(rectangle(1.2, 0, 0.5, 0.05))).scene) << "on the floor";
  EXPECT_TRUE(parse(with_one(rectangle(1.95, 0, 0.05, 0.5))).scene) << "at the wall";
  json two = base_scene();
  two["obstacles"] = {rectangle(1.3, 0, 0.05, 0.6), rectangle(1.35, 0, 0.05, 0.6)};
  EXPECT_TRUE(parse(two).scene) << "side by side";
}

TEST(ThinSolids, MayTaperAtCornersAndEdges) {
  EXPECT_TRUE(parse(with_obstacles(R"([{"shape": "polygon",
      "points": [[1.2, 0.2], [1.8, 0.2], [1.5, 0.9]]}])"))
                  .scene);
  EXPECT_TRUE(parse(with_obstacles(R"([{"shape": "polygon",
      "points": [[1.1, 0.4], [1.9, 0.2], [1.9, 0.6]]}])"))
                  .scene)
      << "a wedge";
}

TEST(ThinSolids, OfJobsThatWereTakenBeforeAreNoProblem) {
  EXPECT_TRUE(parse_job_scene(with_one(plate(1.4, 0)).dump()).scene);
}

TEST(Warnings, NameBodiesWithFewParticlesAcross) {
  EXPECT_THAT(warned(with_one(rectangle(1.3, 0, 0.45, 0.6))), ElementsAre("/obstacles/0"));
  EXPECT_THAT(warned(with_one(rectangle(1.3, 0, 0.5, 0.6))), IsEmpty()) << "ten";
  EXPECT_THAT(warned(with_one(rectangle(1.1, 0, 0.6, 0.2))), IsEmpty()) << "a step in the floor";
}

TEST(Warnings, NameSlits) {
  json scene = base_scene();
  scene["obstacles"] = {rectangle(1.2, 0.07, 0.55, 0.5)};
  EXPECT_THAT(warning_at(scene, "/obstacles/0"), HasSubstr("slit of 0.07 m, 1.4 spacings"));
  scene["obstacles"] = {rectangle(1.2, 0.1, 0.55, 0.5)};
  EXPECT_THAT(warned(scene), IsEmpty());
  scene["obstacles"] = {rectangle(1.4, 0, 0.55, 0.6)};
  EXPECT_THAT(warned(scene), ElementsAre("/obstacles/0")) << "one spacing from the wall";
  EXPECT_THAT(warned(with_obstacles(R"([{"shape": "circle", "center": [1.4, 0.3],
                                         "radius": 0.3}])")),
              IsEmpty())
      << "stands on the floor";
}

json with_sensor(const std::string& sensor) {
  json scene = with_one(rectangle(1.2, 0, 0.5, 0.6));
  scene["sensors"] = {json::parse(sensor)};
  scene["sensors"][0]["interval"] = 0.01;
  scene["sensors"][0]["name"] = "s";
  return scene;
}

TEST(Warnings, NameSensorsWhereNoFluidCanBe) {
  for (const char* place : {"[1.45, 0.3]", "[2.05, 0.1]", "[-0.05, 0.3]", "[0.5, -0.04]"}) {
    for (const char* kind : {"pressure", "arrival"}) {
      const json scene =
          with_sensor(std::string(R"({"kind": ")") + kind + R"(", "position": )" + place + "}");
      EXPECT_THAT(warned(scene), ElementsAre("/sensors/0/position")) << place;
    }
  }
  EXPECT_THAT(warned(with_sensor(R"({"kind": "surface_height", "x": 2.05})")),
              ElementsAre("/sensors/0/x"));
  json full = with_sensor(R"({"kind": "surface_height", "x": 1.45})");
  EXPECT_THAT(warned(full), IsEmpty()) << "above the obstacle";
  full["obstacles"][0]["size"][1] = 1;
  EXPECT_THAT(warned(full), ElementsAre("/sensors/0/x"));
}

TEST(Warnings, NameNoSensorOnAFace) {
  for (const char* place : {"[2, 0.1]", "[2.02, 0.1]", "[0, 0]", "[0.5, 0]", "[1.2, 0.3]",
                            "[1.2000000001, 0.3]", "[1.5, 0.6]", "[0.5, 0.3]", "[0.5, 1.2]"}) {
    const json scene =
        with_sensor(std::string(R"({"kind": "pressure", "position": )") + place + "}");
    EXPECT_THAT(warned(scene), IsEmpty()) << place;
  }
}

TEST(Warnings, NameIntervalsShorterThanAStepOnce) {
  json scene = base_scene();
  scene["sensors"] = json::parse(R"([{"name": "a", "kind": "energy", "interval": 1e-6},
      {"name": "b", "kind": "energy", "interval": 0}, {"name": "c", "kind": "energy",
      "interval": 1e-6}, {"name": "d", "kind": "energy", "interval": 0.1}])");
  EXPECT_THAT(warned(scene), ElementsAre("/sensors/0/interval"));
  EXPECT_THAT(warning_at(scene, "/sensors/0/interval"), HasSubstr("as with 1 more"));
}

TEST(Warnings, NameAGapBetweenRegionsBelowASpacing) {
  json scene = base_scene();
  const auto with_gap = [&](double gap) {
    scene["fluid"] = {rectangle(0, 0, 1, 0.5), rectangle(1 + gap, 0, 0.5, 0.5)};
    return warned(scene);
  };
  EXPECT_THAT(with_gap(0.02), ElementsAre("/fluid/1"));
  EXPECT_THAT(warning_at(scene, "/fluid/1"), HasSubstr("0.4 spacings, to /fluid/0"));
  EXPECT_THAT(with_gap(0.0), IsEmpty()) << "they touch";
  EXPECT_THAT(with_gap(0.05), IsEmpty()) << "a spacing apart";
  scene["fluid"] = {rectangle(0, 0, 1, 0.3), rectangle(0, 0.3, 0.7, 0.2),
                    rectangle(0.7, 0.3, 0.3, 0.2)};
  EXPECT_THAT(warned(scene), IsEmpty()) << "corners of regions that touch";
  scene["fluid"] = {rectangle(0, 0, 2, 0.3),
                    {{"shape", "circle"}, {"center", {1, 0.5}}, {"radius", 0.2}}};
  EXPECT_THAT(warned(scene), IsEmpty()) << "a drop that touches a pool";
}

TEST(Warnings, NameACourantNumberBeyondWhatAnImpactLeaves) {
  EXPECT_THAT(warned(base_scene()), IsEmpty()) << "C = 1 of the recommended scheme";
  json scene = base_scene();
  const StabilityPrediction p = predict_stability(*parse(scene).scene);
  // 0.74 of the limit at rest for Wendland C2 at h = 1.5 dx (limits-in-disorder).
  EXPECT_NEAR(p.flow_limit, 0.74 * p.courant_limit, 1e-12);
  scene["numerics"]["courant"] = 0.99 * p.flow_limit;
  EXPECT_THAT(warned(scene), IsEmpty());
  scene["numerics"]["courant"] = 1.01 * p.flow_limit;
  EXPECT_THAT(warned(scene), ElementsAre("/numerics/courant"));
}

TEST(Warnings, NameAnOutlookThatIsNotStable) {
  json scene = base_scene();
  scene["numerics"] = json::parse(R"({"scheme": "paper", "density_diffusion": null,
                                      "artificial_viscosity": null})");
  scene["end_time"] = 0.1;
  EXPECT_THAT(warned(scene), ElementsAre("/numerics"));
  EXPECT_THAT(warning_at(scene, "/numerics"), HasSubstr("recommended"));
}

TEST(Warnings, TheExamplesHaveNoneButOfIntervals) {
  for (const auto& path : testing::json_files(testing::source_dir() / "schemas/examples")) {
    for (const Problem& each : parse_scene(testing::read_text(path)).warnings) {
      EXPECT_EQ(each.pointer, "/sensors/0/interval") << path << ": " << each.message;
    }
  }
}

}  // namespace
}  // namespace sluice

// What is refused because fluid would pass through it, and what is only warned of.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/forecast/stability.hpp"
#include "engine/scene/forecast/workload.hpp"
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

json polygon(const std::vector<std::pair<double, double>>& points) {
  json corners = json::array();
  for (const auto& [x, y] : points) corners.push_back({x, y});
  return {{"shape", "polygon"}, {"points", corners}};
}

std::string problem_of(const json& obstacle) {
  return testing::message_at(parse(with_one(obstacle)), "/obstacles/0");
}

TEST(ThinSolids, AreNoThickBlocksWhateverTheAngleOfTheirCorners) {
  // A corner of 80 degrees is 1 spacing thick 0.18 spacings from its tip.
  for (const double skew : {1, 3, 5, 6, 8, 10, 15, 30, 45}) {
    for (const double spacing : {0.05, 0.04, 0.03, 0.02}) {
      const double lean = 0.6 * std::tan(skew * std::numbers::pi / 180);
      json scene =
          with_one(polygon({{1.1, 0.2}, {1.3, 0.2}, {1.3 + lean, 0.8}, {1.1 + lean, 0.8}}));
      scene["resolution"]["spacing"] = spacing;
      EXPECT_TRUE(parse(scene).scene) << skew << " " << spacing;
    }
  }
  for (int degrees = 0; degrees < 360; degrees += 7) {
    const double a = degrees * std::numbers::pi / 180;
    std::vector<std::pair<double, double>> corners;
    for (const auto& [x, y] : {std::pair(-0.3, -0.3), {0.3, -0.3}, {0.25, 0.3}, {-0.25, 0.3}}) {
      corners.emplace_back(1.5 + x * std::cos(a) - y * std::sin(a),
                           0.5 + x * std::sin(a) + y * std::cos(a));
    }
    EXPECT_TRUE(parse(with_one(polygon(corners))).scene) << "a trapezium turned by " << degrees;
  }
}

TEST(ThinSolids, AreNoRampsForTheFloorIsBelow) {
  for (const double slope : {2.0, 4.0, 6.0, 8.5, 10.0, 20.0, 45.0}) {
    const double top = 0.8 * std::tan(slope * std::numbers::pi / 180);
    if (top < 0.05) continue;  // lower than a spacing: another rule
    EXPECT_EQ(problem_of(polygon({{1.1, 0}, {1.9, 0}, {1.9, top}})), "") << slope;
  }
  EXPECT_EQ(problem_of(polygon({{1.1, 0}, {1.9, 0}, {1.5, 0.06}})), "") << "a sill";
}

TEST(ThinSolids, AreNoTipsRoundWhichFluidFlows) {
  // 2 spacings thick at 1/tan(angle/2) spacings from the tip.
  const auto wedge = [](double degrees) {
    const double half = 0.5 * std::tan(0.5 * degrees * std::numbers::pi / 180);
    return polygon({{1.2, 0.5}, {1.7, 0.5 - half}, {1.7, 0.5 + half}});
  };
  for (const double degrees : {20, 25, 30, 45, 60})
    EXPECT_EQ(problem_of(wedge(degrees)), "") << degrees;
  for (const double degrees : {12, 14}) {
    EXPECT_THAT(problem_of(wedge(degrees)), HasSubstr("does not mend it")) << degrees;
  }
}

TEST(ThinSolids, AreRefusedWhereATipTouchesTheFloor) {
  EXPECT_THAT(problem_of(polygon({{1.5, 0}, {1.75, 1}, {1.25, 1}})), HasSubstr("does not mend it"));
  EXPECT_NE(problem_of(polygon({{1.5, 0}, {1.58, 0.5}, {1.5, 1}, {1.42, 0.5}})), "");
  EXPECT_NE(problem_of({{"shape", "ellipse"}, {"center", {1.5, 0.5}}, {"semi_axes", {0.07, 0.5}}}),
            "");
  EXPECT_EQ(problem_of({{"shape", "circle"}, {"center", {1.5, 0.4}}, {"radius", 0.4}}), "")
      << "where no particle comes near the point at which it touches";
}

TEST(ThinSolids, AreRefusedForTheirNecks) {
  // A neck of 0.4 spacings in a block of 12; of 3 spacings it is thick.
  const auto hourglass = [](double neck) {
    return polygon(
        {{1.2, 0}, {1.8, 0}, {1.5 + neck / 2, 0.3}, {1.8, 0.9}, {1.2, 0.9}, {1.5 - neck / 2, 0.3}});
  };
  const std::string message = problem_of(hourglass(0.02));
  EXPECT_EQ(problem_of(hourglass(0.15)), "");
  const std::string before = "lower /resolution/spacing to ";
  const std::size_t start = message.find(before);
  ASSERT_NE(start, std::string::npos) << message;
  json scene = with_one(hourglass(0.02));
  scene["resolution"]["spacing"] = std::stod(message.substr(start + before.size()));
  EXPECT_TRUE(parse(scene).scene) << "the spacing that it names";
}

TEST(ThinSolids, AreBlocksThatTouchWithCornersOnly) {
  json scene = base_scene();
  scene["obstacles"] = {rectangle(1.2, 0, 0.3, 0.4), rectangle(1.5, 0.4, 0.3, 0.6)};
  EXPECT_THAT(pointers(parse(scene)), ElementsAre("/obstacles/0", "/obstacles/1"));
  scene["obstacles"][0] = rectangle(1.2, 0, 0.4, 0.5);
  EXPECT_TRUE(parse(scene).scene) << "overlapping by two spacings";
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

TEST(Warnings, NameSlitsBetweenRoundBodies) {
  const auto circles = [](double gap) {
    json scene = base_scene();
    for (const double x : {1.2 - 0.26 - gap / 2, 1.2 + 0.26 + gap / 2}) {
      scene["obstacles"].push_back({{"shape", "circle"}, {"center", {x, 0.5}}, {"radius", 0.26}});
    }
    return scene;
  };
  EXPECT_THAT(warned(circles(0.05)), ElementsAre("/obstacles/0", "/obstacles/1"));
  EXPECT_THAT(warning_at(circles(0.05), "/obstacles/0"), HasSubstr("m, 1 spacings"));
  EXPECT_THAT(warned(circles(0.1)), IsEmpty());
}

TEST(Warnings, TakeNoCornerBelowALeaningSideForASlit) {
  for (const double degrees : {2, 5, 10, 20}) {
    const double lean = 0.6 * std::tan(degrees * std::numbers::pi / 180);
    EXPECT_THAT(
        warned(with_one(polygon({{1.1, 0}, {1.65, 0}, {1.65 + lean, 0.6}, {1.1 + lean, 0.6}}))),
        IsEmpty())
        << degrees;
  }
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

TEST(Warnings, NameSensorsBetweenABlockAndWhatItTouches) {
  json scene = base_scene();
  scene["obstacles"] = {rectangle(1.1, 0, 0.3, 0.5), rectangle(1.4, 0, 0.6, 0.5)};
  scene["sensors"] = {{{"kind", "pressure"}, {"name", "s"}, {"interval", 0.01}}};
  for (const json& place : {json{1.4, 0.3}, {1.25, 0}, {2, 0.25}, {1.4, 0}}) {
    scene["sensors"][0]["position"] = place;
    EXPECT_THAT(warned(scene), ElementsAre("/sensors/0/position")) << place;
  }
  for (const json& place : {json{1.4, 0.5}, {1.1, 0}, {2, 0.5}}) {
    scene["sensors"][0]["position"] = place;
    EXPECT_THAT(warned(scene), IsEmpty()) << place;
  }
  scene["sensors"][0]["position"] = {1.4, 0.3};
  EXPECT_THAT(warning_at(scene, "/sensors/0/position"), HasSubstr("0.2 m deep in an obstacle"));
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

TEST(Warnings, NameASchemeThatDampsNothing) {
  json scene = base_scene();
  scene["end_time"] = 0.1;
  for (const char* key : {"density_diffusion", "artificial_viscosity"}) {
    scene["numerics"][key] = nullptr;
  }
  EXPECT_THAT(warning_at(scene, "/numerics"), HasSubstr("nothing damps"));
  scene["numerics"].erase("density_diffusion");
  EXPECT_THAT(warned(scene), IsEmpty());
}

TEST(Warnings, NameASoundThatIsNotMuchFasterThanTheFluid) {
  json scene = base_scene();
  const double c = parse(scene).scene->method.sound_speed;  // ten times the speed of a fall
  scene["material"]["sound_speed"] = 0.51 * c;
  EXPECT_THAT(warned(scene), IsEmpty());
  scene["material"]["sound_speed"] = 0.49 * c;
  EXPECT_THAT(warned(scene), ElementsAre("/material/sound_speed"));
  scene["material"].erase("sound_speed");
  scene["fluid"][0]["velocity"] = {0.21 * c, 0.0};
  EXPECT_THAT(warned(scene), ElementsAre("/material/sound_speed"));
  scene["material"]["sound_speed"] = 2.1 * c;
  EXPECT_THAT(warned(scene), IsEmpty());
}

TEST(Warnings, TheExamplesHaveNoneButOfIntervalsAndACoarseBox) {
  for (const auto& path : testing::json_files(testing::source_dir() / "schemas/examples")) {
    // As coarse as others have computed it, and fine beside it.
    const bool coarse = path.stem() == "spheric2";
    for (const Problem& each : testing::parse_file(path).warnings) {
      EXPECT_EQ(each.pointer, coarse ? "/obstacles/0" : "/sensors/0/interval")
          << path << ": " << each.message;
    }
  }
}

}  // namespace
}  // namespace sluice

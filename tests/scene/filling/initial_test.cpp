#include "engine/scene/filling/initial.hpp"
#include "engine/scene/geometry/geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/filling/walls.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::base_scene;
using testing::free_scene;
using ::testing::HasSubstr;
using testing::parsed;

Scene example(const std::string& name) {
  const auto path = testing::source_dir() / "schemas/examples" / (name + ".json");
  return parsed(json::parse(testing::read_text(path)));
}

json region(const char* text) { return json::parse(text); }

std::vector<Vec2> positions(const Particles& particles) {
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < particles.size(); ++i) result.push_back(particles.position_of(i));
  return result;
}

TEST(InitialParticles, StandBehindAGateOfThreeLayersOfWallParticles) {
  json text = base_scene();
  const std::size_t without = create_particles(parsed(text)).walls.size();
  text["gate"] = {{"x", 1.0}, {"height", 0.6}, {"speed", 3.46}};
  const Scene scene = parsed(text);
  const InitialParticles made = create_particles(scene);
  EXPECT_EQ(made.state.particles.size(), 200U) << "the column touches the gate, no more";
  ASSERT_EQ(made.walls.size(), without + 3 * 12);
  for (std::size_t i = 0; i < made.walls.size(); ++i) {
    EXPECT_EQ(scene.domain.gate->place.contains(made.walls[i]), i >= without);
  }
  EXPECT_GT(testing::smallest_distance(made.walls), 0.049);
}

TEST(InitialParticles, FillThePapersColumnWith200By100) {
  const Particles p = create_particles(example("dambreak-paper")).state.particles;
  ASSERT_EQ(p.size(), 20000U);
  EXPECT_DOUBLE_EQ(p.position[0].front(), 0.0015);
  EXPECT_DOUBLE_EQ(p.position[1].front(), 0.0015);
  EXPECT_DOUBLE_EQ(p.position[0][199], 0.5985);
  EXPECT_DOUBLE_EQ(p.position[1][200], 0.0045);
  EXPECT_DOUBLE_EQ(p.position[0].back(), 0.5985);
  EXPECT_DOUBLE_EQ(p.position[1].back(), 0.2985);
}

TEST(InitialParticles, FillTheCoarseColumnWithAbout7600) {
  // round(0.6/0.00487) round(0.3/0.00487) = 123 x 62.
  EXPECT_EQ(create_particles(example("dambreak-paper-coarse")).state.particles.size(), 7626U);
}

TEST(InitialParticles, FillNothingButWhatTheSolverIsPromised) {
  const SolverState state = create_particles(parsed(base_scene())).state;
  EXPECT_EQ(state.step, 0U);
  EXPECT_EQ(state.time, 0.0);
  EXPECT_TRUE(state.removed.empty());
  for (const Field& field : fields_in(2)) {
    const std::vector<double>& values = field.values.of(state.particles);
    const bool filled = field.name == "x" || field.name == "y" || field.name == "vx" ||
                        field.name == "vy" || field.name == "density_excess" || field.name == "id";
    EXPECT_EQ(values.size(), filled ? 200U : 0U) << field.name;
  }
}

TEST(InitialParticles, AreNumberedInOrderOverAllRegions) {
  json text = base_scene();
  text["fluid"].push_back(region(R"({"shape": "circle", "center": [1.5, 0.5], "radius": 0.2})"));
  const Particles p = create_particles(parsed(text)).state.particles;
  ASSERT_GT(p.size(), 200U);
  for (std::size_t i = 0; i < p.size(); ++i) ASSERT_EQ(p.id[i], static_cast<double>(i));
}

TEST(InitialParticles, StartWithTheirRegionsVelocity) {
  json text = base_scene();
  text["fluid"].push_back(
      region(R"({"shape": "circle", "center": [1.5, 0.5], "radius": 0.2, "velocity": [-1, 2]})"));
  const Particles p = create_particles(parsed(text)).state.particles;
  EXPECT_EQ(p.velocity_of(0), Vec2(0, 0));
  EXPECT_EQ(p.velocity_of(199), Vec2(0, 0));
  EXPECT_EQ(p.velocity_of(200), Vec2(-1, 2));
}

TEST(InitialParticles, AreStrainedAndTurnedAboutTheMiddleOfTheirRegion) {
  json text = base_scene();
  text["material"]["sound_speed"] = 50;
  text["fluid"].push_back(region(
      R"({"shape": "rectangle", "corner": [1.25, 0.25], "size": [0.5, 0.3], "velocity": [-1, 2],
          "strain_rate": 3, "rotation_rate": 4})"));
  const Scene scene = parsed(text);
  const Particles p = create_particles(scene).state.particles;
  ASSERT_GT(p.size(), 200U);
  for (std::size_t i = 200; i < p.size(); ++i) {
    const double x = p.position[0][i] - 1.5;
    const double y = p.position[1][i] - 0.4;
    EXPECT_NEAR(p.velocity[0][i], -1 + 3 * x - 4 * y, 1e-12);
    EXPECT_NEAR(p.velocity[1][i], 2 - 3 * y + 4 * x, 1e-12);
    EXPECT_LE(p.velocity_of(i).norm(), greatest_speed(scene.fluid[1]));
  }
  EXPECT_EQ(p.velocity_of(0), Vec2(0, 0));
}

TEST(InitialParticles, StartWithTheDensityOfWaterAtRest) {
  // rho - rho_0 = rho_0 g (top - y) / c^2.
  const Scene scene = parsed(base_scene());
  const Particles p = create_particles(scene).state.particles;
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(p.density_excess[i], 1000 * 9.81 * (0.5 - p.position[1][i]) / c2, 1e-12);
  }
}

TEST(InitialParticles, FeelGravityAcrossAndUpwards) {
  json text = base_scene();
  text["gravity"] = {3, 4};  // deepest at the upper right, free of pressure at the lower left
  const Scene scene = parsed(text);
  const Particles p = create_particles(scene).state.particles;
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(p.density_excess[i], 1000 * (3 * p.position[0][i] + 4 * p.position[1][i]) / c2,
                1e-12);
  }
}

TEST(InitialParticles, HaveNoExcessWithoutPressureOrGravity) {
  json text = base_scene();
  text["fluid"][0]["pressure"] = "zero";
  const json drop = region(R"({"shape": "circle", "center": [1, 1], "radius": 0.5})");
  for (const json& each : {text, free_scene(drop)}) {
    for (const double excess : create_particles(parsed(each)).state.particles.density_excess) {
      ASSERT_EQ(excess, 0.0);
    }
  }
}

TEST(InitialParticles, HaveNoNegativePressureUnderACurvedTop) {
  json text =
      free_scene(region(R"({"shape": "ellipse", "center": [1, 1], "semi_axes": [0.5, 0.3]})"));
  text["gravity"] = {-2, -9};
  for (const double excess : create_particles(parsed(text)).state.particles.density_excess) {
    ASSERT_GE(excess, 0.0);
  }
}

TEST(InitialParticles, CoverAShapesAreaToOneRowAlongItsOutline) {
  const char* shapes[] = {
      R"({"shape": "circle", "center": [0.31, 0.17], "radius": 1})",
      R"({"shape": "ellipse", "center": [-3.3, 2.2], "semi_axes": [1.5, 0.5]})",
      R"({"shape": "polygon", "points": [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]})",
      R"({"shape": "polygon", "points": [[0, 0], [2, 0.3], [3, 2], [1, 0.9]]})"};
  const double areas[] = {std::numbers::pi, 0.75 * std::numbers::pi, 3.0, 1.9};
  const double outlines[] = {2 * std::numbers::pi, 6.7, 8.0, 7.0};
  for (int i = 0; i < 4; ++i) {
    const auto count =
        create_particles(parsed(free_scene(region(shapes[i])))).state.particles.size();
    // A cell that the outline crosses may count or not.
    EXPECT_NEAR(static_cast<double>(count) * 0.05 * 0.05, areas[i], outlines[i] * 0.05 / 2) << i;
  }
}

TEST(InitialParticles, LieOnTheLatticeOfTheOriginInACircle) {
  const json drop = region(R"({"shape": "circle", "center": [0.013, 0.017], "radius": 0.5})");
  const Particles p = create_particles(parsed(free_scene(drop))).state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_LE((p.position_of(i) - Vec2(0.013, 0.017)).norm(), 0.5);
    const Vec2 cells = p.position_of(i) / 0.05 - Vec2(0.5, 0.5);
    EXPECT_NEAR(cells.x(), std::round(cells.x()), 1e-9);
    EXPECT_NEAR(cells.y(), std::round(cells.y()), 1e-9);
  }
}

TEST(InitialParticles, OfRegionsSideBySideAreNoOverlap) {
  json text = base_scene();
  // 0.27 m is 5.4 cells: the first region stands short of the second one's corner.
  text["fluid"] = json::parse(R"([
      {"shape": "rectangle", "corner": [0, 0], "size": [0.27, 0.5]},
      {"shape": "rectangle", "corner": [0.27, 0], "size": [0.5, 0.5]}])");
  const auto points = positions(create_particles(parsed(text)).state.particles);
  EXPECT_EQ(points.size(), 54U + 100U) << "each region's area";
  EXPECT_GE(testing::smallest_distance(points), 0.5 * 0.05);
}

TEST(InitialParticles, OfOverlappingRegionsAreRefusedByName) {
  json text = base_scene();
  text["fluid"].push_back(region(R"({"shape": "circle", "center": [1.1, 0.3], "radius": 0.2})"));
  try {
    (void)create_particles(parsed(text));
    FAIL() << "two regions overlap";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.problem().pointer, "/fluid/1");
    EXPECT_THAT(error.problem().message, HasSubstr("overlaps /fluid/0"));
  }
}

TEST(InitialParticles, OfARegionWithinAnotherAreRefused) {
  json text = base_scene();
  // Half a cell off the other's lattice both ways, where no two particles come close.
  text["fluid"].push_back(
      region(R"({"shape": "rectangle", "corner": [0.225, 0.225], "size": [0.1, 0.1]})"));
  EXPECT_THROW((void)create_particles(parsed(text)), SceneError);
}

TEST(InitialParticles, GiveWayToRoundObstacles) {
  json text = base_scene();
  text["obstacles"] = json::parse(R"([{"shape": "circle", "center": [0.5, 0.25], "radius": 0.1}])");
  const Particles p = create_particles(parsed(text)).state.particles;
  EXPECT_EQ(p.size(), 187U) << "200 - pi 2^2 = 187.4";
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_GT((p.position_of(i) - Vec2(0.5, 0.25)).norm(), 0.1);
  }
}

TEST(InitialParticles, StayHalfASpacingAboveAFlatObstacle) {
  json text = base_scene();
  text["obstacles"] =
      json::parse(R"([{"shape": "rectangle", "corner": [0.2, 0], "size": [0.3, 0.1]}])");
  EXPECT_EQ(create_particles(parsed(text)).state.particles.size(), 200U - 6U * 2U);
}

TEST(InitialParticles, AreMissedWhereAnObstacleTakesAWholeRegion) {
  json text = base_scene();
  text["obstacles"] =
      json::parse(R"([{"shape": "rectangle", "corner": [0, 0], "size": [1.2, 0.6]}])");
  EXPECT_THROW((void)create_particles(parsed(text)), SceneError);
}

TEST(InitialParticles, AreDisplacedByJitterWithinItsAmplitudeAndByItsSeed) {
  json text = base_scene();
  const Particles lattice = create_particles(parsed(text)).state.particles;
  text["perturbation"] = {{"amplitude", 0.1}, {"seed", 1}};
  const Particles first = create_particles(parsed(text)).state.particles;
  EXPECT_EQ(create_particles(parsed(text)).state.particles.position[0], first.position[0]);
  text["perturbation"]["seed"] = 2;
  const Particles second = create_particles(parsed(text)).state.particles;

  ASSERT_EQ(first.size(), lattice.size());
  double mean = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const Vec2 moved = (first.position_of(i) - lattice.position_of(i)) / 0.05;
    EXPECT_LE(moved.cwiseAbs().maxCoeff(), 0.1 + 1e-12);
    EXPECT_NE(first.position[0][i], second.position[0][i]);
    mean += moved.sum() / (2.0 * static_cast<double>(lattice.size()));
    largest = std::max(largest, moved.cwiseAbs().maxCoeff());
  }
  // A uniform variable: mean 0 to four standard errors, and nearly all of the range is used.
  EXPECT_LT(std::abs(mean), 4.0 * 0.1 / std::sqrt(3.0 * 2.0 * static_cast<double>(lattice.size())));
  EXPECT_GT(largest, 0.095);
}

json rectangle_of(double x, double y, double width, double height) {
  return {{"shape", "rectangle"}, {"corner", {x, y}}, {"size", {width, height}}};
}

/// Largest difference between a scene's start and rho_0 g (level(x) - y), Pa.
template <class Level>
double off_hydrostatic(const json& text, const Level& level) {
  const Scene scene = parsed(text);
  const Particles p = create_particles(scene).state.particles;
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  double most = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double right = 9810.0 * (level(p.position[0][i]) - p.position[1][i]);
    most = std::max(most, std::abs(c2 * p.density_excess[i] - right));
  }
  return most;
}

TEST(InitialPressure, OfStackedRegionsCountsFromTheUppermostLevel) {
  json text = base_scene();
  text["fluid"] = {rectangle_of(0, 0, 2, 0.2), rectangle_of(0, 0.2, 2, 0.2),
                   rectangle_of(0, 0.4, 2, 0.2)};
  EXPECT_LT(off_hydrostatic(text, [](double) { return 0.6; }), 1e-6);
}

TEST(InitialPressure, OfAColumnBesideABedIsEachsOwn) {
  json text = base_scene();
  text["fluid"] = {rectangle_of(0, 0, 1, 0.5), rectangle_of(1, 0, 1, 0.1)};
  const auto level = [](double x) { return x < 1 ? 0.5 : 0.1; };
  EXPECT_LT(off_hydrostatic(text, level), 1e-6);
  text["fluid"] = {rectangle_of(0, 0, 2, 0.1), rectangle_of(0, 0.1, 1, 0.4)};
  EXPECT_LT(off_hydrostatic(text, level), 1e-6) << "the bed reaches below the column";
}

TEST(InitialPressure, BelowAnObstacleIsThatOfTheArmsBesideIt) {
  json text = base_scene();
  text["fluid"] = {rectangle_of(0, 0, 0.7, 0.2), rectangle_of(0.7, 0, 0.6, 0.2),
                   rectangle_of(1.3, 0, 0.7, 0.2), rectangle_of(0, 0.2, 0.5, 0.4),
                   rectangle_of(1.5, 0.2, 0.5, 0.4)};
  text["obstacles"] = {rectangle_of(0.5, 0.2, 1, 0.6)};
  EXPECT_LT(off_hydrostatic(text, [](double) { return 0.6; }), 1e-6);
}

TEST(InitialPressure, IsNotPassedThroughAPlateNorToWhatFallsOntoIt) {
  json text = base_scene();
  text["material"]["sound_speed"] = 40;
  text["fluid"] = {rectangle_of(0, 0, 2, 0.2), rectangle_of(0, 0.35, 2, 0.2)};
  text["obstacles"] = {rectangle_of(0, 0.2, 2, 0.15)};
  const Particles apart = create_particles(parsed(text)).state.particles;
  text["fluid"] = {rectangle_of(0, 0, 2, 0.2)};
  const Particles alone = create_particles(parsed(text)).state.particles;
  text.erase("obstacles");
  text["fluid"] = {rectangle_of(0, 0, 2, 0.2), rectangle_of(0, 0.2, 2, 0.2)};
  text["fluid"][1]["velocity"] = {0, -1};
  const Particles falling = create_particles(parsed(text)).state.particles;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(apart.density_excess[i], alone.density_excess[i]);
    EXPECT_EQ(falling.density_excess[i], alone.density_excess[i]);
  }
}

TEST(StartPlan, KeepsEveryExampleOnItsLatticeAndCountsItsParticles) {
  for (const auto& path : testing::json_files(testing::source_dir() / "schemas/examples")) {
    const Scene scene = testing::parsed_file(path);
    const StartPlan plan = start_plan(scene);
    if (testing::takes_long_to_pack(path)) {
      EXPECT_TRUE(plan.packed) << path;
      continue;
    }
    EXPECT_FALSE(plan.packed) << path << plan.reason;
    const InitialParticles made = create_particles(scene);
    EXPECT_EQ(plan.fluid_particles, made.state.particles.size()) << path;
    EXPECT_FALSE(made.packing) << path;
    EXPECT_EQ(scene_walls(scene), made.walls) << path;
  }
}

TEST(StartPlan, PacksWhatTheLatticeDoesNotFitToItsArea) {
  json off_wall = base_scene();
  off_wall["tank"]["width"] = 1.02;
  off_wall["fluid"] = {rectangle_of(0, 0, 1.02, 0.5)};
  json off_level = base_scene();
  off_level["fluid"] = {rectangle_of(0, 0, 2, 0.52)};
  json round = base_scene();
  round["fluid"] = {rectangle_of(0, 0, 2, 0.5)};
  round["obstacles"] = {{{"shape", "circle"}, {"center", {1, 0.2}}, {"radius", 0.1}}};
  json gate = base_scene();
  gate["gate"] = {{"x", 1.02}, {"height", 0.6}, {"speed", 3.46}};
  gate["fluid"] = {rectangle_of(0, 0, 1.02, 0.5)};
  json slope = base_scene();
  slope["fluid"] = {rectangle_of(0, 0, 2, 0.5)};
  slope["obstacles"] = {{{"shape", "polygon"}, {"points", {{1, 0}, {2, 0}, {2, 0.6}}}}};
  const double areas[] = {0.51, 1.04, 1 - 0.01 * std::numbers::pi, 0.51, 1 - 0.175 / 0.6};
  int i = 0;
  for (const json& text : {off_wall, off_level, round, gate, slope}) {
    const Scene scene = parsed(text);
    const StartPlan plan = start_plan(scene);
    EXPECT_TRUE(plan.packed) << i;
    EXPECT_THAT(plan.reason, HasSubstr(i == 1 ? "% on the lattice" : "does not fit")) << i;
    EXPECT_NEAR(static_cast<double>(plan.fluid_particles) * 0.0025, areas[i], 0.005 * areas[i])
        << i;
    const InitialParticles made = create_particles(scene);
    EXPECT_EQ(plan.fluid_particles, made.state.particles.size()) << i;
    ASSERT_TRUE(made.packing) << i;
    EXPECT_LT(made.packing->residual, 1e-3) << i;
    EXPECT_GT(testing::smallest_distance(positions(made.state.particles)), 0.7 * 0.05) << i;
    ++i;
  }
}

TEST(StartPlan, AsksWhetherTheParticlesInABedGoOnWithTheLattice) {
  // Fluid half a spacing above a bed between the walls, three spacings of 0.05 m high or 2.75.
  const auto bed = [](double height, const std::string& shape) {
    json text = base_scene();
    text["fluid"] = {rectangle_of(0, height, 2, 0.5)};
    text["obstacles"] = {rectangle_of(0, 0, 2, height)};
    if (shape == "polygon") {
      const json points = {{0, 0}, {2, 0}, {2, height}, {0, height}};
      text["obstacles"] = {{{"shape", "polygon"}, {"points", points}}};
    }
    return parsed(text);
  };
  for (const std::string shape : {"rectangle", "polygon"}) {
    EXPECT_FALSE(start_plan(bed(0.15, shape)).packed) << shape;
    const Scene off = bed(0.1375, shape);
    EXPECT_THAT(start_plan(off).reason, HasSubstr("the particles in an obstacle")) << shape;
    // Rows of forty at half a spacing, one and a half and two and a half below its face.
    std::map<long, int> rows;
    for (const Vec& wall : scene_walls(off)) {
      if (wall.y() < 0 || wall.y() > 0.1375 || wall.x() < 0 || wall.x() > 2) continue;
      ++rows[std::lround(1e4 * (0.1375 - wall.y()))];
    }
    EXPECT_EQ(rows, (std::map<long, int>{{250, 40}, {750, 40}, {1250, 40}})) << shape;
  }
}

TEST(PackedParticles, DoNotSagAtAFreeSide) {
  // A column whose floor is a slope: its right face is free and must stay upright.
  json text = base_scene();
  text["resolution"]["spacing"] = 0.025;
  text["fluid"] = {{{"shape", "polygon"}, {"points", {{0, 0.3}, {1, 0}, {1, 0.8}, {0, 0.8}}}}};
  text["obstacles"] = {{{"shape", "polygon"}, {"points", {{0, 0}, {1, 0}, {0, 0.3}}}}};
  const Particles p = create_particles(parsed(text)).state.particles;
  double front = 0.0, top = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    front = std::max(front, p.position[0][i]);
    top = std::max(top, p.position[1][i]);
  }
  EXPECT_NEAR(front, 1.0 - 0.0125, 0.2 * 0.025);
  EXPECT_NEAR(top, 0.8 - 0.0125, 0.2 * 0.025);
}

RC_GTEST_PROP(InitialParticles, OfARectangleStayWithinHalfASpacingOfIt, ()) {
  const double width = *rc::gen::inRange(50, 3000) / 1000.0;
  const double height = *rc::gen::inRange(50, 3000) / 1000.0;
  const Particles p =
      create_particles(
          parsed(
              free_scene({{"shape", "rectangle"}, {"corner", {-1, 2}}, {"size", {width, height}}})))
          .state.particles;
  const auto cells = [](double length) { return std::max(1.0, std::round(length / 0.05)); };
  RC_ASSERT(static_cast<double>(p.size()) == cells(width) * cells(height));
  for (std::size_t i = 0; i < p.size(); ++i) {
    RC_ASSERT(p.position[0][i] > -1 && p.position[0][i] < -1 + width + 1e-9);
    RC_ASSERT(p.position[1][i] > 2 && p.position[1][i] < 2 + height + 1e-9);
  }
}

}  // namespace
}  // namespace sluice

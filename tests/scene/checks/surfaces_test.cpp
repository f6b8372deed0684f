// Scenes with meshes and heights: what is refused, and what they are filled with.

#include "engine/scene/checks/surfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/format/canonical.hpp"
#include "tests/scene/meshes.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::as_ascii_stl;
using testing::box_mesh;
using ::testing::HasSubstr;

/// A tank of 2 m x 1 m x 0.6 m with water at its left, dx = 0.05 m, and one obstacle.
json beside_water(const json& obstacle) {
  json scene = testing::space_scene();
  scene["fluid"] = {testing::box({0, 0, 0}, {0.5, 0.5, 0.6})};
  scene["obstacles"] = {obstacle};
  return scene;
}

json mesh(const std::string& file) { return {{"shape", "mesh"}, {"file", file}}; }
json heights(const json& rows, double step_x, double step_z) {
  return {{"shape", "heights"},
          {"corner", {1.0, 0.0, 0.0}},
          {"step", {step_x, step_z}},
          {"heights", rows}};
}

const Vec3 kBlockCorner(1.0, 0.0, 0.2);
const Vec3 kBlockSize(0.4, 0.4, 0.3);
Triangles block() { return box_mesh(kBlockCorner, kBlockSize); }

SceneParts as_part(const std::string& bytes) { return testing::parts_with({{"block.stl", bytes}}); }

ParseResult parse_with(const json& scene, const std::string& bytes) {
  return parse_scene(scene.dump(), as_part(bytes));
}

Scene scene_of(const json& scene, const std::string& bytes) {
  ParseResult result = parse_with(scene, bytes);
  EXPECT_TRUE(result.scene) << testing::list(result.problems);
  return *std::move(result.scene);
}

/// All places of a scene's start, of fluid and of walls, in order.
std::vector<Vec> places_of(const Scene& scene) {
  const InitialParticles made = create_particles(scene);
  std::vector<Vec> places;
  for (std::size_t i = 0; i < made.state.particles.size(); ++i) {
    places.push_back(made.state.particles.position_of(i));
  }
  places.insert(places.end(), made.walls.begin(), made.walls.end());
  return places;
}

void expect_same_places(const Scene& one, const Scene& other) {
  const std::vector<Vec> places = places_of(one), others = places_of(other);
  ASSERT_EQ(places.size(), others.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    ASSERT_LT((places[i] - others[i]).norm(), 1e-12) << i;
  }
}

TEST(Surfaces, AMeshOfABoxIsFilledAsTheBox) {
  const Scene of_box = testing::parsed(beside_water(testing::box({1, 0, 0.2}, {0.4, 0.4, 0.3})));
  const Scene of_mesh = scene_of(beside_water(mesh("block.stl")), as_ascii_stl(block()));
  expect_same_places(of_mesh, of_box);
}

TEST(Surfaces, AMeshOfFluidIsFilledAsTheBox) {
  json scene = beside_water(testing::box({1, 0, 0.2}, {0.4, 0.4, 0.3}));
  const Scene of_box = testing::parsed(scene);
  scene["fluid"] = {mesh("block.stl")};
  const Scene of_mesh = scene_of(scene, as_ascii_stl(box_mesh(Vec3::Zero(), Vec3(0.5, 0.5, 0.6))));
  expect_same_places(of_mesh, of_box);
  EXPECT_FALSE(create_particles(of_mesh).packing) << "its lattice fits the tank";
}

TEST(Surfaces, LevelHeightsAreFilledAsABox) {
  const json level(json::array_t(4, json(json::array_t(5, 0.3))));
  expect_same_places(testing::parsed(beside_water(heights(level, 0.25, 0.2))),
                     testing::parsed(beside_water(testing::box({1, 0, 0}, {1, 0.3, 0.6}))));
}

TEST(Surfaces, AMeshIsPlacedAsTheSceneSays) {
  json shape = mesh("block.stl");
  shape["scale"] = 0.1;
  shape["rotation"] = {{"axis", {0, 1, 0}}, {"angle", 90}};
  shape["place"] = {1.0, 0.0, 0.5};
  // From (0, 0, 0) to (3, 4, 4) in the file: x goes to -z, z to x.
  const Scene scene =
      scene_of(beside_water(shape), as_ascii_stl(box_mesh(Vec3::Zero(), Vec3(3, 4, 4))));
  expect_same_places(scene,
                     testing::parsed(beside_water(testing::box({1, 0, 0.2}, {0.4, 0.4, 0.3}))));
}

TEST(Surfaces, WaterBesideABedIsPackedToItsMass) {
  // A bank that rises along x, under water whose surface it breaks.
  json scene = testing::space_scene();
  scene["resolution"]["spacing"] = 0.06;
  scene["tank"] = {{"width", 1.2}, {"height", 1}, {"depth", 0.6}};
  scene["fluid"] = {testing::box({0, 0, 0}, {1.2, 0.36, 0.6})};
  json bank = heights({{0.1, 0.1, 0.6}, {0.1, 0.1, 0.6}}, 0.6, 0.6);
  bank["corner"] = {0, 0, 0};
  scene["obstacles"] = {bank};
  const Scene parsed = testing::parsed(scene);
  const InitialParticles made = create_particles(parsed);
  EXPECT_TRUE(made.packing);
  const double depth = 0.26, slope = 0.6 / 0.5 * depth;
  const double wanted = (0.6 * depth + slope * depth / 2) * 0.6 / std::pow(0.06, 3);
  const auto count = static_cast<double>(made.state.particles.size());
  EXPECT_NEAR(count / wanted, 1.0, 0.01);
  const Heights& shape = std::get<Heights>(parsed.obstacles.front());
  for (std::size_t i = 0; i < made.state.particles.size(); ++i) {
    EXPECT_GT(signed_distance(shape, made.state.particles.position_of(i)), -0.3 * 0.06);
  }
}

std::string only_problem_at(const ParseResult& result, const std::string& pointer) {
  EXPECT_FALSE(result.scene);
  EXPECT_EQ(result.problems.size(), 1u) << testing::list(result.problems);
  return testing::message_at(result, pointer);
}

TEST(Surfaces, FilesThatAreNotThereAreMissed) {
  EXPECT_THAT(
      only_problem_at(parse_scene(beside_water(mesh("block.stl")).dump()), "/obstacles/0/file"),
      HasSubstr("is \"block.stl\", but no file came with the scene"));
}

TEST(Surfaces, NamesWithFoldersAreNoNames) {
  for (const std::string name : {"../block.stl", "/etc/passwd", "a/b.stl", "..stl", ".stl",
                                 "-x.stl", "block.step", "block", "a\\b.stl", "a b.stl"}) {
    int asked = 0;
    const ParseResult result =
        parse_scene(beside_water(mesh(name)).dump(), [&](const std::string& wanted) {
          ++asked;
          return no_parts(wanted);
        });
    EXPECT_THAT(only_problem_at(result, "/obstacles/0/file"), HasSubstr("without a folder"))
        << name;
    EXPECT_EQ(asked, 0) << name;
  }
}

TEST(Surfaces, AFileThatChangedIsRefused) {
  const std::string bytes = as_ascii_stl(block());
  const Scene scene = scene_of(beside_water(mesh("block.stl")), bytes);
  const json kept =
      json::parse(text_for_folder(beside_water(mesh("block.stl")).dump(), as_part(bytes)));
  const std::string sha256 = std::get<Mesh>(scene.obstacles.front()).sha256;
  EXPECT_EQ(kept["obstacles"][0]["sha256"], sha256);
  EXPECT_TRUE(parse_job_scene(kept.dump(), as_part(bytes)).scene);
  const ParseResult changed = parse_job_scene(kept.dump(), as_part(bytes + "\n"));
  EXPECT_THAT(only_problem_at(changed, "/obstacles/0/sha256"), HasSubstr("the file was changed"));
}

TEST(Surfaces, TheFileIsPartOfWhatACheckpointIsBoundTo) {
  const Scene scene = scene_of(beside_water(mesh("block.stl")), as_ascii_stl(block()));
  const Scene other = scene_of(beside_water(mesh("block.stl")), as_ascii_stl(block()) + "\n");
  EXPECT_NE(identity_text(scene), identity_text(other));
  EXPECT_THAT(identity_text(scene), HasSubstr("sha256"));
  // And the canonical text reads back to itself.
  const ParseResult again = parse_scene(canonical_text(scene), as_part(as_ascii_stl(block())));
  ASSERT_TRUE(again.scene) << testing::list(again.problems);
  EXPECT_EQ(canonical_text(*again.scene), canonical_text(scene));
}

TEST(Surfaces, LeakyMeshesAreRefusedWithTheFirstBadEdge) {
  Triangles leaky = block();
  leaky.corners.pop_back();
  EXPECT_THAT(only_problem_at(parse_with(beside_water(mesh("block.stl")), as_ascii_stl(leaky)),
                              "/obstacles/0/file"),
              HasSubstr("is not closed: the edge from"));
}

TEST(Surfaces, MeshesThatFaceInwardsAreTurnedRoundWithAWarning) {
  const json scene = beside_water(mesh("block.stl"));
  const ParseResult result = parse_with(scene, as_ascii_stl(testing::flipped(block())));
  ASSERT_TRUE(result.scene) << testing::list(result.problems);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_EQ(result.warnings.front().pointer, "/obstacles/0/file");
  expect_same_places(*result.scene, scene_of(scene, as_ascii_stl(block())));
}

TEST(Surfaces, FlatMeshesAreRefused) {
  const Triangles flat = box_mesh(kBlockCorner, Vec3(0.4, 0.0, 0.3));
  EXPECT_FALSE(parse_with(beside_water(mesh("block.stl")), as_ascii_stl(flat)).scene);
}

TEST(Surfaces, MeshesOutsideTheTankAreRefused) {
  const Triangles wide = box_mesh(kBlockCorner, Vec3(0.4, 0.4, 0.5));
  EXPECT_THAT(only_problem_at(parse_with(beside_water(mesh("block.stl")), as_ascii_stl(wide)),
                              "/obstacles/0"),
              HasSubstr("must lie inside /tank"));
}

TEST(Surfaces, MeshesBeyondAllBoundsAreRefused) {
  json shape = mesh("block.stl");
  shape["scale"] = 1e6;
  const Triangles vast = box_mesh(kBlockCorner, Vec3(1e6, 1, 1));
  EXPECT_THAT(
      only_problem_at(parse_with(beside_water(shape), as_ascii_stl(vast)), "/obstacles/0/file"),
      HasSubstr("lower the scale"));
}

TEST(Surfaces, AnAxisWithoutALengthIsRefused) {
  json shape = mesh("block.stl");
  shape["rotation"] = {{"axis", {0, 0, 0}}, {"angle", 10}};
  EXPECT_THAT(only_problem_at(parse_with(beside_water(shape), as_ascii_stl(block())),
                              "/obstacles/0/rotation/axis"),
              HasSubstr("has no length"));
}

TEST(Surfaces, ThinMeshesAndBedsAreRefusedWhereFluidGetsThrough) {
  const Triangles plate = box_mesh(Vec3(1.0, 0, 0), Vec3(0.07, 0.9, 0.6));
  EXPECT_THAT(only_problem_at(parse_with(beside_water(mesh("block.stl")), as_ascii_stl(plate)),
                              "/obstacles/0"),
              HasSubstr("is only 0.07 m, 1.4 spacings"));
  // A ridge on the floor, sharp at its top, is a wall round whose tip fluid flows.
  const Triangles thick = box_mesh(Vec3(1.0, 0, 0), Vec3(0.1, 0.9, 0.6));
  EXPECT_TRUE(parse_with(beside_water(mesh("block.stl")), as_ascii_stl(thick)).scene);
}

TEST(Surfaces, HeightsBelowTheirBaseAreRefused) {
  EXPECT_THAT(
      only_problem_at(testing::parse(beside_water(heights({{0.2, 0.2}, {0.2, 0.0}}, 0.5, 0.5))),
                      "/obstacles/0/heights/1/1"),
      HasSubstr("must be above the base"));
}

TEST(Surfaces, RowsOfDifferentLengthsAreRefused) {
  EXPECT_THAT(only_problem_at(
                  testing::parse(beside_water(heights({{0.2, 0.2}, {0.2, 0.2, 0.2}}, 0.5, 0.5))),
                  "/obstacles/0/heights/1"),
              HasSubstr("as many as the first row, 2"));
}

TEST(Surfaces, MeshesOfTogetherTooManyTrianglesAreRefused) {
  const Triangles ball = testing::ball_mesh(Vec3(1.3, 0.5, 0.3), 0.2, 7);  // 131072 triangles
  json scene = beside_water(mesh("block.stl"));
  scene["obstacles"].push_back(mesh("block.stl"));
  const ParseResult result = parse_scene(scene.dump(), as_part(testing::as_binary_stl(ball)));
  EXPECT_THAT(only_problem_at(result, "/obstacles/1/file"), HasSubstr("has 131072 triangles"));
}

}  // namespace
}  // namespace sluice

// The start of scenes of three dimensions.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::box;
using testing::cylinder;
using testing::parsed;
using testing::prism;

/// A tank of 1 m x 0.8 m x 0.6 m, dx = 0.05 m, filled from the left.
json tank_scene(const json& fluid) {
  json scene = testing::space_scene();
  scene["tank"]["width"] = 1;
  scene["tank"]["height"] = 0.8;
  scene["fluid"] = fluid;
  return scene;
}

TEST(SpaceFilling, PutsAParticleInEachCellOfABoxWithItsHydrostaticPressure) {
  const Scene scene = parsed(tank_scene(json::array({box({0, 0, 0}, {0.5, 0.4, 0.6})})));
  const InitialParticles made = create_particles(scene);
  const Particles& p = made.state.particles;
  EXPECT_EQ(p.size(), 10U * 8U * 12U);
  EXPECT_FALSE(made.packing);
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(p.density_excess[i] * c2, 1000.0 * 9.81 * (0.4 - p.position[1][i]), 1e-9);
    EXPECT_EQ(p.velocity[2][i], 0.0);
  }
  EXPECT_EQ(static_cast<double>(tank_walls(*scene.tank, scene.method).size()),
            count_tank_walls(*scene.tank, scene.method));
  EXPECT_EQ(made.walls.size(), 26U * 3U * 18U + 16U * (26U * 18U - 20U * 12U));
}

TEST(SpaceFilling, GivesRegionsThatTouchOneLevel) {
  // A low pool beside a column, under a bridge of water: the bridge's level counts below it.
  const Scene scene = parsed(tank_scene(
      json::array({box({0, 0, 0}, {0.5, 0.4, 0.6}), box({0, 0.4, 0}, {0.5, 0.2, 0.3})})));
  const Particles p = create_particles(scene).state.particles;
  const double c2 = scene.method.sound_speed * scene.method.sound_speed;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double level = p.position[2][i] < 0.3 ? 0.6 : 0.4;
    EXPECT_NEAR(p.density_excess[i] * c2, 1000.0 * 9.81 * (level - p.position[1][i]), 1e-6);
  }
}

TEST(SpaceFilling, LeavesOutWhatSolidsDisplace) {
  json text = tank_scene(json::array({box({0, 0, 0}, {0.5, 0.4, 0.6})}));
  text["obstacles"] = json::array({box({0.2, 0, 0.2}, {0.2, 0.2, 0.2})});
  EXPECT_EQ(create_particles(parsed(text)).state.particles.size(), 960U - 4U * 4U * 4U);
}

TEST(SpaceFilling, PacksWhatItsLatticeDoesNotFitToItsMass) {
  // A pool with a ball on its bed, and walls that are no multiple of the spacing.
  json text = tank_scene(json::array({box({0, 0, 0}, {0.4, 0.3, 0.33})}));
  text["tank"]["width"] = 0.4;
  text["tank"]["depth"] = 0.33;
  text["obstacles"] =
      json::array({{{"shape", "sphere"}, {"center", {0.2, 0.15, 0.16}}, {"radius", 0.15}}});
  const Scene scene = parsed(text);
  const InitialParticles made = create_particles(scene);
  ASSERT_TRUE(made.packing);
  const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(0.15, 3);
  const double wanted = (0.4 * 0.3 * 0.33 - ball) / std::pow(0.05, 3);
  EXPECT_NEAR(static_cast<double>(made.state.particles.size()), wanted, 1.0);
  for (std::size_t i = 0; i < made.state.particles.size(); ++i) {
    const Vec place = made.state.particles.position_of(i);
    EXPECT_TRUE(scene.tank->interior().contains(place)) << place.transpose();
    EXPECT_GT((place - Vec3(0.2, 0.15, 0.16)).norm(), 0.15 - 0.3 * 0.05) << place.transpose();
  }
  EXPECT_EQ(exact_estimate(scene).fluid_particles, made.state.particles.size());
}

/// The particles at the start, none of which has its middle in a solid but by its packing.
std::size_t count_beside_solids(const Scene& scene) {
  const Particles p = create_particles(scene).state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec place = p.position_of(i);
    EXPECT_TRUE(scene.tank->interior().contains(place)) << place.transpose();
    for (const Shape& solid : scene.obstacles) {
      EXPECT_GT(signed_distance(solid, place), -0.3 * scene.method.spacing) << place.transpose();
    }
  }
  return p.size();
}

TEST(SpaceFilling, KeepsWaterOutOfACylinder) {
  const auto expect_beside = [](const json& solid, double in_water) {
    json text = tank_scene(json::array({box({0, 0, 0}, {1, 0.4, 0.6})}));
    text["obstacles"] = json::array({solid});
    const double wanted = (1 * 0.4 * 0.6 - in_water) / std::pow(0.05, 3);
    EXPECT_NEAR(static_cast<double>(count_beside_solids(parsed(text))), wanted, 0.01 * wanted);
  };
  const double section = std::numbers::pi * 0.1 * 0.1;
  expect_beside(cylinder({0.5, 0, 0.3}, {0, 0.8, 0}, 0.1), section * 0.4);
  expect_beside(cylinder({0.5, 0.1, 0.15}, {0.05, 0.2, 0.1}, 0.1),
                section * std::hypot(0.05, 0.2, 0.1));
}

TEST(SpaceFilling, FillsAPrismBesideATriangularSill) {
  json text = tank_scene(
      json::array({prism({{0, 0}, {0.6, 0}, {0.6, 0.2}, {0.3, 0.2}, {0.3, 0.5}, {0, 0.5}}),
                   cylinder({0.8, 0.5, 0.15}, {0, 0, 0.3}, 0.15)}));
  text["obstacles"] = json::array({prism({{0.4, 0}, {0.6, 0}, {0.5, 0.15}})});
  const Scene scene = parsed(text);
  const double cell = std::pow(0.05, 3);
  const double column = (0.6 * 0.2 + 0.3 * 0.3 - 0.5 * 0.2 * 0.15) * 0.6 / cell;
  const double drop = std::numbers::pi * 0.15 * 0.15 * 0.3 / cell;
  const double wanted = column + drop;
  EXPECT_NEAR(static_cast<double>(count_beside_solids(scene)), wanted, 0.02 * wanted);
}

TEST(SpaceFilling, OfAPrismOnTheLatticeIsThatOfBoxes) {
  const Scene of_prism = parsed(tank_scene(
      json::array({prism({{0, 0}, {0.6, 0}, {0.6, 0.2}, {0.3, 0.2}, {0.3, 0.5}, {0, 0.5}})})));
  const InitialParticles made = create_particles(of_prism);
  EXPECT_FALSE(made.packing);
  EXPECT_EQ(made.state.particles.size(), (12U * 4U + 6U * 6U) * 12U);
  // A solid block in the same place keeps as many dummy particles as a box of its size.
  const std::vector<Shape> block{Prism{as_polygon({Vec2(0.2, 0), Vec2(0.3, 0.3)}), 0.1, 0.4}};
  const std::vector<Shape> as_box{Cuboid<3>{Vec3(0.2, 0, 0.1), Vec3(0.3, 0.3, 0.4)}};
  EXPECT_EQ(obstacle_walls(block, of_prism.method).size(),
            obstacle_walls(as_box, of_prism.method).size());
}

TEST(SpaceFilling, PerturbsAllAxes) {
  json text = tank_scene(json::array({box({0, 0, 0}, {0.5, 0.4, 0.6})}));
  const Particles still = create_particles(parsed(text)).state.particles;
  text["perturbation"] = {{"amplitude", 0.1}, {"seed", 3}};
  const Particles moved = create_particles(parsed(text)).state.particles;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::set<double> shifts;
    for (std::size_t i = 0; i < still.size(); ++i) {
      const double shift = moved.position[axis][i] - still.position[axis][i];
      EXPECT_LE(std::abs(shift), 0.1 * 0.05 + 1e-15);
      shifts.insert(shift);
    }
    EXPECT_GT(shifts.size(), still.size() / 2);
  }
}

}  // namespace
}  // namespace sluice

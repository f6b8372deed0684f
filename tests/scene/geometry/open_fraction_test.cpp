#include "engine/scene/geometry/open_fraction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/sph/kernel/kernel.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using testing::base_scene;
using testing::parsed;

constexpr double kExact = 0.005;

double share(const nlohmann::json& scene, const Vec2& point, double h, double time = 0.0) {
  return OpenFraction(parsed(scene), point, h).at(time);
}

nlohmann::json scene_with(const char* kernel) {
  nlohmann::json scene = base_scene();
  scene["numerics"]["kernel"] = kernel;
  return scene;
}

/// The part of the kernel's integral that lies above a floor `depth` smoothing lengths below the
/// point, by the trapezoidal rule in polar coordinates.
double above_floor(KernelKind kernel, double depth) {
  const double pi = std::acos(-1.0);
  const double support = kernel == KernelKind::wendland_c2 ? 2.0 : 3.0;
  constexpr int kSteps = 20000;
  double open = 0.0;
  double whole = 0.0;
  for (int n = 1; n < kSteps; ++n) {
    const double r = support * n / kSteps;
    const double ring = r * kernel_value<2>(kernel, r * r);
    const double below = r > depth ? std::acos(depth / r) / pi : 0.0;
    open += ring * (1.0 - below);
    whole += ring;
  }
  return open / whole;
}

TEST(OpenFraction, IsOneInTheOpenAHalfOnAWallAndAQuarterInACorner) {
  for (const char* kernel : {"truncated_gaussian", "wendland_c2"}) {
    const nlohmann::json scene = scene_with(kernel);
    EXPECT_NEAR(share(scene, {1.0, 0.5}, 0.05), 1.0, 1e-12);
    EXPECT_NEAR(share(scene, {2.0, 0.5}, 0.05), 0.5, 1e-12);
    EXPECT_NEAR(share(scene, {1.0, 0.0}, 0.05), 0.5, 1e-12);
    EXPECT_NEAR(share(scene, {2.0, 0.0}, 0.05), 0.25, 1e-12);
  }
}

TEST(OpenFraction, IsTheIntegralOfTheKernelAboveAFloorNearby) {
  for (const auto& [word, kernel] :
       {std::pair{"truncated_gaussian", KernelKind::truncated_gaussian},
        {"wendland_c2", KernelKind::wendland_c2}}) {
    const nlohmann::json scene = scene_with(word);
    for (const double depth : {0.1, 0.41, 0.667, 1.2, 1.9}) {
      EXPECT_NEAR(share(scene, {1.0, depth * 0.05}, 0.05), above_floor(kernel, depth), kExact);
      EXPECT_NEAR(share(scene, {2.0, depth * 0.05}, 0.05), above_floor(kernel, depth) / 2, kExact);
    }
  }
}

TEST(OpenFraction, DoesNotDependOnHowFarTheSumReachesIntoAWall) {
  // Ten smoothing lengths of the scene: far beyond its layers of dummy particles.
  EXPECT_NEAR(share(base_scene(), {2.0, 0.5}, 0.1), 0.5, 1e-12);
}

TEST(OpenFraction, AnOpenTankHasNoLid) {
  nlohmann::json scene = base_scene();
  scene["tank"]["open_top"] = true;
  EXPECT_NEAR(share(scene, {1.0, 1.0}, 0.05), 1.0, 1e-12);
  EXPECT_NEAR(share(scene, {2.0, 1.0}, 0.05), 0.75, 1e-12) << "on the rim";
  scene["tank"]["open_top"] = false;
  EXPECT_NEAR(share(scene, {1.0, 1.0}, 0.05), 0.5, 1e-12);
}

TEST(OpenFraction, ObstaclesAreNotOpen) {
  nlohmann::json scene = base_scene();
  scene["obstacles"] = {{{"shape", "rectangle"}, {"corner", {1.2, 0}}, {"size", {0.4, 0.4}}}};
  EXPECT_NEAR(share(scene, {1.2, 0.2}, 0.05), 0.5, kExact);
  EXPECT_NEAR(share(scene, {1.2, 0.4}, 0.05), 0.75, kExact);
  EXPECT_NEAR(share(scene, {1.4, 0.2}, 0.05), 0.0, 1e-12);
}

TEST(OpenFraction, WithoutATankAllIsOpen) {
  const nlohmann::json drop =
      testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 0.5}});
  EXPECT_NEAR(share(drop, {-0.5, -0.5}, 0.05), 1.0, 1e-12);
}

TEST(OpenFraction, GrowsAsTheGateIsLifted) {
  nlohmann::json scene = base_scene();
  scene["gate"] = {{"x", 1.0}, {"height", 0.5}, {"speed", 2.0}};
  const OpenFraction beside(parsed(scene), Vec2(1.0, 0.2), 0.05);
  // The body is as thick as the support: it fills the right half until its edge comes by.
  EXPECT_NEAR(beside.at(0.0), 0.5, kExact);
  EXPECT_NEAR(beside.at(0.1), 0.75, 2 * kExact);
  EXPECT_NEAR(beside.at(0.2), 1.0, 1e-12);
}

}  // namespace
}  // namespace sluice

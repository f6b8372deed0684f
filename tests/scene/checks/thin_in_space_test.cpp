// Solids of three dimensions that are too thin to hold fluid back.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::cylinder;
using ::testing::HasSubstr;
using testing::message_at;
using testing::parse;
using testing::prism;

/// A tank of 2 m x 1 m x 0.6 m with water at its left, dx = 0.05 m, and one obstacle.
json in_tank(const json& obstacle) {
  json scene = testing::space_scene();
  scene["fluid"] = {testing::box({0, 0, 0}, {0.5, 0.5, 0.6})};
  scene["obstacles"] = {obstacle};
  return scene;
}

/// A wall across the tank, upright or leaning, so thick in spacings.
json leaning_wall(double spacings, double degrees) {
  const double lean = std::tan(degrees * std::numbers::pi / 180);
  const double along = spacings * 0.05 / std::cos(degrees * std::numbers::pi / 180);
  return prism({{1, 0}, {1 + along, 0}, {1 + along + 0.8 * lean, 0.8}, {1 + 0.8 * lean, 0.8}});
}

std::string problem_with(const json& obstacle) {
  return message_at(parse(in_tank(obstacle)), "/obstacles/0");
}

std::string warning_of_one(const json& obstacle) {
  for (const Problem& each : parse(in_tank(obstacle)).warnings) {
    if (each.pointer == "/obstacles/0") return each.message;
  }
  return "";
}

TEST(ThinInSpace, PrismsAreRefusedBelowTwoSpacings) {
  for (const double degrees : {0.0, 15.0, 30.0}) {
    EXPECT_THAT(problem_with(leaning_wall(1.5, degrees)),
                HasSubstr("is only 0.075 m, 1.5 spacings"));
    EXPECT_EQ(problem_with(leaning_wall(2.0, degrees)), "") << degrees;
  }
}

TEST(ThinInSpace, PrismsAreRefusedBelowTwoSpacingsOfDepth) {
  const std::vector<std::vector<double>> square{{0.8, 0}, {1.6, 0}, {1.6, 0.9}, {0.8, 0.9}};
  for (const double spacings : {1.5, 2.0}) {
    json plate = prism(square);
    plate["z"] = 0.25;
    plate["depth"] = spacings * 0.05;
    EXPECT_EQ(problem_with(plate).empty(), spacings >= 2.0) << spacings;
  }
}

TEST(ThinInSpace, PrismsAreFineWhereTheyTaper) {
  const std::vector<std::vector<double>> sill{{1, 0}, {1.6, 0}, {1.3, 0.3}};
  EXPECT_EQ(problem_with(prism(sill)), "");
  EXPECT_EQ(warning_of_one(prism(sill)), "");
  const std::vector<std::vector<double>> ramp{{0.8, 0}, {1.9, 0}, {1.9, 0.25}};
  EXPECT_EQ(problem_with(prism(ramp)), "");
  EXPECT_EQ(warning_of_one(prism(ramp)), "") << "what it tapers on is the floor";
}

TEST(ThinInSpace, PrismsAreRefusedWhereATipTouchesTheFloor) {
  EXPECT_THAT(problem_with(prism({{1.3, 0}, {1.55, 1}, {1.05, 1}})), HasSubstr("does not mend it"));
}

TEST(ThinInSpace, PrismsAreRefusedForTheirNecks) {
  const auto hourglass = [](double neck) {
    return prism(
        {{1, 0}, {1.6, 0}, {1.3 + neck / 2, 0.3}, {1.6, 0.9}, {1, 0.9}, {1.3 - neck / 2, 0.3}});
  };
  EXPECT_NE(problem_with(hourglass(0.02)), "");
  EXPECT_EQ(problem_with(hourglass(0.15)), "");
}

TEST(ThinInSpace, CylindersAreRefusedWhereTheyAreFlat) {
  const Vec3 middle(1.2, 0.5, 0.3);
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(2, 1, 0.2)}) {
    const auto disc = [&](double spacings) {
      const Vec3 axis = spacings * 0.05 * way.normalized();
      const Vec3 base = middle - axis / 2;
      return cylinder({base.x(), base.y(), base.z()}, {axis.x(), axis.y(), axis.z()}, 0.28);
    };
    EXPECT_THAT(problem_with(disc(1.25)), HasSubstr("is only 0.0625 m, 1.2 spacings"));
    EXPECT_EQ(problem_with(disc(2.0)), "");
  }
}

TEST(ThinInSpace, CylindersAreFineAsPillarsThatFluidFlowsRound) {
  EXPECT_EQ(problem_with(cylinder({1, 0, 0.3}, {0, 1, 0}, 0.04)), "");
  EXPECT_THAT(warning_of_one(cylinder({1, 0, 0.3}, {0, 1, 0}, 0.2)),
              HasSubstr("is 0.4 m, 8 spacings"));
  json fine = in_tank(cylinder({1, 0, 0.3}, {0, 1, 0}, 0.2));
  fine["resolution"]["spacing"] = 0.04;
  EXPECT_TRUE(parse(fine).warnings.empty());
}

}  // namespace
}  // namespace sluice

// Bodies of triangles: meshes and heights on a grid.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/mesh_faults.hpp"
#include "engine/scene/geometry/solids.hpp"
#include "tests/scene/meshes.hpp"

namespace sluice {
namespace {

using testing::as_shape;
using testing::ball_mesh;
using testing::box_mesh;

const Vec3 kBoxCorner(0.25, -0.5, 1.0);
const Vec3 kBoxSize(1.5, 0.75, 2.0);

Cuboid<3> plain_box() { return {kBoxCorner, kBoxSize}; }
Mesh plain_box_mesh() { return as_shape(box_mesh(kBoxCorner, kBoxSize)); }

/// A bed of three by four nodes, or a level one.
Heights bed(bool level) {
  Heights bed;
  bed.corner = Vec3(-0.5, 0.25, 0.0);
  bed.step = Vec2(0.5, 0.75);
  bed.heights = {{1, 2, 1.5}, {0.5, 1, 2}, {0.75, 3, 1}, {1, 1, 1.25}};
  if (level) bed.heights.assign(4, std::vector<double>(3, 1.75));
  bed.surface = std::make_shared<const TriangleMesh>(triangles_of(bed));
  return bed;
}

/// The ring of a square hole through a plate, all of right angles.
Mesh frame() {
  Triangles all;
  const Vec3 hole_corner(1, 0, 1), hole_size(1, 1, 1);
  const Triangles outer = box_mesh(Vec3(0, 0, 0), Vec3(3, 1, 3));
  const Triangles hole = testing::flipped(box_mesh(hole_corner, hole_size));
  all.points = outer.points;
  all.points.insert(all.points.end(), hole.points.begin(), hole.points.end());
  // The sides of both, and on top and below four trapezia between them.
  for (const Triangles* each : {&outer, &hole}) {
    const auto shift = static_cast<std::uint32_t>(each == &hole ? 8 : 0);
    for (const auto& [a, b, c] : each->corners) {
      const double normal_y =
          (each->points[b] - each->points[a]).cross(each->points[c] - each->points[a]).y();
      if (normal_y == 0.0) all.corners.push_back({a + shift, b + shift, c + shift});
    }
  }
  constexpr std::array<std::uint32_t, 4> kBelow{0, 1, 5, 4};  // around, seen from below
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t a = kBelow[k], b = kBelow[(k + 1) % 4];
    all.corners.insert(all.corners.end(), {{a, b, b + 8}, {a, b + 8, a + 8}});
    all.corners.insert(all.corners.end(), {{a + 2, b + 10, b + 2}, {a + 2, a + 10, b + 10}});
  }
  return as_shape(std::move(all));
}

std::vector<ShapeN<3>> mesh_bodies() {
  return {plain_box_mesh(), as_shape(ball_mesh(Vec3(1, 1, 1), 1.25, 3)), bed(false), frame()};
}

const TriangleMesh& surface_in(const ShapeN<3>& body) {
  if (const auto* heights = std::get_if<Heights>(&body)) return surface_of(*heights);
  return surface_of(std::get<Mesh>(body));
}

Vec3 anywhere(std::mt19937& dice) {
  std::uniform_real_distribution<double> one(-2.0, 4.0);
  return {one(dice), one(dice), one(dice)};
}
/// On a coarse grid, so that lines meet edges and corners.
Vec3 on_grid(std::mt19937& dice) {
  std::uniform_int_distribution<int> one(-8, 16);
  return 0.25 * Vec3(one(dice), one(dice), one(dice));
}

TEST(Meshes, AreClosed) {
  for (const ShapeN<3>& body : mesh_bodies()) {
    EXPECT_EQ(mesh_fault(surface_in(body).triangles()), std::nullopt);
    EXPECT_GT(measure(body), 0.0);
  }
}

TEST(Meshes, ABoxOfTrianglesAnswersAsTheBox) {
  const Mesh mesh = plain_box_mesh();
  EXPECT_DOUBLE_EQ(measure(mesh), measure(plain_box()));
  EXPECT_DOUBLE_EQ(perimeter(mesh), perimeter(plain_box()));
  EXPECT_EQ(bounds(mesh).min, bounds(plain_box()).min);
  EXPECT_EQ(bounds(mesh).max, bounds(plain_box()).max);
  std::mt19937 dice(1);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 place = k % 2 == 0 ? anywhere(dice) : on_grid(dice);
    const double distance = signed_distance(plain_box(), place);
    ASSERT_NEAR(std::abs(signed_distance(mesh, place)), std::abs(distance), 1e-14);
    if (distance != 0.0) {
      ASSERT_EQ(contains(mesh, place), distance < 0.0) << place.transpose();
    }
    const Vec3 way = anywhere(dice);
    ASSERT_NEAR(farthest_along(mesh, way), farthest_along(plain_box(), way), 1e-13);
  }
}

TEST(Meshes, LevelHeightsAreABox) {
  const Heights level = bed(true);
  const Cuboid<3> box{Vec3(-0.5, 0.25, 0.0), Vec3(1.0, 1.5, 2.25)};
  EXPECT_DOUBLE_EQ(measure(level), measure(box));
  EXPECT_DOUBLE_EQ(perimeter(level), perimeter(box));
  std::mt19937 dice(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 place = anywhere(dice);
    ASSERT_NEAR(signed_distance(level, place), signed_distance(box, place), 1e-14);
  }
}

TEST(Meshes, HeightsAreStraightBetweenTheirNodes) {
  const Heights shape = bed(false);
  const auto top = [&](double x, double z) {
    const auto ends = chords(shape, Vec3(x, 0, z), Vec3::Unit(1));
    EXPECT_EQ(ends.size(), 2u);
    EXPECT_EQ(ends.front(), 0.25) << "the base";
    return ends.back();
  };
  EXPECT_DOUBLE_EQ(top(0.0, 0.75), 1.0) << "a node";
  EXPECT_DOUBLE_EQ(top(0.0, 1.125), 2.0) << "half way along an edge, of 1 and 3";
  EXPECT_DOUBLE_EQ(top(-0.25, 0.375), 1.0) << "the middle of a cell: of the nodes of 1 and 1";
  // Each cell holds the means of its two triangles' heights.
  double volume = 0.0;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double a = shape.heights[j][i], b = shape.heights[j][i + 1],
                   c = shape.heights[j + 1][i], d = shape.heights[j + 1][i + 1];
      volume += 0.5 * 0.75 * ((a + b + d) / 6 + (a + c + d) / 6 - 0.25);
    }
  }
  EXPECT_NEAR(measure(shape), volume, 1e-14);
}

TEST(Meshes, AFineBallAnswersAsTheBall) {
  const Ball<3> ball{Vec3(1, 1, 1), 1.25};
  const Mesh mesh = as_shape(ball_mesh(ball.center, ball.radius, 5));
  EXPECT_NEAR(measure(mesh) / measure(ball), 1.0, 2e-3);
  EXPECT_NEAR(perimeter(mesh) / perimeter(ball), 1.0, 2e-3);
  std::mt19937 dice(3);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 place = anywhere(dice);
    ASSERT_NEAR(signed_distance(mesh, place), signed_distance(ball, place), 2e-3);
  }
}

TEST(Meshes, ThroughAHoleOneSeesTheOtherSide) {
  const Mesh ring = frame();
  EXPECT_DOUBLE_EQ(measure(ring), 8.0);
  EXPECT_FALSE(contains(ring, Vec3(1.5, 0.5, 1.5)));
  EXPECT_TRUE(contains(ring, Vec3(0.5, 0.5, 0.5)));
  EXPECT_EQ(chords(ring, Vec3(1.5, 5, 1.5), Vec3::Unit(1)), std::vector<double>{});
  EXPECT_EQ(chords(ring, Vec3(-1, 0.5, 1.5), Vec3::Unit(0)), (std::vector<double>{1, 2, 3, 4}));
}

TEST(Meshes, BodiesInOneFileThatOverlapAreOne) {
  Triangles two = box_mesh(Vec3(0, 0, 0), Vec3(2, 1, 1));
  const Triangles other = box_mesh(Vec3(1, 0.25, 0.25), Vec3(2, 0.5, 0.5));
  for (const auto& [a, b, c] : other.corners) two.corners.push_back({a + 8, b + 8, c + 8});
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  const Mesh body = as_shape(two);
  EXPECT_EQ(mesh_fault(two), std::nullopt);
  EXPECT_EQ(chords(body, Vec3(-1, 0.5, 0.5), Vec3::Unit(0)), (std::vector<double>{1, 4}));
  EXPECT_TRUE(contains(body, Vec3(1.5, 0.5, 0.5)));
}

// Every line goes in as often as out, whatever edges and corners it meets, and is inside between.
RC_GTEST_PROP(Meshes, ChordsArePairsThatBeginAndEndOnTheSurface, (unsigned seed)) {
  std::mt19937 dice(seed);
  for (const bool coarse : {false, true}) {
    const Vec3 origin = coarse ? on_grid(dice) : anywhere(dice);
    const Vec3 other = coarse ? on_grid(dice) : anywhere(dice);
    for (const Vec3& way : {Vec3(other - origin), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      if (way.isZero(0.0)) continue;
      for (const ShapeN<3>& body : mesh_bodies()) {
        const std::vector<double> ends = chords(body, origin, way);
        RC_ASSERT(ends.size() % 2 == 0);
        RC_ASSERT(std::is_sorted(ends.begin(), ends.end()));
        const auto distance = [&](double t) { return signed_distance(body, origin + t * way); };
        for (std::size_t i = 0; i < ends.size(); ++i) {
          RC_ASSERT(std::abs(distance(ends[i])) < 1e-9);
          if (i == 0) continue;
          const double between = distance((ends[i - 1] + ends[i]) / 2);
          RC_ASSERT((i % 2 == 1 ? between : -between) < 1e-9);
        }
      }
    }
  }
}

RC_GTEST_PROP(Meshes, DistanceIsThatOfTheNearestTriangle, (unsigned seed)) {
  std::mt19937 dice(seed);
  const Vec3 place = anywhere(dice);
  for (const ShapeN<3>& body : mesh_bodies()) {
    const TriangleMesh& surface = surface_in(body);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < surface.size(); ++i) {
      nearest = std::min(nearest, (nearest_point(surface.triangle(i), place) - place).norm());
    }
    RC_ASSERT(std::abs(std::abs(signed_distance(body, place)) - nearest) < 1e-14);
    RC_ASSERT(contains(body, place) == (signed_distance(body, place) < 0.0));
  }
}

TEST(Meshes, TheNearestPointOfATriangleIsNearerThanAnySample) {
  std::mt19937 dice(5);
  for (int k = 0; k < 200; ++k) {
    const std::array<Vec3, 3> triangle{anywhere(dice), anywhere(dice), anywhere(dice)};
    const Vec3 place = anywhere(dice);
    const double nearest = (nearest_point(triangle, place) - place).norm();
    double sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 50; ++i) {
      for (int j = 0; i + j <= 50; ++j) {
        const Vec3 each = triangle[0] + i / 50.0 * (triangle[1] - triangle[0]) +
                          j / 50.0 * (triangle[2] - triangle[0]);
        sampled = std::min(sampled, (each - place).norm());
      }
    }
    ASSERT_LE(nearest, sampled + 1e-12);
    ASSERT_GE(nearest, sampled - 0.2);
  }
}

TEST(Meshes, AreSolidsAsTheBodiesThatTheyMesh) {
  constexpr double kSpacing = 0.1;
  // A cube that stands against another: of both, the second is a mesh, or none is.
  const Cuboid<3> first{Vec3(0, 0, 0), Vec3(1, 1, 1)}, second{Vec3(1, 0, 0), Vec3(1, 1, 1)};
  const SolidsN<3> plain({first, second}, std::nullopt, kSpacing);
  const SolidsN<3> meshed({first, as_shape(box_mesh(second.corner, second.size))}, std::nullopt,
                          kSpacing);
  std::mt19937 dice(9);
  std::uniform_real_distribution<double> part(-0.2, 1.2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 place(2 * part(dice), part(dice), part(dice));
    ASSERT_EQ(meshed.holds(place), plain.holds(place)) << place.transpose();
    ASSERT_EQ(meshed.leaves_room(place, 0.15), plain.leaves_room(place, 0.15));
    // Beside the seam the way out of one body ends in the other: then it is sought.
    ASSERT_NEAR(meshed.depth(place, 0.5), plain.depth(place, 0.5), 0.02) << place.transpose();
  }
  EXPECT_NEAR(meshed.depth(Vec3(1.01, 0.5, 0.5), 0.45), 0.45, 1e-6) << "the seam is no way out";
  EXPECT_EQ(meshed.depth(Vec3(1.5, 0.9, 0.5), 0.45), 1.0 - 0.9) << "exact where it is plain";
}

TEST(MeshFaults, NameTheEdgeOfAHole) {
  Triangles leaky = box_mesh(Vec3::Zero(), Vec3(1, 2, 3));
  leaky.corners.pop_back();
  const auto fault = mesh_fault(leaky);
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, ::testing::HasSubstr("the edge from (1, 0, 0) to (1, 0, 3) m has one"));
}

TEST(MeshFaults, NameTheEdgeOfAFlippedTriangle) {
  Triangles mixed = box_mesh(Vec3::Zero(), Vec3(1, 2, 3));
  std::swap(mixed.corners[5][1], mixed.corners[5][2]);
  const auto fault = mesh_fault(mixed);
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, ::testing::HasSubstr("two triangles that run the same way"));
}

TEST(MeshFaults, NameATriangleThatIsThereTwice) {
  Triangles doubled = box_mesh(Vec3::Zero(), Vec3(1, 2, 3));
  doubled.corners.push_back(doubled.corners.front());
  const auto fault = mesh_fault(doubled);
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, ::testing::HasSubstr("has 3 triangles, not two"));
}

TEST(MeshFaults, AMeshThatFacesInwardsIsClosedAndHasANegativeVolume) {
  const Triangles inwards = testing::flipped(box_mesh(Vec3::Zero(), Vec3(1, 2, 3)));
  EXPECT_EQ(mesh_fault(inwards), std::nullopt);
  EXPECT_DOUBLE_EQ(TriangleMesh(inwards).volume(), -6.0);
}

TEST(MeshPlaces, SinesAreThoseOfTheLibraryAndExactAtQuarters) {
  for (double degrees = -720.0; degrees <= 720.0; degrees += 0.37) {
    ASSERT_NEAR(sin_of_degrees(degrees), std::sin(std::numbers::pi / 180 * degrees), 3e-15);
  }
  EXPECT_EQ(sin_of_degrees(90), 1.0);
  EXPECT_EQ(sin_of_degrees(180), 0.0);
  EXPECT_EQ(sin_of_degrees(-90), -1.0);
  EXPECT_EQ(sin_of_degrees(270), -1.0);
}

TEST(MeshPlaces, AreScaledThenTurnedThenMoved) {
  Mesh as;
  as.scale = 2.0;
  as.rotation = Rotation{Vec3(0, 0, 3), 90.0};
  as.place = Vec3(10, 20, 30);
  const Triangles there = placed({{Vec3(1, 2, 3)}, {}}, as);
  EXPECT_EQ(there.points.front(), Vec3(10 - 4, 20 + 2, 30 + 6));
}

TEST(MeshPlaces, TurnAsEigenDoes) {
  std::mt19937 dice(7);
  for (int k = 0; k < 100; ++k) {
    Mesh as;
    as.rotation = Rotation{anywhere(dice), 90 * anywhere(dice).x()};
    const Vec3 point = anywhere(dice);
    const Eigen::AngleAxisd turn(as.rotation->angle * std::numbers::pi / 180,
                                 as.rotation->axis.normalized());
    ASSERT_LT((placed({{point}, {}}, as).points.front() - turn * point).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace sluice

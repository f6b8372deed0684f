#include "engine/scene/geometry/surfaces.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

namespace sluice {
namespace {

const TriangleMesh& or_none(const std::shared_ptr<const TriangleMesh>& surface) {
  static const TriangleMesh none{Triangles{}};
  return surface ? *surface : none;
}

/// x^odd/odd! by turns added and taken away; |x| up to pi/4.
double sin_near_zero(double x) {
  const double square = x * x;
  double sum = 0.0;
  for (int k = 19; k > 1; k -= 2) sum = square / (k * (k - 1)) * (1.0 - sum);
  return x * (1.0 - sum);
}
double cos_near_zero(double x) {
  const double square = x * x;
  double sum = 0.0;
  for (int k = 20; k > 0; k -= 2) sum = square / (k * (k - 1)) * (1.0 - sum);
  return 1.0 - sum;
}

}  // namespace

const TriangleMesh& surface_of(const Heights& s) { return or_none(s.surface); }
const TriangleMesh& surface_of(const Mesh& s) { return or_none(s.surface); }

double sin_of_degrees(double degrees) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double turn = std::remainder(degrees, 360.0);  // exact
  const double quarters = std::nearbyint(turn / 90.0);
  const double rest = (turn - 90.0 * quarters) * kRadians;
  switch (static_cast<int>(quarters)) {
    case 0:
      return sin_near_zero(rest);
    case 1:
      return cos_near_zero(rest);
    case -1:
      return -cos_near_zero(rest);
    default:
      return -sin_near_zero(rest);
  }
}

Triangles triangles_of(const Heights& s) {
  const std::size_t columns = s.heights.front().size();
  const std::size_t rows = s.heights.size();
  Triangles result;
  const auto place = [&](std::size_t i, std::size_t j, double y) {
    return Vec3(s.corner.x() + static_cast<double>(i) * s.step[0], y,
                s.corner.z() + static_cast<double>(j) * s.step[1]);
  };
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    result.corners.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                              static_cast<std::uint32_t>(c)});
  };
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      result.points.push_back(place(i, j, s.heights[j][i]));
    }
  }
  const auto node = [&](std::size_t i, std::size_t j) { return j * columns + i; };
  for (std::size_t j = 0; j + 1 < rows; ++j) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      add(node(i, j), node(i + 1, j + 1), node(i + 1, j));
      add(node(i, j), node(i, j + 1), node(i + 1, j + 1));
    }
  }
  // Once around the grid, by increasing z first: the sides, and the base about its middle.
  std::vector<std::pair<std::size_t, std::size_t>> around;
  for (std::size_t j = 0; j + 1 < rows; ++j) around.emplace_back(0, j);
  for (std::size_t i = 0; i + 1 < columns; ++i) around.emplace_back(i, rows - 1);
  for (std::size_t j = rows - 1; j > 0; --j) around.emplace_back(columns - 1, j);
  for (std::size_t i = columns - 1; i > 0; --i) around.emplace_back(i, 0);
  const std::size_t base = result.points.size();
  for (const auto& [i, j] : around) result.points.push_back(place(i, j, s.corner.y()));
  const std::size_t middle = result.points.size();
  const Vec3 first = result.points[base], last = place(columns - 1, rows - 1, s.corner.y());
  result.points.push_back(0.5 * (first + last));
  for (std::size_t k = 0; k < around.size(); ++k) {
    const std::size_t next = (k + 1) % around.size();
    const std::size_t top = node(around[k].first, around[k].second);
    const std::size_t next_top = node(around[next].first, around[next].second);
    add(base + k, base + next, next_top);
    add(base + k, next_top, top);
    add(middle, base + next, base + k);
  }
  return result;
}

Triangles placed(Triangles triangles, const Mesh& as) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (as.rotation) {
    // Rodrigues' formula.
    const double sine = sin_of_degrees(as.rotation->angle);
    const double cosine = sin_of_degrees(as.rotation->angle + 90.0);
    const Vec3 k = as.rotation->axis / as.rotation->axis.norm();
    Eigen::Matrix3d cross;
    cross << 0, -k.z(), k.y(), k.z(), 0, -k.x(), -k.y(), k.x(), 0;
    turn += sine * cross + (1.0 - cosine) * (cross * cross);
  }
  for (Vec3& point : triangles.points) {
    const Vec3 scaled = as.scale * point;
    point = as.rotation ? Vec3(turn * scaled + as.place) : Vec3(scaled + as.place);
  }
  return triangles;
}

}  // namespace sluice

#include "engine/scene/geometry/triangle_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace sluice {
namespace {

constexpr std::uint32_t kInLeaf = 4;
/// Of coordinates: more than rounding moves a line, so that no box is passed over that it meets.
constexpr double kLineMargin = 1e-12;

/// The exact sign of a b - c d: products that round to the same are told apart by what rounding
/// took from them.
int sign_of_difference(double a, double b, double c, double d) {
  const double one = a * b;
  const double other = c * d;
  if (one != other) return one > other ? 1 : -1;
  const double rest = std::fma(a, b, -one);
  const double other_rest = std::fma(c, d, -other);
  return rest > other_rest ? 1 : (rest < other_rest ? -1 : 0);
}

/// On which side of the way from a to b a place lies that is beside the origin by a step along u
/// and a far smaller one along v; 0 where a and b are one.
int side_of(const Vec2& a, const Vec2& b) {
  if (const int sign = sign_of_difference(a.x(), b.y(), a.y(), b.x()); sign != 0) return sign;
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  if (a.x() != b.x()) return a.x() < b.x() ? 1 : -1;
  return 0;
}

/// A line as the origin of a plane across it. A point's place there depends on the point and the
/// line alone, so the triangles of a closed surface fit together in the plane as well.
class LineView {
 public:
  LineView(const Vec3& origin, const Vec3& direction) : origin_(origin) {
    direction.cwiseAbs().maxCoeff(&along_);
    u_ = (along_ + 1) % 3;
    v_ = (along_ + 2) % 3;
    rate_ = direction[along_];
    slope_ = Vec2(direction[u_] / rate_, direction[v_] / rate_);
  }

  struct Point {
    Vec2 place;
    double t;
  };
  [[nodiscard]] Point operator()(const Vec3& point) const {
    const Vec3 from = point - origin_;
    const double along = from[along_];
    return {Vec2(from[u_] - slope_[0] * along, from[v_] - slope_[1] * along), along / rate_};
  }

 private:
  Vec3 origin_;
  Eigen::Index along_ = 0;
  Eigen::Index u_ = 1;
  Eigen::Index v_ = 2;
  double rate_ = 1.0;
  Vec2 slope_ = Vec2::Zero();
};

double twice_area(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// 1 or -1 where a line crosses a triangle, as its corners turn about it; else 0.
int turn_of(const LineView::Point& a, const LineView::Point& b, const LineView::Point& c) {
  const int turn = side_of(a.place, b.place);
  const bool same =
      turn != 0 && side_of(b.place, c.place) == turn && side_of(c.place, a.place) == turn;
  return same ? turn : 0;
}

/// Where a line meets a triangle that it crosses: t by the parts of the area.
double meeting(const LineView::Point& a, const LineView::Point& b, const LineView::Point& c) {
  const double of_a = twice_area(b.place, c.place);
  const double of_b = twice_area(c.place, a.place);
  const double of_c = twice_area(a.place, b.place);
  const double sum = of_a + of_b + of_c;
  const auto [low, high] = std::minmax({a.t, b.t, c.t});
  const double t =
      sum != 0.0 ? (of_a * a.t + of_b * b.t + of_c * c.t) / sum : (a.t + b.t + c.t) / 3;
  return std::clamp(t, low, high);
}

/// Whether a line meets a box.
bool meets(const BoxN<3>& box, const Vec3& origin, const Vec3& direction) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - origin[axis];
    const double high = box.max[axis] - origin[axis];
    if (direction[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double one = low / direction[axis];
    const double other = high / direction[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter <= leave;
}

/// Whether the way straight up from a point meets a box; exact, so that no margin is needed.
bool is_below(const Vec3& point, const BoxN<3>& box) {
  return box.max[1] > point[1] && box.min[0] <= point[0] && point[0] <= box.max[0] &&
         box.min[2] <= point[2] && point[2] <= box.max[2];
}

double squared_distance(const BoxN<3>& box, const Vec3& point) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).squaredNorm();
}

}  // namespace

Vec3 nearest_point(const std::array<Vec3, 3>& triangle, const Vec3& point) {
  const auto& [a, b, c] = triangle;
  const Vec3 ab = b - a, ac = c - a, ap = point - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

TriangleMesh::TriangleMesh(Triangles triangles) : triangles_(std::move(triangles)) {
  if (triangles_.corners.empty()) return;
  const auto count = static_cast<std::uint32_t>(triangles_.corners.size());
  std::vector<Vec3> middles;
  middles.reserve(count);
  bounds_ = box_of(0);
  for (std::size_t i = 0; i < count; ++i) {
    const BoxN<3> box = box_of(i);
    middles.push_back(box.middle());
    bounds_.take_in(box.min);
    bounds_.take_in(box.max);
  }
  const Vec3 middle = bounds_.middle();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b, c] = triangle(i);
    const Vec3 twice = (b - a).cross(c - a);
    area_ += twice.norm() / 2;
    volume_ += (a - middle).dot(twice) / 6;
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(count);
  build(middles, 0, count);
}

void TriangleMesh::build(const std::vector<Vec3>& middles, std::uint32_t first,
                         std::uint32_t last) {
  const std::size_t at = nodes_.size();
  BoxN<3> box = box_of(order_[first]);
  BoxN<3> spread{middles[order_[first]], middles[order_[first]]};
  for (std::uint32_t k = first; k < last; ++k) {
    const BoxN<3> each = box_of(order_[k]);
    box.take_in(each.min);
    box.take_in(each.max);
    spread.take_in(middles[order_[k]]);
  }
  nodes_.push_back({box, first, last - first, 0});
  if (last - first <= kInLeaf) return;
  Eigen::Index axis = 0;
  spread.size().maxCoeff(&axis);
  const std::uint32_t half = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                   [&](std::uint32_t one, std::uint32_t other) {
                     return middles[one][axis] < middles[other][axis];
                   });
  nodes_[at].count = 0;
  build(middles, first, half);
  nodes_[at].other = static_cast<std::uint32_t>(nodes_.size());
  build(middles, half, last);
}

std::array<Vec3, 3> TriangleMesh::triangle(std::size_t i) const {
  const auto& [a, b, c] = triangles_.corners[i];
  return {triangles_.points[a], triangles_.points[b], triangles_.points[c]};
}

Vec3 TriangleMesh::normal(std::size_t i) const {
  const auto [a, b, c] = triangle(i);
  const Vec3 across = (b - a).cross(c - a);
  const double length = across.norm();
  return length > 0.0 ? Vec3(across / length) : Vec3(Vec3::Zero());
}

BoxN<3> TriangleMesh::box_of(std::size_t i) const {
  const auto [a, b, c] = triangle(i);
  BoxN<3> box{a, a};
  box.take_in(b);
  box.take_in(c);
  return box;
}

/// Calls f(crossing) for each triangle that a line crosses, in no order.
template <class F>
void TriangleMesh::for_each_crossing(const Vec3& origin, const Vec3& direction, const F& f) const {
  const LineView across(origin, direction);
  const double far = std::max({bounds_.min.cwiseAbs().maxCoeff(), bounds_.max.cwiseAbs().maxCoeff(),
                               origin.cwiseAbs().maxCoeff()});
  const double margin = kLineMargin * far;
  walk([&](const Node& node) { return meets(grown(node.box, margin), origin, direction); },
       [&](std::size_t i) {
         const auto [one, two, three] = triangle(i);
         const LineView::Point a = across(one), b = across(two), c = across(three);
         if (const int turn = turn_of(a, b, c); turn != 0) f(Crossing{meeting(a, b, c), turn, i});
       });
}

bool TriangleMesh::contains(const Vec3& point) const {
  if (!bounds_.contains(point)) return false;
  // Upwards: a bed is crossed once there.
  const LineView across(point, Vec3::Unit(1));
  int depth = 0;
  walk([&](const Node& node) { return is_below(point, node.box); },
       [&](std::size_t i) {
         if (!is_below(point, box_of(i))) return;
         const auto [one, two, three] = triangle(i);
         const LineView::Point a = across(one), b = across(two), c = across(three);
         const int turn = turn_of(a, b, c);
         if (turn != 0 && meeting(a, b, c) > 0.0) depth += turn;
       });
  return depth != 0;
}

TriangleMesh::Nearest TriangleMesh::nearest(const Vec3& point, double within) const {
  Nearest found;
  double least = within * within;
  walk([&](const Node& node) { return squared_distance(node.box, point) < least; },
       [&](std::size_t i) {
         const Vec3 place = nearest_point(triangle(i), point);
         const double distance = (place - point).squaredNorm();
         if (distance >= least) return;
         least = distance;
         found = {std::sqrt(least), place};
       });
  return found;
}

std::vector<TriangleMesh::Crossing> TriangleMesh::ends_of_chords(const Vec3& origin,
                                                                 const Vec3& direction) const {
  std::vector<Crossing> all;
  for_each_crossing(origin, direction, [&](const Crossing& each) { all.push_back(each); });
  std::sort(all.begin(), all.end(), [](const Crossing& one, const Crossing& other) {
    return std::tie(one.t, one.turn, one.triangle) < std::tie(other.t, other.turn, other.triangle);
  });
  std::vector<Crossing> ends;
  int depth = 0;
  for (const Crossing& each : all) {
    const bool was_out = depth == 0;
    depth += each.turn;
    if (was_out != (depth == 0)) ends.push_back(each);
    // Out and in again at one place is no end.
    const std::size_t count = ends.size();
    if (count > 1 && ends[count - 1].t == ends[count - 2].t) ends.resize(count - 2);
  }
  return ends;
}

}  // namespace sluice

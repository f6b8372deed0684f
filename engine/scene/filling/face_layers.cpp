#include "engine/scene/filling/face_layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/scene/filling/apart_points.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

// In dx: nearer particles would stand for the same area twice.
constexpr double kApart = 0.75;
constexpr double kLayerSlack = 1e-3;  // of dx: rounding far from the origin
constexpr double kFarthest = 4.0;     // in dx, that a layer reaches past the end of its face
constexpr double kCurved = 0.85;      // cosine of the turn up to which faces are one curved face
constexpr double kStraight = 0.02;    // sine of a turn that is none

struct Face {
  Vec2 begin = Vec2::Zero();
  Vec2 along = Vec2::Zero();
  Vec2 in = Vec2::Zero();
  double length = 0.0;
  bool open = true;
};

/// A part of a layer along faces without a sharp corner between them.
struct Strip {
  std::vector<Vec2> points;
  bool from_corner = true;  ///< else it begins at a covered face, where half a cell stays free
  bool to_corner = true;
};

class FaceLayers {
 public:
  FaceLayers(const Polygon& polygon, const Method& method,
             const std::function<bool(const Vec2&)>& covered)
      : polygon_(polygon),
        dx_(method.spacing),
        layers_(wall_layers(method)),
        covered_(covered),
        made_(dx_) {
    std::vector<Vec2> corners = polygon.points;
    if (twice_signed_area(corners) < 0.0) std::reverse(corners.begin(), corners.end());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 edge = corners[(i + 1) % corners.size()] - corners[i];
      const Vec2 along = edge.normalized();
      Face face{corners[i], along, Vec2(-along.y(), along.x()), edge.norm(), true};
      face.open = !all_along(
          face, [&](const Vec2& place) { return covered_(place - kLayerSlack * dx_ * face.in); });
      faces_.push_back(face);
    }
  }

  /// Whether the layers of two faces stay clear of each other: behind each open face the polygon is
  /// thick enough, or ends in what is solid too.
  [[nodiscard]] bool is_thick() const {
    const double enough = (2.0 * static_cast<double>(layers_) - 1.0 - kLayerSlack) * dx_;
    return std::all_of(faces_.begin(), faces_.end(), [&](const Face& face) {
      return !face.open || all_along(face, [&](const Vec2& place) {
        for (const double way : chords(polygon_, place, face.in)) {
          if (way < kLayerSlack * dx_) continue;
          return way > enough || covered_(place + (way + kLayerSlack * dx_) * face.in);
        }
        return true;
      });
    });
  }

  std::vector<Vec2> make() {
    for (double k = 0; k < static_cast<double>(layers_); ++k) add_layer((k + 0.5) * dx_);
    return made_.take();
  }

 private:
  /// Whether something holds at places half a spacing apart along a face.
  template <class F>
  [[nodiscard]] bool all_along(const Face& face, const F& holds) const {
    const double count = std::ceil(2 * face.length / dx_);
    for (double k = 0; k < count; ++k) {
      if (!holds(face.begin + (k + 0.5) / count * face.length * face.along)) return false;
    }
    return true;
  }

  [[nodiscard]] const Face& next(std::size_t i) const { return faces_[(i + 1) % faces_.size()]; }

  /// Where the lines of two faces in turn meet, each moved in by `depth` if it is open.
  [[nodiscard]] Vec2 meet(const Face& a, const Face& b, double depth) const {
    const double a_depth = a.open ? depth : 0.0, b_depth = b.open ? depth : 0.0;
    const Vec2 foot = b.begin + (a.open ? a_depth * a.in : b_depth * b.in);
    const double turn = a.along.dot(b.in);
    if (std::abs(turn) < kStraight) return foot;
    const double back = -a.length - b.length, past = kFarthest * dx_;
    if (a.open) {
      const double way = (b_depth - a_depth * a.in.dot(b.in)) / turn;
      return foot + std::clamp(way, back, past) * a.along;
    }
    return foot - std::clamp(-b_depth * b.in.dot(a.in) / turn, back, past) * b.along;
  }

  /// Whether a strip goes on from this face to the next.
  [[nodiscard]] bool goes_on(std::size_t i) const {
    return faces_[i].open && next(i).open && faces_[i].along.dot(next(i).along) > kCurved;
  }

  void add_layer(double depth) {
    const std::size_t n = faces_.size();
    std::size_t start = 0;
    while (start < n && goes_on((start + n - 1) % n)) ++start;
    if (start == n) start = 0;  // one round face
    Strip strip;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (start + k) % n;
      if (!faces_[i].open) continue;
      const Face& before = faces_[(i + n - 1) % n];
      if (strip.points.empty()) {
        strip.points.push_back(meet(before, faces_[i], depth));
        strip.from_corner = before.open;
      }
      strip.points.push_back(meet(faces_[i], next(i), depth));
      strip.to_corner = next(i).open;
      if (goes_on(i) && k + 1 < n) continue;
      add_strip(strip, depth);
      strip = {};
    }
  }

  void add_strip(const Strip& strip, double depth) {
    double length = 0.0;
    for (std::size_t i = 1; i < strip.points.size(); ++i) {
      length += (strip.points[i] - strip.points[i - 1]).norm();
    }
    const double ends = (strip.from_corner ? 0.0 : 0.5) + (strip.to_corner ? 0.0 : 0.5);
    const double count = std::max(0.0, std::round(length / dx_ - ends));
    const double step = count + ends > 0 ? std::max(length / (count + ends), dx_ / 4) : dx_;
    double wanted = strip.from_corner ? 0.0 : step / 2, done = 0.0;
    for (std::size_t i = 1; i < strip.points.size(); ++i) {
      const Vec2 way = strip.points[i] - strip.points[i - 1];
      for (; wanted <= done + way.norm() + kLayerSlack * dx_; wanted += step) {
        add(strip.points[i - 1] + (wanted - done) * way.normalized(), depth);
      }
      done += way.norm();
    }
  }

  void add(const Vec2& point, double depth) {
    if (!contains(polygon_, point)) return;
    for (const Face& face : faces_) {
      if (!face.open) continue;
      const double along = std::clamp((point - face.begin).dot(face.along), 0.0, face.length);
      const double distance = (point - face.begin - along * face.along).norm();
      if (distance < depth - kLayerSlack * dx_) return;
    }
    made_.add(point, (kApart - kLayerSlack) * dx_);
  }

  const Shape polygon_;
  double dx_;
  std::int64_t layers_;
  const std::function<bool(const Vec2&)>& covered_;
  std::vector<Face> faces_;
  ApartPoints<2> made_;
};

}  // namespace

std::optional<std::vector<Vec2>> face_layers(const Polygon& polygon, const Method& method,
                                             const std::function<bool(const Vec2&)>& covered) {
  FaceLayers layers(polygon, method, covered);
  if (!layers.is_thick()) return std::nullopt;
  return layers.make();
}

}  // namespace sluice

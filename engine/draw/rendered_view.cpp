#include "engine/draw/rendered_view.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

constexpr double kBall = 0.62;  ///< radius over the particles' distance: no gaps between them
constexpr double kLeastRadius = 0.75;  ///< pixels
constexpr double kAmbient = 0.3;       ///< light that comes from everywhere
constexpr double kShadow = 1.6;        ///< how much the pixels around, where nearer, take away
constexpr int kShadowReach = 2;        ///< pixels

struct Axes {
  Vec3 right, up, towards;
};

Axes axes_of(const Camera& camera) {
  const double across = std::cos(camera.elevation);
  const Vec3 towards(std::sin(camera.azimuth) * across, std::sin(camera.elevation),
                     std::cos(camera.azimuth) * across);
  const Vec3 right(std::cos(camera.azimuth), 0.0, -std::sin(camera.azimuth));
  return {right, towards.cross(right), towards};
}

/// Where a box is seen in the picture: to the right and up, m.
Box2 seen_box(const BoxN<3>& box, const Axes& axes) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box2 seen{Vec2::Constant(kFar), Vec2::Constant(-kFar)};
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 place((corner & 1U) != 0 ? box.max.x() : box.min.x(),
                     (corner & 2U) != 0 ? box.max.y() : box.min.y(),
                     (corner & 4U) != 0 ? box.max.z() : box.min.z());
    seen.take_in({axes.right.dot(place), axes.up.dot(place)});
  }
  return seen;
}

/// The outward normal of the face of a box that a point on its surface lies on.
Vec3 face_normal(const BoxN<3>& box, const Vec3& point) {
  Vec3 normal = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const double away = std::abs(point[axis] - (side < 0.0 ? box.min[axis] : box.max[axis]));
      if (away >= least) continue;
      least = away;
      normal = Vec3::Zero();
      normal[axis] = side;
    }
  }
  return normal;
}

/// The outward normal of a shape at a point on its surface.
Vec3 surface_normal(const Shape& shape, const Vec3& point) {
  const double step = 1e-5 * bounds(shape).size().maxCoeff();
  Vec3 slope = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 aside = step * Vec3::Unit(axis);
    slope[axis] =
        signed_distance(shape, Vec(point + aside)) - signed_distance(shape, Vec(point - aside));
  }
  return slope.normalized();
}

}  // namespace

RenderedView view_of_room(const BoxN<3>& room, const Camera& camera) {
  RenderedView view{{}, camera, room};
  view.plane.view = seen_box(room, axes_of(camera));
  return view;
}

RenderedScene::RenderedScene(const Scene& scene, const RenderedView& how)
    : scene_(scene),
      how_(how),
      right_(axes_of(how.camera).right),
      up_(axes_of(how.camera).up),
      towards_(axes_of(how.camera).towards),
      scale_(pixels_per_metre(how.plane)),
      blank_(blank_picture(how.plane)) {
  blank_.palette = Palette::shaded;
  solids_.assign(blank_.pixels.size(),
                 {std::numeric_limits<float>::infinity(), 0.0F, 0.0F, Matter::solid});
  if (scene_.tank) look_at_tank();
  for (const Shape& obstacle : scene_.obstacles) look_at(obstacle);
}

RenderedScene::Ray RenderedScene::ray(int column, int row) const {
  const double across = how_.plane.view.min.x() + (column + 0.5) / scale_;
  const double up = how_.plane.view.max.y() - (row + 0.5) / scale_;
  const Vec3 origin = across * right_ + up * up_;
  LinePart part;
  for (int axis = 0; axis < 3; ++axis) {
    part.keep_between(how_.room.min[axis] - origin[axis], how_.room.max[axis] - origin[axis],
                      -towards_[axis]);
  }
  return {origin, part.enter, part.leave};
}

template <class Visit>
void RenderedScene::for_pixels(const BoxN<3>& box, const Visit& visit) const {
  const Box2 seen = seen_box({box.min.cwiseMax(how_.room.min), box.max.cwiseMin(how_.room.max)},
                             {right_, up_, towards_});
  const Box2& view = how_.plane.view;
  const auto bounded = [](double at, int size) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(size)));
  };
  const int left = bounded((seen.min.x() - view.min.x()) * scale_, blank_.width);
  const int end = bounded((seen.max.x() - view.min.x()) * scale_ + 1.0, blank_.width);
  const int bottom = bounded((view.max.y() - seen.min.y()) * scale_ + 1.0, blank_.height);
  for (int row = bounded((view.max.y() - seen.max.y()) * scale_, blank_.height); row < bottom;
       ++row) {
    for (int column = left; column < end; ++column) {
      visit(column, row,
            static_cast<std::size_t>(row) * static_cast<std::size_t>(blank_.width) +
                static_cast<std::size_t>(column));
    }
  }
}

double RenderedScene::light_on(const Vec3& normal) const {
  // The lamp is above the camera's left shoulder.
  const Vec3 lamp = (towards_ + 0.5 * up_ - 0.4 * right_).normalized();
  return kAmbient + (1.0 - kAmbient) * std::max(normal.dot(lamp), 0.0);
}

void RenderedScene::look_at_tank() {
  const BoxN<3> inside = scene_.tank->interior();
  for_pixels(inside, [&](int column, int row, std::size_t pixel) {
    const Ray seen_by = ray(column, row);
    if (!(seen_by.enter < seen_by.leave)) return;
    // Floor and walls are seen where the ray leaves the tank.
    const Vec3 end = seen_by.origin - seen_by.leave * towards_;
    solids_[pixel] = {static_cast<float>(seen_by.leave),
                      static_cast<float>(light_on(-face_normal(inside, end))), 0.0F, Matter::solid};
  });
}

void RenderedScene::look_at(const Shape& shape) {
  for_pixels(bounds(shape), [&](int column, int row, std::size_t pixel) {
    const Ray seen_by = ray(column, row);
    if (!(seen_by.enter < seen_by.leave)) return;
    const std::vector<double> ends = chords(shape, Vec(seen_by.origin), Vec(-towards_));
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
      if (ends[k + 1] <= seen_by.enter) continue;
      const double depth = std::max(ends[k], seen_by.enter);
      if (depth >= seen_by.leave || static_cast<float>(depth) >= solids_[pixel].depth) return;
      const Vec3 place = seen_by.origin - depth * towards_;
      // The room's end cuts what goes on behind it.
      const Vec3 normal =
          depth > ends[k] ? face_normal(how_.room, place) : surface_normal(shape, place);
      solids_[pixel] = {static_cast<float>(depth), static_cast<float>(light_on(normal)), 0.0F,
                        Matter::solid};
      return;
    }
  });
}

void RenderedScene::look_at_gate(std::vector<Seen>& seen, double time) const {
  if (!scene_.gate) return;
  const double edge = scene_.gate->speed * time;
  if (!(edge < scene_.gate->height)) return;
  const double thickness = std::max(scene_.method.support(), 2.0 / scale_);
  const Cuboid<3> gate{Vec3(scene_.gate->x, edge, how_.room.min.z()),
                       Vec3(thickness, scene_.gate->height - edge, how_.room.size().z())};
  for_pixels(bounds(gate), [&](int column, int row, std::size_t pixel) {
    const std::vector<double> ends = chords(gate, ray(column, row).origin, Vec3(-towards_));
    if (ends.empty() || static_cast<float>(ends.front()) >= seen[pixel].depth) return;
    const Vec3 place = ray(column, row).origin - ends.front() * towards_;
    seen[pixel] = {static_cast<float>(ends.front()),
                   static_cast<float>(light_on(face_normal(bounds(gate), place))), 0.0F,
                   Matter::gate};
  });
}

void RenderedScene::add_ball(std::vector<Seen>& seen, const Vec3& place, double share) const {
  const double radius = std::max(kBall * how_.plane.diameter * scale_, kLeastRadius);
  const double column = (right_.dot(place) - how_.plane.view.min.x()) * scale_ - 0.5;
  const double row = (how_.plane.view.max.y() - up_.dot(place)) * scale_ - 0.5;
  const auto first = [](double at) { return std::max(0, static_cast<int>(std::ceil(at))); };
  const int last_row = std::min(blank_.height - 1, static_cast<int>(std::floor(row + radius)));
  const int last_column = std::min(blank_.width - 1, static_cast<int>(std::floor(column + radius)));
  for (int j = first(row - radius); j <= last_row; ++j) {
    for (int i = first(column - radius); i <= last_column; ++i) {
      const double across = (i - column) / radius, up = (row - j) / radius;
      const double square = 1.0 - across * across - up * up;
      if (square < 0.0) continue;
      const double out = std::sqrt(square);
      const double depth = -towards_.dot(place) - out * radius / scale_;
      Seen& pixel = seen[static_cast<std::size_t>(j) * static_cast<std::size_t>(blank_.width) +
                         static_cast<std::size_t>(i)];
      if (static_cast<float>(depth) >= pixel.depth) continue;
      pixel = {static_cast<float>(depth),
               static_cast<float>(light_on(across * right_ + up * up_ + out * towards_)),
               static_cast<float>(share), Matter::fluid};
    }
  }
}

/// How much of a pixel's light is left beside pixels that lie before it (after C. Boucheny's
/// eye-dome lighting): what shows the shape of a cloud of particles.
double RenderedScene::shadow(const std::vector<Seen>& seen, int column, int row) const {
  const auto depth_at = [&](int i, int j) {
    return seen[static_cast<std::size_t>(j) * static_cast<std::size_t>(blank_.width) +
                static_cast<std::size_t>(i)]
        .depth;
  };
  const double here = depth_at(column, row);
  const double full = 6.0 * how_.plane.diameter;
  double before = 0.0;
  for (const int dj : {-kShadowReach, 0, kShadowReach}) {
    for (const int di : {-kShadowReach, 0, kShadowReach}) {
      const int i = column + di, j = row + dj;
      if (i < 0 || j < 0 || i >= blank_.width || j >= blank_.height) continue;
      before += std::clamp((here - depth_at(i, j)) / full, 0.0, 1.0);
    }
  }
  return std::exp(-kShadow * before / 8.0);
}

Picture RenderedScene::picture(const Snapshot& frame) const {
  std::vector<Seen> seen = solids_;
  look_at_gate(seen, frame.time);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Vec3 place = frame.position_of(i);
    const double value = coloured_value(frame, i, how_.plane.quantity);
    if (how_.room.contains(place) && std::isfinite(value)) {
      add_ball(seen, place, how_.plane.share_of(value));
    }
  }
  Picture picture = blank_;
  std::size_t pixel = 0;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column, ++pixel) {
      const Seen& one = seen[pixel];
      if (!std::isfinite(one.depth)) continue;
      picture.pixels[pixel] =
          shaded_colour(one.matter, one.share, one.light * shadow(seen, column, row));
    }
  }
  return picture;
}

}  // namespace sluice

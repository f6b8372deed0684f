#include "engine/draw/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

/// The middle of a pixel, m.
Vec2 place_of(int column, int row, const PictureView& how) {
  const double scale = pixels_per_metre(how);
  return {how.view.min.x() + (column + 0.5) / scale, how.view.max.y() - (row + 0.5) / scale};
}

/// A canvas that remembers how near each pixel's particle is.
class Canvas {
 public:
  Canvas(Picture& picture, const PictureView& how)
      : scale_(pixels_per_metre(how)),
        view_(how.view),
        radius_(0.75 * how.diameter),
        picture_(picture),
        nearest_(picture.pixels.size(), std::numeric_limits<float>::infinity()) {}

  void disc(const Vec2& place, std::uint8_t index) {
    // Small particles still mark the pixel that they lie in.
    const double reach = std::max(radius_ * scale_, 0.71);
    const double column = (place.x() - view_.min.x()) * scale_ - 0.5;
    const double row = (view_.max.y() - place.y()) * scale_ - 0.5;
    if (!(column > -reach && column < picture_.width + reach)) return;
    if (!(row > -reach && row < picture_.height + reach)) return;
    const auto first = [](double at) { return std::max(0, static_cast<int>(std::ceil(at))); };
    const int last_row = std::min(picture_.height - 1, static_cast<int>(row + reach));
    const int last_column = std::min(picture_.width - 1, static_cast<int>(column + reach));
    for (int j = first(row - reach); j <= last_row; ++j) {
      for (int i = first(column - reach); i <= last_column; ++i) {
        paint(i, j, std::hypot(i - column, j - row), reach, index);
      }
    }
  }

 private:
  void paint(int i, int j, double distance, double reach, std::uint8_t index) {
    const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(picture_.width) +
                    static_cast<std::size_t>(i);
    if (distance > reach || static_cast<float>(distance) >= nearest_[at]) return;
    nearest_[at] = static_cast<float>(distance);
    picture_.pixels[at] = index;
  }

  double scale_;  ///< pixels per metre
  Box2 view_;
  double radius_;
  Picture& picture_;
  std::vector<float> nearest_;
};

/// Fills the pixels whose middle `holds`, within the rows and columns of `box`.
template <class Holds>
void fill(Picture& picture, const PictureView& how, const Box2& box, std::uint8_t index,
          const Holds& holds) {
  const double scale = pixels_per_metre(how);
  const auto bounded = [](double at, int size) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(size)));
  };
  const int left = bounded((box.min.x() - how.view.min.x()) * scale, picture.width);
  const int right = bounded((box.max.x() - how.view.min.x()) * scale + 1.0, picture.width);
  const int top = bounded((how.view.max.y() - box.max.y()) * scale, picture.height);
  const int bottom = bounded((how.view.max.y() - box.min.y()) * scale + 1.0, picture.height);
  for (int row = top; row < bottom; ++row) {
    for (int column = left; column < right; ++column) {
      if (!holds(place_of(column, row, how))) continue;
      picture.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                     static_cast<std::size_t>(column)] = index;
    }
  }
}

/// A place of the picture in the scene.
Vec in_section(const Vec2& place, const Scene& scene, const PictureView& how) {
  if (scene.dimensions() == 2) return place;
  return Vec3(place.x(), place.y(), how.section);
}

}  // namespace

double pixels_per_metre(const PictureView& how) { return how.width / how.view.size().x(); }

Picture blank_picture(const PictureView& how) {
  Picture picture;
  picture.width = how.width;
  picture.height =
      std::max(1, static_cast<int>(std::lround(pixels_per_metre(how) * how.view.size().y())));
  picture.pixels.assign(
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height), kNothing);
  return picture;
}

Picture draw_solids(const Scene& scene, const PictureView& how) {
  Picture picture = blank_picture(how);
  if (const auto& tank = scene.tank) {
    fill(picture, how, how.view, kSolid, [&](const Vec2& p) {
      if (p.y() > tank->height) return !tank->open_top;
      return p.y() < 0.0 || p.x() < 0.0 || p.x() > tank->width;
    });
  }
  for (const Shape& obstacle : scene.obstacles) {
    const Box whole = bounds(obstacle);
    fill(picture, how, Box2{whole.min.head<2>(), whole.max.head<2>()}, kSolid,
         [&](const Vec2& p) { return contains(obstacle, in_section(p, scene, how)); });
  }
  return picture;
}

void draw_gate(Picture& picture, const Scene& scene, const PictureView& how, double time) {
  if (!scene.gate) return;
  const double edge = scene.gate->speed * time;
  if (!(edge < scene.gate->height)) return;
  const double thickness = std::max(scene.method.support(), 2.0 / pixels_per_metre(how));
  const Box2 box{Vec2(scene.gate->x, edge), Vec2(scene.gate->x + thickness, scene.gate->height)};
  fill(picture, how, box, kGate, [&](const Vec2& p) { return box.contains(p); });
}

void draw_particles(Picture& picture, const Snapshot& frame, const PictureView& how) {
  Canvas canvas(picture, how);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Vec place = frame.position_of(i);
    const bool cut = place.size() == 2 || std::abs(place[2] - how.section) <= 0.5 * how.diameter;
    if (cut)
      canvas.disc(place.head<2>(),
                  flat_colour(how.share_of(coloured_value(frame, i, how.quantity))));
  }
}

float coloured_value(const Snapshot& frame, std::size_t i, Quantity quantity) {
  return quantity == Quantity::pressure ? frame.pressure[i] : frame.velocity_of(i).stableNorm();
}

}  // namespace sluice

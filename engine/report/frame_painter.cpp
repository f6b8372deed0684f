#include "engine/report/frame_painter.hpp"

#include "engine/report/snapshots.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

/// From the side that the fluid starts on.
Camera camera_of(const Scene& scene) {
  Camera camera;
  if (scene.fluid.empty()) return camera;
  const auto middle = [](const Shape& shape) { return bounds(shape).middle().x(); };
  double around = scene.tank ? scene.tank->interior().middle().x() : 0.0;
  if (!scene.tank && !scene.obstacles.empty()) around = middle(scene.obstacles.front());
  if (middle(scene.fluid.front().shape) < around) camera.azimuth = -camera.azimuth;
  return camera;
}

}  // namespace

FramePainter::FramePainter(const Scene& scene, const std::optional<Box>& particles, Look look)
    : scene_(scene) {
  if (look == Look::rendered && scene.dimensions() == 3) {
    seen_from_ = view_of_room(picture_room(scene, particles), camera_of(scene));
    how.view = seen_from_->plane.view;
  } else {
    how.view = picture_view(scene, particles);
    how.section = picture_section(scene);
  }
  how.diameter = scene.method.spacing;
}

Picture FramePainter::paint(const Snapshot& frame) {
  if (seen_from_) {
    seen_from_->plane = how;
    if (!rendered_) rendered_.emplace(scene_, *seen_from_);
    return rendered_->picture(frame);
  }
  if (!solids_) solids_ = draw_solids(scene_, how);
  Picture picture = *solids_;
  draw_gate(picture, scene_, how, frame.time);
  draw_particles(picture, frame, how);
  return picture;
}

}  // namespace sluice

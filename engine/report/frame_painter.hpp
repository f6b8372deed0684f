#pragma once

#include <optional>

#include "engine/draw/picture.hpp"
#include "engine/draw/rendered_view.hpp"

namespace sluice {

/// How a scene of space is shown; one of the plane is shown as it is.
enum class Look {
  section,   ///< what a cut through the middle shows
  rendered,  ///< from one side, as a body
};

/// Paints snapshots of a scene, all in one view.
class FramePainter {
 public:
  /// `particles`: the box around all that will be painted, m; a tank needs none.
  FramePainter(const Scene& scene, const std::optional<Box>& particles, Look look);

  PictureView how;  ///< colours and width are the caller's, until the first picture

  [[nodiscard]] Picture paint(const Snapshot& frame);

 private:
  Scene scene_;
  std::optional<RenderedView> seen_from_;
  std::optional<RenderedScene> rendered_;
  std::optional<Picture> solids_;
};

}  // namespace sluice

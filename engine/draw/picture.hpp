#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/draw/palette.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {

/// What gives a particle its colour.
enum class Quantity { pressure, speed };

/// What a picture shows and how values become colours. It looks along z, towards lower z, unless
/// somebody says how else (rendered_view.hpp).
struct PictureView {
  Box2 view;              ///< of x and y, else to the right and up in the picture, m
  double section = 0.0;   ///< in space: the z at which a scene is cut, m
  double diameter = 0.0;  ///< of a particle, m
  double low = 0.0;       ///< Pa or m/s that has the first colour, and everything below
  double high = 1.0;      ///< Pa or m/s that has the last colour, and everything above
  int width = 900;        ///< pixels
  Quantity quantity = Quantity::pressure;

  /// Where a value is between low and high, 0 to 1.
  [[nodiscard]] double share_of(double value) const {
    return std::clamp((value - low) / (high - low), 0.0, 1.0);
  }
};

/// A picture of 256 colours. Rows from the top down.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
  Palette palette = Palette::flat;
};

/// Tank walls and obstacles, without the gate: what all pictures of a scene begin with.
[[nodiscard]] Picture draw_solids(const Scene& scene, const PictureView& how);

/// What is left of the gate at `time` (s): above its lower edge.
void draw_gate(Picture& picture, const Scene& scene, const PictureView& how, double time);

/// Each particle as a disc over what is there; where discs overlap, the nearest particle counts. In
/// space those whose middle is within half a diameter of the section.
/// Particles out of view or not finite are left out. `picture` has the size of `how`.
void draw_particles(Picture& picture, const Snapshot& frame, const PictureView& how);

/// The picture that draw_solids() begins and the others go on with, empty.
[[nodiscard]] Picture blank_picture(const PictureView& how);

/// How many pixels of a picture there are to a metre.
[[nodiscard]] double pixels_per_metre(const PictureView& how);

/// The value of each particle that its colour tells, Pa or m/s.
[[nodiscard]] float coloured_value(const Snapshot& frame, std::size_t i, Quantity quantity);

}  // namespace sluice

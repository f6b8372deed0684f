#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/store/frame_io.hpp"

namespace sluice {

/// What a picture shows and how pressure becomes colour.
struct PictureFrame {
  Box view;               ///< m
  double diameter = 0.0;  ///< of a particle, m
  double low = 0.0;       ///< Pa that has the first colour, and everything below
  double high = 1.0;      ///< Pa that has the last colour, and everything above
  int width = 900;        ///< pixels
};

/// A picture of 256 colours: 0 is transparent, 1 to 255 run from low to high pressure. Rows from
/// the top down.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Each particle as a disc; where discs overlap, the nearest particle counts. Particles out of view
/// or not finite are left out.
[[nodiscard]] Picture draw_particles(const Frame& frame, const PictureFrame& how);

/// The picture as a PNG of its palette. Throws std::runtime_error when the library refuses.
[[nodiscard]] std::string png_of(const Picture& picture);

/// Colour of a share from 0 to 1 as #rrggbb: viridis, which keeps its order in grey.
[[nodiscard]] std::string colour_of(double share);

/// RFC 4648.
[[nodiscard]] std::string base64(const std::string& bytes);

}  // namespace sluice

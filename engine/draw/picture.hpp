#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/model/scene.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {

/// What gives a particle its colour.
enum class Quantity { pressure, speed };

/// What a picture shows and how values become colours. It looks along z, towards lower z.
struct PictureView {
  Box2 view;              ///< of x and y, m
  double section = 0.0;   ///< in space: the z at which a scene is cut, m
  double diameter = 0.0;  ///< of a particle, m
  double low = 0.0;       ///< Pa or m/s that has the first colour, and everything below
  double high = 1.0;      ///< Pa or m/s that has the last colour, and everything above
  int width = 900;        ///< pixels
  Quantity quantity = Quantity::pressure;
};

// What the 256 colours of a picture are.
inline constexpr std::uint8_t kNothing = 0;       ///< transparent, or the ground of an animation
inline constexpr std::uint8_t kFirstColour = 1;   ///< low
inline constexpr std::uint8_t kLastColour = 252;  ///< high
inline constexpr std::uint8_t kSolid = 253;       ///< tank and obstacles
inline constexpr std::uint8_t kGate = 254;
inline constexpr std::uint8_t kInk = 255;  ///< letters

/// A picture of 256 colours. Rows from the top down.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
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

/// The value of each particle that its colour tells, Pa or m/s.
[[nodiscard]] float coloured_value(const Snapshot& frame, std::size_t i, Quantity quantity);

struct Rgb {
  std::uint8_t red, green, blue;
};
/// The colours of a picture's numbers; that of kNothing is for those who cannot be transparent.
[[nodiscard]] const std::array<Rgb, 256>& picture_palette();

/// Colour of a share from 0 to 1 as #rrggbb: viridis, which keeps its order in grey.
[[nodiscard]] std::string colour_of(double share);

}  // namespace sluice

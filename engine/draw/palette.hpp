#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace sluice {

/// Which 256 colours the numbers of a picture are.
enum class Palette {
  flat,    ///< 252 values, the solids in one grey
  shaded,  ///< 18 values, grey and the gate's red, each darker or lighter by the light on it
};

// What the numbers of the flat palette are.
inline constexpr std::uint8_t kNothing = 0;       ///< transparent, or the ground of an animation
inline constexpr std::uint8_t kFirstColour = 1;   ///< low
inline constexpr std::uint8_t kLastColour = 252;  ///< high
inline constexpr std::uint8_t kSolid = 253;       ///< tank and obstacles
inline constexpr std::uint8_t kGate = 254;
inline constexpr std::uint8_t kInk = 255;  ///< letters
// kNothing and kInk are the same in both.

/// What has a colour of its own in a shaded picture.
enum class Matter { fluid, solid, gate };

/// The number of a value in the flat palette, by its share of the scale from 0 to 1.
[[nodiscard]] std::uint8_t flat_colour(double share);

/// The number in the shaded palette, by the share of the scale, which only fluid has, and the
/// light from 0 to 1.
[[nodiscard]] std::uint8_t shaded_colour(Matter matter, double share, double light);

/// The number of a value in full light.
[[nodiscard]] std::uint8_t colour_in(Palette palette, double share);

struct Rgb {
  std::uint8_t red, green, blue;
};
/// The colours of the numbers; that of kNothing is for those who cannot be transparent.
[[nodiscard]] const std::array<Rgb, 256>& colours_of(Palette palette);

/// Colour of a share from 0 to 1 as #rrggbb: viridis, which keeps its order in grey.
[[nodiscard]] std::string colour_of(double share);

}  // namespace sluice

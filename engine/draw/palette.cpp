#include "engine/draw/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sluice {
namespace {

struct Colour {
  double red, green, blue;
};

/// viridis (matplotlib, CC0) at ninths; straight between.
constexpr std::array<Colour, 10> kViridis{{{68, 1, 84},
                                           {72, 40, 120},
                                           {62, 74, 137},
                                           {49, 104, 142},
                                           {38, 130, 142},
                                           {31, 158, 137},
                                           {53, 183, 121},
                                           {109, 205, 89},
                                           {180, 222, 44},
                                           {253, 231, 37}}};
constexpr Colour kGroundColour{246, 248, 250};
constexpr Colour kSolidColour{140, 147, 156};
constexpr Colour kLitSolid{236, 239, 243};  ///< in full light; what lies in shade is darker
constexpr Colour kGateColour{207, 74, 36};
constexpr Colour kInkColour{27, 31, 36};

// The shaded palette: values times shades from 1 on, then greys, then reds.
constexpr int kValues = 18;
constexpr int kShades = 12;
constexpr int kGreys = 24;
constexpr int kFirstGrey = 1 + kValues * kShades;
constexpr int kFirstRed = kFirstGrey + kGreys;
static_assert(kFirstRed + kShades <= kInk);
constexpr double kDarkest = 0.25;  ///< part of a colour that is left without light

Colour viridis(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  const double part = place - static_cast<double>(before);
  const Colour& a = kViridis[before];
  const Colour& b = kViridis[before + 1];
  const auto between = [part](double from, double to) { return from + part * (to - from); };
  return {between(a.red, b.red), between(a.green, b.green), between(a.blue, b.blue)};
}

Rgb rgb(const Colour& colour, double light = 1.0) {
  const double part = kDarkest + (1.0 - kDarkest) * light;
  const auto byte = [part](double value) {
    return static_cast<std::uint8_t>(std::lround(part * value));
  };
  return {byte(colour.red), byte(colour.green), byte(colour.blue)};
}

/// The nearest of `count` steps from 0 to 1.
int step_of(double share, int count) {
  return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * (count - 1)));
}

std::array<Rgb, 256> common_colours() {
  std::array<Rgb, 256> colours{};
  colours[kNothing] = rgb(kGroundColour);
  colours[kInk] = rgb(kInkColour);
  return colours;
}

std::array<Rgb, 256> flat_colours() {
  std::array<Rgb, 256> colours = common_colours();
  for (int i = kFirstColour; i <= kLastColour; ++i) {
    colours[static_cast<std::size_t>(i)] =
        rgb(viridis((i - kFirstColour) / static_cast<double>(kLastColour - kFirstColour)));
  }
  colours[kSolid] = rgb(kSolidColour);
  colours[kGate] = rgb(kGateColour);
  return colours;
}

std::array<Rgb, 256> shaded_colours() {
  std::array<Rgb, 256> colours = common_colours();
  const auto fill = [&](Matter matter, int shades, double share, const Colour& colour) {
    for (int k = 0; k < shades; ++k) {
      const double light = k / static_cast<double>(shades - 1);
      colours[shaded_colour(matter, share, light)] = rgb(colour, light);
    }
  };
  for (int value = 0; value < kValues; ++value) {
    const double share = value / static_cast<double>(kValues - 1);
    fill(Matter::fluid, kShades, share, viridis(share));
  }
  fill(Matter::solid, kGreys, 0.0, kLitSolid);
  fill(Matter::gate, kShades, 0.0, kGateColour);
  return colours;
}

}  // namespace

std::uint8_t flat_colour(double share) {
  return static_cast<std::uint8_t>(kFirstColour + step_of(share, kLastColour - kFirstColour + 1));
}

std::uint8_t shaded_colour(Matter matter, double share, double light) {
  int number = kFirstRed + step_of(light, kShades);
  if (matter == Matter::fluid)
    number = 1 + step_of(share, kValues) * kShades + step_of(light, kShades);
  if (matter == Matter::solid) number = kFirstGrey + step_of(light, kGreys);
  return static_cast<std::uint8_t>(number);
}

std::uint8_t colour_in(Palette palette, double share) {
  return palette == Palette::flat ? flat_colour(share) : shaded_colour(Matter::fluid, share, 1.0);
}

const std::array<Rgb, 256>& colours_of(Palette palette) {
  static const std::array<Rgb, 256> flat = flat_colours();
  static const std::array<Rgb, 256> shaded = shaded_colours();
  return palette == Palette::flat ? flat : shaded;
}

std::string colour_of(double share) {
  const Rgb colour = rgb(viridis(share));
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

}  // namespace sluice

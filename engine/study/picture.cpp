#include "engine/study/picture.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

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

Colour viridis(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  const double part = place - static_cast<double>(before);
  const Colour& a = kViridis[before];
  const Colour& b = kViridis[before + 1];
  return {a.red + part * (b.red - a.red), a.green + part * (b.green - a.green),
          a.blue + part * (b.blue - a.blue)};
}

std::uint8_t index_of(double pressure, const PictureFrame& how) {
  const double share = (pressure - how.low) / (how.high - how.low);
  return static_cast<std::uint8_t>(1.0 + std::round(254.0 * std::clamp(share, 0.0, 1.0)));
}

/// A canvas that remembers how near each pixel's particle is.
class Canvas {
 public:
  Canvas(const PictureFrame& how)
      : scale_(how.width / how.view.size().x()), view_(how.view), radius_(0.75 * how.diameter) {
    picture_.width = how.width;
    picture_.height = std::max(1, static_cast<int>(std::lround(scale_ * how.view.size().y())));
    const auto count =
        static_cast<std::size_t>(picture_.width) * static_cast<std::size_t>(picture_.height);
    picture_.pixels.assign(count, 0);
    nearest_.assign(count, std::numeric_limits<float>::infinity());
  }

  void disc(double x, double y, std::uint8_t index) {
    // Small particles still mark the pixel that they lie in.
    const double reach = std::max(radius_ * scale_, 0.71);
    const double column = (x - view_.min.x()) * scale_ - 0.5;
    const double row = (view_.max.y() - y) * scale_ - 0.5;
    if (!(column > -reach && column < picture_.width + reach)) return;
    if (!(row > -reach && row < picture_.height + reach)) return;
    const auto first = [](double place) { return std::max(0, static_cast<int>(std::ceil(place))); };
    const int last_row = std::min(picture_.height - 1, static_cast<int>(row + reach));
    const int last_column = std::min(picture_.width - 1, static_cast<int>(column + reach));
    for (int j = first(row - reach); j <= last_row; ++j) {
      for (int i = first(column - reach); i <= last_column; ++i) {
        paint(i, j, std::hypot(i - column, j - row), reach, index);
      }
    }
  }

  Picture take() { return std::move(picture_); }

 private:
  void paint(int i, int j, double distance, double reach, std::uint8_t index) {
    const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(picture_.width) +
                    static_cast<std::size_t>(i);
    if (distance > reach || static_cast<float>(distance) >= nearest_[at]) return;
    nearest_[at] = static_cast<float>(distance);
    picture_.pixels[at] = index;
  }

  double scale_;  ///< pixels per metre
  Box view_;
  double radius_;
  Picture picture_;
  std::vector<float> nearest_;
};

}  // namespace

Picture draw_particles(const Frame& frame, const PictureFrame& how) {
  Canvas canvas(how);
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    canvas.disc(frame.x[i], frame.y[i], index_of(frame.pressure[i], how));
  }
  return canvas.take();
}

std::string png_of(const Picture& picture) {
  std::array<std::uint8_t, 4 * 256> palette{};
  for (std::size_t i = 1; i < 256; ++i) {
    const Colour colour = viridis(static_cast<double>(i - 1) / 254.0);
    palette[4 * i] = static_cast<std::uint8_t>(std::lround(colour.red));
    palette[4 * i + 1] = static_cast<std::uint8_t>(std::lround(colour.green));
    palette[4 * i + 2] = static_cast<std::uint8_t>(std::lround(colour.blue));
    palette[4 * i + 3] = 255;
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGBA_COLORMAP;
  image.colormap_entries = 256;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  const int made = png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.pixels.data(),
                                             0, palette.data());
  if (made == 0) throw std::runtime_error(fmt::format("cannot make a PNG: {}", image.message));
  bytes.resize(size);
  return bytes;
}

std::string colour_of(double share) {
  const Colour colour = viridis(share);
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(colour.red), std::lround(colour.green),
                     std::lround(colour.blue));
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace sluice

#include "engine/draw/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace sluice {
namespace {

enum class Ground { transparent, opaque };

std::string encode_png(const Picture& picture, Ground ground) {
  std::array<std::uint8_t, 4 * 256> palette{};
  for (std::size_t i = 0; i < 256; ++i) {
    const Rgb colour = colours_of(picture.palette)[i];
    palette[4 * i] = colour.red;
    palette[4 * i + 1] = colour.green;
    palette[4 * i + 2] = colour.blue;
    palette[4 * i + 3] = i == kNothing && ground == Ground::transparent ? 0 : 255;
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

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8U | static_cast<unsigned char>(bytes[at + k]);
  }
  return value;
}

/// The checksum of PNG's chunks: CRC-32 of ISO 3309.
std::uint32_t chunk_sum(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t value = n;
      for (int bit = 0; bit < 8; ++bit) {
        value = value >> 1U ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
      }
      made[n] = value;
    }
    return made;
  }();
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    sum = table[(sum ^ static_cast<unsigned char>(byte)) & 0xFFU] ^ sum >> 8U;
  }
  return ~sum;
}

/// Length, type, data and checksum.
std::string chunk_of(const std::string& type, std::string_view data) {
  const std::string content = type + std::string(data);
  return big_endian(static_cast<std::uint32_t>(data.size())) + content +
         big_endian(chunk_sum(content));
}

constexpr std::size_t kSignature = 8;

/// Calls back with the type and the data of each chunk of a PNG.
template <class Visit>
void for_chunks(std::string_view png, const Visit& visit) {
  for (std::size_t at = kSignature; at + 12 <= png.size();) {
    const std::size_t length = number_at(png, at);
    visit(png.substr(at + 4, 4), png.substr(at + 8, length));
    at += 12 + length;
  }
}

}  // namespace

std::string png_of(const Picture& picture) { return encode_png(picture, Ground::transparent); }

void PngAnimation::begin(const Picture& picture, const std::string& png) {
  width_ = picture.width;
  height_ = picture.height;
  bytes_ = png.substr(0, kSignature);
  // All that comes before the pixels: they share one palette.
  bool before = true;
  for_chunks(png, [&](std::string_view type, std::string_view data) {
    before = before && type != "IDAT";
    if (!before) return;
    bytes_ += chunk_of(std::string(type), data);
    if (type == "IHDR") {
      bytes_ += chunk_of("acTL", big_endian(pictures_) + big_endian(0));  // 0: for ever
    }
  });
}

void PngAnimation::add(const Picture& picture) {
  const std::string png = encode_png(picture, Ground::opaque);
  if (added_ == 0) begin(picture, png);
  if (picture.width != width_ || picture.height != height_) {
    throw std::invalid_argument("pictures of an animation differ in size");
  }
  std::string control = big_endian(next_sequence_++);
  control += big_endian(static_cast<std::uint32_t>(width_));
  control += big_endian(static_cast<std::uint32_t>(height_)) + big_endian(0) + big_endian(0);
  // The delay as a fraction of a second, then: leave the picture, replace what was there.
  control += big_endian(static_cast<std::uint32_t>(delay_) << 16U | 1000U) + std::string(2, '\0');
  bytes_ += chunk_of("fcTL", control);
  for_chunks(png, [&](std::string_view type, std::string_view data) {
    if (type != "IDAT") return;
    bytes_ += added_ == 0 ? chunk_of("IDAT", data)
                          : chunk_of("fdAT", big_endian(next_sequence_++) + std::string(data));
  });
  ++added_;
}

std::string PngAnimation::take() {
  if (added_ == 0 || added_ != pictures_) {
    throw std::logic_error("an animation of more or fewer pictures than it was made for");
  }
  return std::exchange(bytes_, {}) + chunk_of("IEND", "");
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

#pragma once

#include <cstdint>
#include <string>

#include "engine/draw/picture.hpp"

namespace sluice {

/// The picture as a PNG of its palette, where kNothing is transparent. Throws std::runtime_error
/// when the library refuses.
[[nodiscard]] std::string png_of(const Picture& picture);

/// Pictures of one size one after the other: an animated PNG, which browsers play and others show
/// the first picture of. (https://www.w3.org/TR/png-3/, sections 11.3.6 and 4.9)
class PngAnimation {
 public:
  /// For so many pictures, each shown for `delay` milliseconds.
  PngAnimation(std::uint32_t pictures, std::uint16_t delay) : pictures_(pictures), delay_(delay) {}

  /// Throws std::invalid_argument for a picture of another size, and what png_of throws.
  void add(const Picture& picture);
  /// The file, when all pictures have been added. Throws std::logic_error before.
  [[nodiscard]] std::string take();

 private:
  void begin(const Picture& picture, const std::string& png);

  std::uint32_t pictures_;
  std::uint16_t delay_;
  std::uint32_t added_ = 0;
  std::uint32_t next_sequence_ = 0;
  int width_ = 0, height_ = 0;
  std::string bytes_;
};

/// RFC 4648.
[[nodiscard]] std::string base64(const std::string& bytes);

}  // namespace sluice

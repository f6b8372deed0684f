#include "engine/draw/picture.hpp"
#include "engine/draw/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <limits>

namespace sluice {
namespace {

PictureView unit_square(int pixels) {
  PictureView how;
  how.view = {Vec2::Zero(), Vec2::Ones()};
  how.diameter = 0.1;
  how.low = 0.0;
  how.high = 100.0;
  how.width = pixels;
  return how;
}

Snapshot frame_of(std::vector<float> x, std::vector<float> y, std::vector<float> pressure) {
  Snapshot frame;
  frame.position[0] = std::move(x);
  frame.position[1] = std::move(y);
  frame.pressure = std::move(pressure);
  return frame;
}

Picture drawn(const Snapshot& frame, const PictureView& how) {
  Picture picture = blank_picture(how);
  draw_particles(picture, frame, how);
  return picture;
}

std::uint8_t pixel(const Picture& picture, int column, int row) {
  return picture.pixels.at(static_cast<std::size_t>(row * picture.width + column));
}

TEST(Picture, PutsAParticleWhereItIsWithTheFirstRowOnTop) {
  const Picture picture = drawn(frame_of({0.25F}, {0.85F}, {100.0F}), unit_square(100));
  ASSERT_EQ(picture.width, 100);
  ASSERT_EQ(picture.height, 100);
  EXPECT_EQ(pixel(picture, 25, 15), kLastColour);
  EXPECT_EQ(pixel(picture, 25, 85), 0);
  EXPECT_EQ(pixel(picture, 75, 15), 0);
}

TEST(Picture, ColoursRunFromLowToHighAndStopThere) {
  const Picture picture = drawn(
      frame_of({0.1F, 0.3F, 0.5F, 0.7F}, {0.5F, 0.5F, 0.5F, 0.5F}, {-50.0F, 0.0F, 50.0F, 900.0F}),
      unit_square(100));
  EXPECT_EQ(pixel(picture, 10, 49), 1);
  EXPECT_EQ(pixel(picture, 30, 49), 1);
  EXPECT_EQ(pixel(picture, 50, 49), 127);
  EXPECT_EQ(pixel(picture, 70, 49), kLastColour);
}

TEST(Picture, SurvivesParticlesOutOfViewAndWithoutAPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float far = std::numeric_limits<float>::max();
  const Picture picture =
      drawn(frame_of({nan, far, -far, 2.0F}, {0.5F, 0.5F, nan, 2.0F}, {1.0F, 1.0F, 1.0F, nan}),
            unit_square(50));
  for (const std::uint8_t index : picture.pixels) EXPECT_EQ(index, 0);
}

TEST(Picture, IsAPngThatReadsBackWithItsColours) {
  Picture picture{2, 1, {kNothing, kLastColour}};
  const std::string bytes = png_of(picture);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGBA;
  ASSERT_EQ(image.width, 2u);
  ASSERT_EQ(image.height, 1u);
  std::uint8_t pixels[8] = {};
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels, 0, nullptr), 0);
  EXPECT_EQ(pixels[3], 0) << "the first colour is transparent";
  EXPECT_EQ(pixels[4], 253) << "viridis ends at 253, 231, 37";
  EXPECT_EQ(pixels[5], 231);
  EXPECT_EQ(pixels[6], 37);
  EXPECT_EQ(pixels[7], 255);
}

// RFC 4648, section 10.
TEST(Base64, GivesTheVectorsOfItsStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace sluice

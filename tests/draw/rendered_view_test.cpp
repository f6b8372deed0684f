#include "engine/draw/rendered_view.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

#include "engine/draw/palette.hpp"
#include "engine/scene/checks/parse.hpp"

namespace sluice {
namespace {

/// Tank of 1 m with a block on its floor, and a gate that is up after half a second.
Scene test_scene() {
  const ParseResult parsed = parse_scene(
      R"({"name": "view", "dimensions": 3, "tank": {"width": 1, "height": 1, "depth": 1},
          "gate": {"x": 0.2, "height": 0.5, "speed": 1},
          "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": [0.2, 0.2, 1]}],
          "obstacles": [{"shape": "box", "corner": [0.6, 0, 0.3], "size": [0.3, 0.4, 0.4]}],
          "gravity": [0, -9.81, 0], "resolution": {"spacing": 0.05}, "end_time": 1})",
      StabilityCheck::skip);
  if (!parsed.scene) throw std::runtime_error(parsed.problems.front().message);
  return *parsed.scene;
}

/// From straight ahead: x to the right, y up.
RenderedView from_ahead(double elevation = 0.0) {
  RenderedView how = view_of_room({Vec3::Zero(), Vec3::Ones()}, {0.0, elevation});
  how.plane.width = 100;
  how.plane.diameter = 0.05;
  how.plane.high = 100.0;
  return how;
}

Snapshot frame_of(std::vector<std::array<float, 3>> places, std::vector<float> pressure,
                  double time = 1.0) {
  Snapshot frame = empty_snapshot(0, time, 3);
  for (const std::array<float, 3>& place : places) {
    append(frame.position, place);
    append(frame.velocity, std::array{0.0F, 0.0F, 0.0F});
  }
  frame.pressure = std::move(pressure);
  frame.id.assign(places.size(), 0);
  return frame;
}

std::uint8_t pixel(const Picture& picture, double x, double y) {
  const int column = static_cast<int>(x * picture.width);
  const int row = static_cast<int>((1.0 - y) * picture.height);
  return picture.pixels.at(static_cast<std::size_t>(row * picture.width + column));
}

/// Whether a number is that of `matter` with this share in any light.
bool shows(std::uint8_t number, Matter matter, double share = 0.0) {
  for (int k = 0; k <= 100; ++k) {
    if (shaded_colour(matter, share, 0.01 * k) == number) return true;
  }
  return false;
}

TEST(Palette, GivesEveryMatterAndLightANumberOfItsOwn) {
  EXPECT_NE(shaded_colour(Matter::fluid, 0.0, 0.0), kNothing);
  EXPECT_LT(shaded_colour(Matter::fluid, 1.0, 1.0), shaded_colour(Matter::solid, 0.0, 0.0));
  EXPECT_LT(shaded_colour(Matter::solid, 0.0, 1.0), shaded_colour(Matter::gate, 0.0, 0.0));
  EXPECT_LT(shaded_colour(Matter::gate, 0.0, 1.0), kInk);
  const auto& colours = colours_of(Palette::shaded);
  EXPECT_LT(colours[shaded_colour(Matter::fluid, 1.0, 0.0)].red,
            colours[shaded_colour(Matter::fluid, 1.0, 1.0)].red);
}

TEST(RenderedScene, ShowsAParticleWhereItIsInTheColourOfItsPressure) {
  const RenderedScene scene(test_scene(), from_ahead());
  const Picture picture = scene.picture(frame_of({{0.25F, 0.75F, 0.5F}}, {100.0F}));
  ASSERT_EQ(picture.width, 100);
  ASSERT_EQ(picture.height, 100);
  EXPECT_EQ(picture.palette, Palette::shaded);
  EXPECT_TRUE(shows(pixel(picture, 0.25, 0.75), Matter::fluid, 1.0));
  EXPECT_TRUE(shows(pixel(picture, 0.25, 0.65), Matter::solid)) << "the tank's back";
}

TEST(RenderedScene, TheNearerOneHidesWhatIsBehind) {
  const RenderedScene scene(test_scene(), from_ahead());
  // The first before the block, the second behind it; the third and fourth on one ray.
  const Picture picture = scene.picture(
      frame_of({{0.75F, 0.1F, 0.9F}, {0.75F, 0.3F, 0.1F}, {0.3F, 0.8F, 0.2F}, {0.3F, 0.8F, 0.9F}},
               {100.0F, 100.0F, 0.0F, 100.0F}));
  EXPECT_TRUE(shows(pixel(picture, 0.75, 0.1), Matter::fluid, 1.0));
  EXPECT_TRUE(shows(pixel(picture, 0.75, 0.3), Matter::solid));
  EXPECT_TRUE(shows(pixel(picture, 0.3, 0.8), Matter::fluid, 1.0));
}

TEST(RenderedScene, FacesOfASolidHaveTheirOwnLight) {
  const RenderedView how = from_ahead(0.7);
  const RenderedScene scene(test_scene(), how);
  const Picture picture = scene.picture(frame_of({}, {}));
  const auto at = [&](const Vec3& place) {
    // y and z on the picture's way up.
    const double up = std::cos(0.7) * place.y() - std::sin(0.7) * place.z();
    const Vec2 size = how.plane.view.size();
    return pixel(picture, (place.x() - how.plane.view.min.x()) / size.x(),
                 (up - how.plane.view.min.y()) / size.y());
  };
  const std::uint8_t front = at({0.75, 0.2, 0.7}), top = at({0.75, 0.4, 0.5});
  EXPECT_TRUE(shows(front, Matter::solid));
  EXPECT_TRUE(shows(top, Matter::solid));
  EXPECT_NE(front, top);
}

TEST(RenderedScene, TheGateIsThereAsFarAsItIsNotYetLifted) {
  const RenderedScene scene(test_scene(), from_ahead());
  EXPECT_TRUE(shows(pixel(scene.picture(frame_of({}, {}, 0.0)), 0.22, 0.1), Matter::gate));
  EXPECT_FALSE(shows(pixel(scene.picture(frame_of({}, {}, 0.2)), 0.22, 0.1), Matter::gate));
  EXPECT_TRUE(shows(pixel(scene.picture(frame_of({}, {}, 0.2)), 0.22, 0.4), Matter::gate));
  EXPECT_FALSE(shows(pixel(scene.picture(frame_of({}, {}, 0.6)), 0.22, 0.4), Matter::gate));
}

TEST(RenderedScene, LeavesOutParticlesOutOfTheRoomAndWithoutAPlaceOrAValue) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float far = std::numeric_limits<float>::max();
  const RenderedScene scene(test_scene(), from_ahead());
  const Picture none = scene.picture(frame_of({}, {}));
  const Picture picture = scene.picture(frame_of({{nan, 0.5F, 0.5F},
                                                  {far, 0.5F, 0.5F},
                                                  {0.5F, 0.5F, -far},
                                                  {0.5F, 2.0F, 0.5F},
                                                  {0.1F, 0.9F, 0.5F}},
                                                 {1.0F, 1.0F, 1.0F, 1.0F, nan}));
  EXPECT_EQ(picture.pixels, none.pixels);
}

TEST(RenderedScene, SurfacesBesideWhatIsNearerLieInShade) {
  const RenderedScene scene(test_scene(), from_ahead());
  const Picture none = scene.picture(frame_of({}, {}));
  const Picture one = scene.picture(frame_of({{0.3F, 0.8F, 0.9F}}, {0.0F}));
  // Just outside the ball of 0.62 diameters.
  EXPECT_LT(pixel(one, 0.3 + 0.0425, 0.8), pixel(none, 0.3 + 0.0425, 0.8));
}

}  // namespace
}  // namespace sluice

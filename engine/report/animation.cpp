#include "engine/report/animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/draw/chart.hpp"
#include "engine/draw/picture_text.hpp"
#include "engine/draw/png.hpp"
#include "engine/report/snapshots.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

constexpr int kStrip = 26;  ///< pixels above the picture, for time and colours
constexpr int kSpace = 6;
constexpr int kScale = 120;     ///< pixels of the scale of colours
constexpr int kLeast = 480;     ///< pixels in which the strip has room
constexpr int kLength = 12000;  ///< ms

/// The particles' box over all snapshots, where the scene has no tank that tells the view.
std::optional<Box> moving_box(const std::vector<fs::path>& files) {
  std::optional<Box> box;
  for (const fs::path& path : files) {
    const auto frame = try_snapshot(path);
    if (!frame) continue;
    const auto one = particle_box({&*frame, 1});
    if (!one) continue;
    box = box ? Box{box->min.cwiseMin(one->min), box->max.cwiseMax(one->max)} : *one;
  }
  return box;
}

std::string end_text(const PictureView& how) {
  if (how.quantity == Quantity::speed) return fmt::format("{:.3g} m/s", how.high);
  return how.high >= 1000.0 ? fmt::format("{:.3g} kPa", how.high / 1000.0)
                            : fmt::format("{:.3g} Pa", how.high);
}

/// The picture with a strip above it: time left, scale of colours right.
Picture with_strip(const Picture& picture, const PictureView& how, double time) {
  Picture whole;
  whole.palette = picture.palette;
  whole.width = std::max(picture.width, kLeast);
  whole.height = picture.height + kStrip;
  const auto width = static_cast<std::size_t>(whole.width);
  whole.pixels.assign(width * static_cast<std::size_t>(whole.height), kNothing);
  const auto at = [&](int column, int row) {
    return whole.pixels.begin() + static_cast<std::ptrdiff_t>(row) * whole.width + column;
  };
  for (int row = 0; row < picture.height; ++row) {
    std::copy_n(picture.pixels.begin() + static_cast<std::ptrdiff_t>(row) * picture.width,
                picture.width, at(0, row + kStrip));
  }
  draw_text(whole, kSpace, kSpace, fmt::format("t = {:.4f} s", time));
  const std::string end = end_text(how);
  const int right = whole.width - kSpace - text_width(end);
  const int left = right - kSpace - kScale;
  const std::string begin = how.quantity == Quantity::speed ? "v 0" : "p 0";
  draw_text(whole, left - kSpace - text_width(begin), kSpace, begin);
  draw_text(whole, right, kSpace, end);
  for (int row = kSpace; row < kSpace + kLetterHeight; ++row) {
    for (int k = 0; k < kScale; ++k) {
      *at(left + k, row) = colour_in(picture.palette, k / static_cast<double>(kScale - 1));
    }
  }
  return whole;
}

}  // namespace

std::string animation_png(const fs::path& folder, const Report& report, Quantity quantity,
                          Look look) {
  const Scene& scene = report.scene;
  std::vector<fs::path> files = spread_files(folder, kMostAnimated);
  std::erase_if(files, [](const fs::path& path) { return !try_snapshot(path); });
  if (files.empty()) return {};
  FramePainter painter(scene, scene.tank ? std::nullopt : moving_box(files), look);
  painter.how.quantity = quantity;
  // The colours of the report's pictures.
  painter.how.high = colour_end(picture_snapshots(folder, report), quantity);
  const Vec2 size = painter.how.view.size();
  painter.how.width =
      std::clamp(static_cast<int>(kAnimationHeight * size.x() / size.y()), 16, kAnimationWidth);
  const auto count = static_cast<std::uint32_t>(files.size());
  PngAnimation animation(
      count, static_cast<std::uint16_t>(std::clamp<std::uint32_t>(kLength / count, 20, 500)));
  for (const fs::path& path : files) {
    const Snapshot frame = read_snapshot(path);
    animation.add(with_strip(painter.paint(frame), painter.how, frame.time));
  }
  return animation.take();
}

}  // namespace sluice

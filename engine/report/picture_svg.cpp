#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/draw/picture.hpp"
#include "engine/draw/plot_area.hpp"
#include "engine/draw/png.hpp"
#include "engine/report/figures.hpp"
#include "engine/report/snapshots.hpp"

namespace sluice {
namespace {

constexpr double kWidth = 760.0;
constexpr double kLeft = 56.0;
constexpr double kRight = 16.0;
constexpr double kTop = 46.0;  ///< holds the title and the scale of colours
constexpr double kBarWidth = 190.0;
constexpr double kBottom = 48.0;

/// What the numbers of an axis are counted from: whole metres where it lies so far from zero that
/// its numbers would differ in their last digits only.
double base_of(double low, double high) {
  return std::max(std::abs(low), std::abs(high)) > 1000.0 * (high - low) ? std::floor(low) : 0.0;
}

std::string label_of(std::string_view name, double base) {
  return base == 0.0
             ? fmt::format("{}, m", name)
             : fmt::format("{} {} {:.17g} m, m", name, base > 0.0 ? "-" : "+", std::abs(base));
}

Axis axis_of(std::string_view name, double low, double high) {
  const double base = base_of(low, high);
  return {label_of(name, base), low - base, high - base};
}

/// The plot of a view, to scale.
PlotArea plot_of(const Box2& view) {
  constexpr double kTallest = 420.0;
  const Vec2 size = view.size();
  const double scale = std::min((kWidth - kLeft - kRight) / size.x(), kTallest / size.y());
  return {.x_axis = axis_of("x", view.min.x(), view.max.x()),
          .y_axis = axis_of("y", view.min.y(), view.max.y()),
          .left = kLeft,
          .top = kTop,
          .width = scale * size.x(),
          .height = scale * size.y()};
}

/// With as many numbers as there is room for.
std::string axes(const PlotArea& plot) {
  return plot.axes(TickStyle::outside, std::clamp(static_cast<int>(plot.width / 60.0), 1, 8),
                   std::clamp(static_cast<int>(plot.height / 40.0), 1, 5));
}

/// The scale of colours above the picture's right end, in `unit` Pa or m/s.
std::string colour_bar(const PlotArea& plot, const std::string& name, double high, double unit,
                       std::string_view label) {
  const double x = std::max(kLeft + plot.width, kLeft + 300.0) - kBarWidth;
  std::string stops;
  for (int k = 0; k <= 9; ++k) {
    stops +=
        fmt::format("<stop offset=\"{:.4f}\" stop-color=\"{}\"/>", k / 9.0, colour_of(k / 9.0));
  }
  std::string text = fmt::format(
      "<linearGradient id=\"colours-{0}\">{1}</linearGradient>\n"
      "<rect x=\"{2:.1f}\" y=\"26\" width=\"{3}\" height=\"10\" fill=\"url(#colours-{0})\"/>\n"
      "<text x=\"{4:.1f}\" y=\"35.5\" text-anchor=\"end\">{5}</text>\n",
      name, stops, x, kBarWidth, x - 9.0, label);
  for (const double place : ticks({"", 0.0, high / unit}, 4)) {
    text += fmt::format("<text x=\"{:.1f}\" y=\"20\" text-anchor=\"middle\">{}</text>\n",
                        x + kBarWidth * place * unit / high, tick_text(place));
  }
  return text;
}

/// The scale of colours and the title of a report's pictures.
struct PictureWords {
  double time_unit = 1.0;  ///< s
  double unit = 1.0;       ///< Pa
  bool scaled = false;
  bool kilo = false;

  PictureWords(const Scene& scene, double high) {
    const double gravity = scene.method.gravity.norm();
    scaled = scene.scales && gravity > 0.0;
    if (scaled) {
      unit = scene.method.reference_density * gravity * scene.scales->height;
      time_unit = std::sqrt(scene.scales->height / gravity);
    }
    kilo = !scaled && high >= 2000.0;
    if (kilo) unit = 1e3;
  }
  [[nodiscard]] std::string title(double time) const {
    return scaled ? fmt::format("T = {:.2f} (t = {:.4g} s)", time / time_unit, time)
                  : fmt::format("t = {:.4g} s", time);
  }
  [[nodiscard]] std::string_view label() const { return scaled ? "P" : kilo ? "p, kPa" : "p, Pa"; }
};

std::string image(const PlotArea& plot, const Picture& picture) {
  return fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" "
      "href=\"data:image/png;base64,{}\"/>\n",
      kLeft, kTop, plot.width, plot.height, base64(png_of(picture)));
}

}  // namespace

std::vector<std::string> picture_svgs(const Report& report, const std::vector<Snapshot>& frames,
                                      Look look) {
  FramePainter painter(report.scene, particle_box(frames), look);
  const PlotArea plot = plot_of(painter.how.view);
  painter.how.high = colour_end(frames, painter.how.quantity);
  painter.how.width = std::clamp(static_cast<int>(1.5 * plot.width), 64, 1000);
  const PictureWords words(report.scene, painter.how.high);
  // Seen from one side, lengths along x and z are shortened, and an axis would say nothing.
  const bool to_scale = look == Look::section || report.scene.dimensions() == 2;
  std::vector<std::string> svgs;
  for (const Snapshot& frame : frames) {
    const std::string title = words.title(frame.time);
    std::string text = fmt::format(
        "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {:.0f}\" "
        "role=\"img\">\n<title>Particles at {}, coloured by pressure</title>\n"
        "<text class=\"title\" x=\"{}\" y=\"35.5\">{}</text>\n",
        kWidth, kTop + plot.height + (to_scale ? kBottom : kRight), title, kLeft, title);
    if (to_scale) text += fmt::format("<rect class=\"canvas\" {}/>\n", plot.rectangle());
    text += image(plot, painter.paint(frame));
    if (to_scale) text += axes(plot);
    text += colour_bar(plot, fmt::format("{}-{}", to_scale ? "section" : "view", svgs.size()),
                       painter.how.high, words.unit, words.label());
    if (to_scale) text += fmt::format("<rect class=\"frame\" {}/>\n", plot.rectangle());
    svgs.push_back(text + "</svg>\n");
  }
  return svgs;
}

}  // namespace sluice

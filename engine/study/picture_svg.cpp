#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/study/figures.hpp"
#include "engine/study/picture.hpp"

namespace sluice {
namespace {

constexpr double kWidth = 760.0;
constexpr double kLeft = 56.0;
constexpr double kRight = 96.0;  ///< holds the scale of colours
constexpr double kTop = 30.0;
constexpr double kBottom = 48.0;

/// A common scale of pressures: 0 to what all but one particle in two hundred stay below.
double highest_pressure(const std::vector<Frame>& frames) {
  std::vector<float> all;
  for (const Frame& frame : frames) {
    for (const float pressure : frame.pressure) {
      if (std::isfinite(pressure)) all.push_back(pressure);
    }
  }
  if (all.empty()) return 1.0;
  const auto place = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) * 199 / 200);
  std::nth_element(all.begin(), place, all.end());
  return std::max(static_cast<double>(*place), 1e-9);
}

/// The tank, or the box around all particles.
Box view_of(const Scene& scene, const std::vector<Frame>& frames) {
  if (scene.tank) return {Vec::Zero(), Vec(scene.tank->width, scene.tank->height)};
  Box box{Vec::Constant(INFINITY), Vec::Constant(-INFINITY)};
  for (const Frame& frame : frames) {
    for (std::size_t i = 0; i < frame.x.size(); ++i) {
      const Vec place(frame.x[i], frame.y[i]);
      if (!place.allFinite()) continue;
      box.min = box.min.cwiseMin(place);
      box.max = box.max.cwiseMax(place);
    }
  }
  if (!(box.min.x() <= box.max.x())) return {Vec::Zero(), Vec::Ones()};
  const Vec margin = Vec::Constant(std::max(scene.method.spacing, 0.03 * box.size().maxCoeff()));
  return {box.min - margin, box.max + margin};
}

struct Plot {
  Box view;
  double scale;  ///< units of the view box per metre

  [[nodiscard]] double width() const { return scale * view.size().x(); }
  [[nodiscard]] double height() const { return scale * view.size().y(); }
  [[nodiscard]] double x(double metres) const { return kLeft + scale * (metres - view.min.x()); }
  [[nodiscard]] double y(double metres) const {
    return kTop + height() - scale * (metres - view.min.y());
  }
};

Plot plot_of(const Box& view) {
  constexpr double kTallest = 420.0;
  const Vec size = view.size();
  return {view, std::min((kWidth - kLeft - kRight) / size.x(), kTallest / size.y())};
}

std::string axes(const Plot& plot) {
  std::string text;
  const Axis x{"", plot.view.min.x(), plot.view.max.x()};
  const Axis y{"", plot.view.min.y(), plot.view.max.y()};
  const double bottom = kTop + plot.height();
  for (const double place : ticks(x, 8)) {
    text += fmt::format(
        "<path class=\"frame\" d=\"M{0:.1f} {1:.1f}v5\"/><text x=\"{0:.1f}\" y=\"{2:.1f}\" "
        "text-anchor=\"middle\">{3}</text>\n",
        plot.x(place), bottom, bottom + 19.0, tick_text(place));
  }
  for (const double place : ticks(y, 3)) {
    text += fmt::format(
        "<path class=\"frame\" d=\"M{0} {1:.1f}h-5\"/><text x=\"{2}\" y=\"{3:.1f}\" "
        "text-anchor=\"end\">{4}</text>\n",
        kLeft, plot.y(place), kLeft - 8.0, plot.y(place) + 4.5, tick_text(place));
  }
  return text + fmt::format(
                    "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">x, m</text>\n"
                    "<text transform=\"translate(14 {:.1f}) rotate(-90)\" "
                    "text-anchor=\"middle\">y, m</text>\n",
                    kLeft + 0.5 * plot.width(), bottom + 40.0, kTop + 0.5 * plot.height());
}

/// The scale of colours right of the picture, in `unit` Pa.
std::string colour_bar(const Plot& plot, std::size_t number, double high, double unit,
                       std::string_view label) {
  const double x = kLeft + plot.width() + 18.0;
  std::string stops;
  for (int k = 0; k <= 9; ++k) {
    stops +=
        fmt::format("<stop offset=\"{:.4f}\" stop-color=\"{}\"/>", k / 9.0, colour_of(k / 9.0));
  }
  std::string text = fmt::format(
      "<linearGradient id=\"colours-{0}\" x1=\"0\" y1=\"1\" x2=\"0\" "
      "y2=\"0\">{1}</linearGradient>\n"
      "<rect x=\"{2:.1f}\" y=\"{3}\" width=\"14\" height=\"{4:.1f}\" "
      "fill=\"url(#colours-{0})\"/>\n",
      number, stops, x, kTop, plot.height());
  for (const double place : ticks({"", 0.0, high / unit}, 6)) {
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 20.0,
                        kTop + plot.height() * (1.0 - place * unit / high) + 4.5, tick_text(place));
  }
  return text + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x, kTop - 9.0, label);
}

std::string image(const Plot& plot, const Frame& frame, const Scene& scene, double high) {
  const int pixels = std::clamp(static_cast<int>(1.5 * plot.width()), 64, 1000);
  const Picture picture =
      draw_particles(frame, {plot.view, scene.method.spacing, 0.0, high, pixels});
  return fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" "
      "href=\"data:image/png;base64,{}\"/>\n",
      kLeft, kTop, plot.width(), plot.height(), base64(png_of(picture)));
}

}  // namespace

std::vector<std::string> picture_svgs(const Report& report, const std::vector<Frame>& frames) {
  const Scene& scene = report.scene;
  const double gravity = scene.method.gravity.norm();
  const bool scaled = scene.scales && gravity > 0.0;
  const double unit =
      scaled ? scene.method.reference_density * gravity * scene.scales->height : 1.0;
  const double time = scaled ? std::sqrt(scene.scales->height / gravity) : 1.0;
  const double high = highest_pressure(frames);
  const Plot plot = plot_of(view_of(scene, frames));
  std::vector<std::string> svgs;
  for (const Frame& frame : frames) {
    const std::string title = scaled ? fmt::format("T = {:.2f}", frame.time / time)
                                     : fmt::format("t = {:.4g} s", frame.time);
    std::string text = fmt::format(
        "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {:.0f}\" "
        "role=\"img\">\n<title>Particles at {}, coloured by pressure</title>\n"
        "<text class=\"title\" x=\"{}\" y=\"17\">{}</text>\n",
        kWidth, kTop + plot.height() + kBottom, title, kLeft, title);
    text += fmt::format(
        "<rect class=\"canvas\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", kLeft,
        kTop, plot.width(), plot.height());
    text += image(plot, frame, scene, high) + axes(plot);
    text += colour_bar(plot, svgs.size(), high, unit, scaled ? "P" : "p, Pa");
    text += fmt::format(
        "<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n</svg>\n",
        kLeft, kTop, plot.width(), plot.height());
    svgs.push_back(std::move(text));
  }
  return svgs;
}

}  // namespace sluice

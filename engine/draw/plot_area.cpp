#include "engine/draw/plot_area.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/draw/markup.hpp"

namespace sluice {
namespace {

// From the frame to the numbers and the labels, in units of the view box.
constexpr double kNumbersBelow = 18.0;
constexpr double kNumbersBeside = 7.0;
constexpr double kHalfDigit = 4.5;
constexpr double kLabelBelow = 40.0;
constexpr double kLabelFromTheEdge = 16.0;

double share(const Axis& axis, double value) {
  if (axis.scale == AxisScale::linear) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

}  // namespace

double PlotArea::x(double value) const { return left + share(x_axis, value) * width; }

double PlotArea::y(double value) const { return top + (1.0 - share(y_axis, value)) * height; }

std::string PlotArea::rectangle() const {
  return fmt::format("x=\"{}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"", left, top, width,
                     height);
}

std::string PlotArea::axes(TickStyle style, int ticks_along_x, int ticks_along_y) const {
  const bool grid = style == TickStyle::grid;
  std::string text;
  for (const double place : ticks(x_axis, ticks_along_x)) {
    const std::string line =
        grid ? fmt::format("class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"", x(place), top, bottom())
             : fmt::format("class=\"frame\" d=\"M{:.1f} {:.1f}v5\"", x(place), bottom());
    text +=
        fmt::format("<path {}/><text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                    line, x(place), bottom() + kNumbersBelow, tick_text(place));
  }
  for (const double place : ticks(y_axis, ticks_along_y)) {
    const std::string line =
        grid ? fmt::format("class=\"grid\" d=\"M{} {:.1f}H{:.1f}\"", left, y(place), right())
             : fmt::format("class=\"frame\" d=\"M{} {:.1f}h-5\"", left, y(place));
    text += fmt::format("<path {}/><text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                        line, left - kNumbersBeside, y(place) + kHalfDigit, tick_text(place));
  }
  return text + fmt::format(
                    "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n"
                    "<text transform=\"translate({} {:.1f}) rotate(-90)\" "
                    "text-anchor=\"middle\">{}</text>\n",
                    left + 0.5 * width, bottom() + kLabelBelow, escaped(x_axis.label),
                    kLabelFromTheEdge, top + 0.5 * height, escaped(y_axis.label));
}

}  // namespace sluice

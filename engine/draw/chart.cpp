#include "engine/draw/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "engine/draw/markup.hpp"
#include "engine/draw/plot_area.hpp"
#include "engine/scene/format/code_points.hpp"

namespace sluice {
namespace {

// Lengths in units of the view box, which are pixels at the size charts are made for.
constexpr double kWidth = 560.0;
constexpr double kPlotHeight = 270.0;
constexpr double kLeft = 64.0;    ///< more where the numbers of the y axis are long
constexpr double kYLabel = 34.0;  ///< room of the y axis's label and gaps
constexpr double kDigit = 8.2;    ///< width of a digit at 13 units
constexpr double kRight = 18.0;
constexpr double kTitleHeight = 26.0;
constexpr double kLegendRow = 20.0;
constexpr double kLegendKey = 34.0;
constexpr double kBottom = 50.0;
constexpr int kTicksAlongX = 8;
constexpr int kTicksAlongY = 6;
constexpr double kLetter = 6.9;  ///< mean width of a letter at 13 units: for the legend's rows only

constexpr std::array<std::string_view, 6> kInkNames{"simulation", "experiment", "first",
                                                    "second",     "third",      "fourth"};
std::string_view class_of(Ink ink) { return kInkNames[static_cast<std::size_t>(ink)]; }

struct Point {
  double x, y;
};

/// The points of one pixel column, as few as draw the same: the first, the extremes, the last.
void thin(const std::vector<Point>& column, std::vector<Point>& out) {
  if (column.size() <= 4) {
    out.insert(out.end(), column.begin(), column.end());
    return;
  }
  const auto by_height = [](const Point& a, const Point& b) { return a.y < b.y; };
  auto [low, high] = std::minmax_element(column.begin(), column.end(), by_height);
  if (high < low) std::swap(low, high);
  out.push_back(column.front());
  out.push_back(*low);
  out.push_back(*high);
  out.push_back(column.back());
}

std::vector<Point> thinned(const std::vector<Point>& points) {
  std::vector<Point> out, column;
  for (const Point& point : points) {
    if (!column.empty() && std::floor(point.x) != std::floor(column.front().x)) {
      thin(column, out);
      column.clear();
    }
    column.push_back(point);
  }
  thin(column, out);
  return out;
}

std::string path_of(const std::vector<Point>& points) {
  std::string path;
  for (const Point& point : points) {
    fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? "M" : " ", point.x,
                   point.y);
  }
  return path;
}

/// A line far off the plot is cut near it, so that no number is absurd.
double tame(double place) { return std::clamp(place, -2000.0, 3000.0); }

/// One path per stretch without NaN.
std::string line_paths(const PlotArea& frame, const std::vector<double>& x,
                       const std::vector<double>& y) {
  std::string paths;
  std::vector<Point> points;
  const auto finish = [&] {
    if (points.size() > 1) paths += path_of(thinned(points));
    points.clear();
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(y[i]) && x[i] >= frame.x_axis.low && x[i] <= frame.x_axis.high) {
      points.push_back({frame.x(x[i]), tame(frame.y(y[i]))});
    } else {
      finish();
    }
  }
  finish();
  return paths;
}

std::string band_svg(const PlotArea& frame, const ChartBand& band) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < band.x.size(); ++i) {
    points.push_back({frame.x(band.x[i]), tame(frame.y(band.high[i]))});
  }
  for (std::size_t i = band.x.size(); i-- > 0;) {
    points.push_back({frame.x(band.x[i]), tame(frame.y(band.low[i]))});
  }
  return fmt::format("<path class=\"band\" d=\"{}Z\"/>\n", path_of(points));
}

std::string mark_svg(Ink ink, double x, double y) {
  if (ink == Ink::experiment) {
    return fmt::format("<circle class=\"mark experiment\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\"/>",
                       x, y);
  }
  if (ink == Ink::second) {
    return fmt::format("<path class=\"mark second\" d=\"M{:.1f} {:.1f}l7 7m0 -7l-7 7\"/>", x - 3.5,
                       y - 3.5);
  }
  return fmt::format("<path class=\"mark {}\" d=\"M{:.1f} {:.1f}l4.4 4.4l-4.4 4.4l-4.4 -4.4Z\"/>",
                     class_of(ink), x, y - 4.4);
}

std::string bar_svg(Ink ink, double x, double from, double to) {
  return fmt::format("<path class=\"mark {}\" d=\"M{:.1f} {:.1f}h8m-4 0V{:.1f}m-4 0h8\"/>",
                     class_of(ink), x - 4.0, from, to);
}

std::string marks_svg(const PlotArea& frame, const ChartMarks& marks) {
  std::string text;
  for (std::size_t i = 0; i < marks.x.size(); ++i) {
    const bool drawn = std::isfinite(marks.y[i]) && marks.x[i] >= frame.x_axis.low &&
                       marks.x[i] <= frame.x_axis.high;
    if (!drawn) continue;
    const double x = frame.x(marks.x[i]);
    const double y = tame(frame.y(marks.y[i]));
    if (i < marks.low.size() && marks.high[i] > marks.low[i]) {
      text += bar_svg(marks.ink, x, tame(frame.y(marks.low[i])), tame(frame.y(marks.high[i])));
    }
    text += mark_svg(marks.ink, x, y);
    if (!marks.labels.empty()) {
      const bool left = x > kWidth - 110.0;
      text += fmt::format("<text class=\"word\" x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>",
                          left ? x - 7.0 : x + 7.0, y - 5.0, left ? " text-anchor=\"end\"" : "",
                          escaped(marks.labels[i]));
    }
    text += '\n';
  }
  return text;
}

/// One entry of the legend: a key of 26 by 12 units around (13, 0), and its name.
struct LegendEntry {
  std::string key;
  std::string name;
};

std::vector<LegendEntry> legend_of(const Chart& chart) {
  std::vector<LegendEntry> entries;
  for (const ChartLine& line : chart.lines) {
    if (line.name.empty()) continue;
    entries.push_back(
        {fmt::format("<path class=\"line {}\" d=\"M0 0h26\"/>", class_of(line.ink)), line.name});
  }
  for (const ChartMarks& marks : chart.marks) {
    if (marks.name.empty()) continue;
    std::string key = mark_svg(marks.ink, 13.0, 0.0);
    if (!marks.low.empty()) key += bar_svg(marks.ink, 13.0, 7.0, -7.0);
    entries.push_back({std::move(key), marks.name});
  }
  for (const ChartBand& band : chart.bands) {
    if (band.name.empty()) continue;
    entries.push_back(
        {"<rect class=\"band\" x=\"0\" y=\"-6\" width=\"26\" height=\"12\"/>", band.name});
  }
  return entries;
}

/// The legend from y = 0 down, and how many rows it took.
struct Legend {
  std::string svg;
  int rows = 0;
};

Legend lay_out(const std::vector<LegendEntry>& entries) {
  Legend legend;
  double x = kLeft;
  for (const LegendEntry& entry : entries) {
    const auto letters = static_cast<double>(count_code_points(entry.name));
    const double width = kLegendKey + kLetter * letters + 18.0;
    if (legend.rows == 0 || (x > kLeft && x + width > kWidth)) {
      ++legend.rows;
      x = kLeft;
    }
    legend.svg += fmt::format(
        "<g transform=\"translate({:.1f} {:.1f})\">{}<text x=\"{}\" y=\"4.5\">{}</text></g>\n", x,
        (legend.rows - 0.5) * kLegendRow, entry.key, kLegendKey, escaped(entry.name));
    x += width;
  }
  return legend;
}

/// Where the plot begins, so that its label stands clear of its numbers.
double left_of(const Chart& chart) {
  std::size_t longest = 0;
  for (const double place : ticks(chart.y, kTicksAlongY)) {
    longest = std::max(longest, tick_text(place).size());
  }
  return std::max(kLeft, kYLabel + kDigit * static_cast<double>(longest));
}

std::string notes_svg(const PlotArea& frame, const std::vector<std::string>& notes) {
  std::string text;
  double y = frame.bottom() + kBottom + 10.0;
  for (const std::string& note : notes) {
    text += fmt::format("<text x=\"{}\" y=\"{:.1f}\">{}</text>\n", frame.left, y, escaped(note));
    y += kLegendRow;
  }
  return text;
}

std::string content_svg(const PlotArea& frame, const Chart& chart) {
  std::string text;
  for (const ChartBand& band : chart.bands) text += band_svg(frame, band);
  for (const ChartLine& line : chart.lines) {
    text += fmt::format("<path class=\"line {}\" d=\"{}\"/>\n", class_of(line.ink),
                        line_paths(frame, line.x, line.y));
  }
  for (const ChartMarks& marks : chart.marks) text += marks_svg(frame, marks);
  return text;
}

/// What stands inside the element of a chart, and its height.
struct ChartBody {
  std::string svg;
  double height = 0.0;
};

ChartBody body_of(const Chart& chart) {
  const Legend legend = lay_out(legend_of(chart));
  const double left = left_of(chart);
  const PlotArea frame{.x_axis = chart.x,
                       .y_axis = chart.y,
                       .left = left,
                       .top = kTitleHeight + legend.rows * kLegendRow + 6.0,
                       .width = kWidth - left - kRight,
                       .height = kPlotHeight};
  std::string text = fmt::format("<text class=\"title\" x=\"{}\" y=\"17\">{}</text>\n", kLeft,
                                 escaped(chart.title));
  text += fmt::format("<g transform=\"translate(0 {})\">\n{}</g>\n", kTitleHeight, legend.svg);
  text += frame.axes(TickStyle::grid, kTicksAlongX, kTicksAlongY) + notes_svg(frame, chart.notes);
  text += fmt::format(
      "<clipPath id=\"clip-{}\"><rect {}/></clipPath>\n<g clip-path=\"url(#clip-{})\">\n{}</g>\n",
      chart.id, frame.rectangle(), chart.id, content_svg(frame, chart));
  text += fmt::format("<rect class=\"frame\" {}/>\n", frame.rectangle());
  return {std::move(text),
          frame.bottom() + kBottom + kLegendRow * static_cast<double>(chart.notes.size())};
}

std::string opening(double width, double height, SvgPlace place, std::string_view title) {
  std::string text = fmt::format(
      "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {:.0f}\" "
      "role=\"img\"{}>\n<title>{}</title>\n",
      width, height,
      place == SvgPlace::file ? fmt::format(" width=\"{}\" height=\"{:.0f}\"", width, height) : "",
      escaped(std::string(title)));
  if (place == SvgPlace::file) {
    text += fmt::format(
        "<style>{}</style>\n<rect width=\"100%\" height=\"100%\" "
        "style=\"fill: var(--halo)\"/>\n",
        chart_style());
  }
  return text;
}

}  // namespace

std::string chart_svg(const Chart& chart, SvgPlace place) {
  const ChartBody body = body_of(chart);
  return opening(kWidth, body.height, place, chart.title) + body.svg + "</svg>\n";
}

std::string sheet_svg(const std::vector<Chart>& charts, std::size_t columns,
                      std::string_view title) {
  std::string text;
  double top = 0.0;
  double height = 0.0;
  for (std::size_t k = 0; k < charts.size(); ++k) {
    const std::size_t column = k % columns;
    if (column == 0) top += std::exchange(height, 0.0);
    const ChartBody body = body_of(charts[k]);
    text += fmt::format("<g transform=\"translate({} {:.0f})\">\n{}</g>\n",
                        kWidth * static_cast<double>(column), top, body.svg);
    height = std::max(height, body.height);
  }
  const double width = kWidth * static_cast<double>(std::min(columns, charts.size()));
  return opening(width, top + height, SvgPlace::file, title) + text + "</svg>\n";
}

}  // namespace sluice

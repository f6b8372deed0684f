#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sluice {

// Charts as SVG: no script, nothing loaded from elsewhere, colours for light and dark pages.

enum class AxisScale { linear, logarithmic };

struct Axis {
  std::string label;  ///< with its unit or its definition
  double low = 0.0;
  double high = 1.0;
  AxisScale scale = AxisScale::linear;
};

/// Which colour and dash of the page's style something has.
enum class Ink { simulation, experiment, first, second, third, fourth };

struct ChartLine {
  std::string name;  ///< for the legend; empty: not in it
  Ink ink = Ink::simulation;
  std::vector<double> x, y;  ///< a NaN in y interrupts the line
};

/// The area between two lines.
struct ChartBand {
  std::string name;
  std::vector<double> x, low, high;
};

/// Points, each with a bar from `low` to `high` where those are given.
struct ChartMarks {
  std::string name;
  Ink ink = Ink::experiment;
  std::vector<double> x, y;
  std::vector<double> low, high;    ///< empty, or as long as x
  std::vector<std::string> labels;  ///< empty, or a word beside each point
};

struct Chart {
  std::string id;  ///< unique in its page: letters, digits and -
  std::string title;
  Axis x, y;
  std::vector<ChartBand> bands;
  std::vector<ChartLine> lines;
  std::vector<ChartMarks> marks;
  std::vector<std::string> notes;  ///< lines below the plot, such as what labels stand for
};

/// Limits that hold all finite values with some room, on ticks; zero is a limit where it is near.
/// A logarithmic axis takes positive values only; a linear one spans at least a tenth of the
/// values, so that noise on a constant is not drawn as tall as the plot.
void fit_axis(Axis& axis, const std::vector<double>& values);

/// Limits that end where the finite values do, for times; fit_axis() where there are not two.
void hold_axis(Axis& axis, const std::vector<double>& values);

/// Whether the SVG stands in a page with chart_style() or is a file of its own.
enum class SvgPlace { page, file };

/// One chart. The legend stands above the plot, so it covers nothing; a line of more points than
/// pixels is thinned to its extremes per pixel column.
[[nodiscard]] std::string chart_svg(const Chart& chart, SvgPlace place);

/// Several charts as one file, row by row with `columns` (at least 1) in each.
[[nodiscard]] std::string sheet_svg(const std::vector<Chart>& charts, std::size_t columns,
                                    std::string_view title);

/// The CSS of charts and pictures, for a light and a dark page.
[[nodiscard]] std::string_view chart_style();

/// Positions of ticks from low to high, 1, 2 or 5 times a power of ten apart, about `wanted` of
/// them; for a logarithmic axis the powers of ten, with 2 and 5 between where there are few.
[[nodiscard]] std::vector<double> ticks(const Axis& axis, int wanted);

/// A tick's number, without trailing zeros; a power of ten as such on logarithmic axes.
[[nodiscard]] std::string tick_text(double value);

}  // namespace sluice

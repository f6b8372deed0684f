#pragma once

#include <string>

#include "engine/draw/chart.hpp"

namespace sluice {

/// What marks the numbers of an axis.
enum class TickStyle {
  grid,     ///< a line across the plot
  outside,  ///< a short one beyond it, for pictures
};

/// A rectangle with two axes, in units of the view box: from values to places in an SVG.
struct PlotArea {
  Axis x_axis, y_axis;
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;

  [[nodiscard]] double x(double value) const;
  [[nodiscard]] double y(double value) const;
  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
  /// The attributes x, y, width and height.
  [[nodiscard]] std::string rectangle() const;
  /// Ticks with their numbers, about so many along each axis, and the axes' labels.
  [[nodiscard]] std::string axes(TickStyle style, int ticks_along_x, int ticks_along_y) const;
};

}  // namespace sluice

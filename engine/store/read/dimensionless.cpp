#include "engine/store/read/dimensionless.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sluice {

Divisors dimensionless_divisors(const Scene& scene, const Series& series) {
  const double gravity = scene.method.gravity.norm();
  if (!scene.scales || !(gravity > 0.0)) {
    throw std::invalid_argument(
        "this scene has no dimensionless form: it needs the keys scales and gravity");
  }
  const double height = scene.scales->height;
  const double width = scene.scales->width;
  const double pressure = scene.method.reference_density * gravity * height;
  const double time = std::sqrt(height / gravity);
  if (series.kind == "pressure") return {time, pressure, "P"};
  if (series.kind == "surface_height" || series.kind == "column_height") return {time, height, "H"};
  if (series.kind == "surge_front") return {time, width, "X"};
  if (series.kind == "energy") return {time, pressure * height * width, "E"};
  if (series.kind == "arrival") return {time, time, "T"};
  throw std::invalid_argument(
      fmt::format("series {} is of the unknown kind {}", series.name, series.kind));
}

Series dimensionless(Series series, const Divisors& divisors) {
  for (double& time : series.time) time /= divisors.time;
  for (double& duration : series.duration) duration /= divisors.time;
  for (double& value : series.values) value /= divisors.value;
  for (Series::Column& column : series.columns) column.unit = std::string(1, '1');
  return series;
}

}  // namespace sluice

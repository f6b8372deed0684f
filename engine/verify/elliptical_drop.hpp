#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine/study/convergence.hpp"
#include "engine/study/table.hpp"
#include "engine/verify/case_runner.hpp"

namespace sluice {

/// Of a coordinate of the particles of an ellipse about the origin: a quarter of its semi-axis
/// squared.
[[nodiscard]] double mean_square(const std::vector<double>& values);

/// Semi-axis along y over the radius, at the time A t, of a round drop that starts with
/// v = A (-x, y): it stays an ellipse of the same area and, since nothing acts on it, keeps its
/// kinetic energy, so that s'^2 (1 + s^-4) = 2 A^2 (Monaghan, J. Comput. Phys. 110 (1994) 399).
[[nodiscard]] double drop_stretch(double a_t);

/// The drop at one spacing.
struct DropPoint {
  double spacing = 0.0;  ///< in radii
  double stretch = 0.0;  ///< root mean square of y over that at the start
  double exact = 0.0;    ///< at the time that the run ended
  double particles = 0.0;

  [[nodiscard]] double ratio() const { return stretch / exact; }
  [[nodiscard]] double error() const { return std::abs(ratio() - 1.0); }
};

/// A run of the drop; no point when it did not end well.
struct DropRun {
  CaseRun run;
  std::optional<DropPoint> point;
};

/// Runs the drop to A t = 0.8, with A = 1/s and R = 1 m.
[[nodiscard]] DropRun run_drop(CaseRunner& bench, int per_radius);

/// Runs the drop with R/dx = 10, 20, 40 and 80 (quick: 10, 15, 20, 30) one after another. Throws
/// std::runtime_error when a run does not end well.
[[nodiscard]] std::vector<DropPoint> run_drops(CaseRunner& bench);

/// What the drops say of the order of the scheme: errors and their order, Richardson's limit and
/// grid convergence index of the stretch.
struct DropOrder {
  std::vector<Refined> errors;  ///< |stretch/exact - 1|, finest first
  std::optional<double> order;
  std::optional<Richardson> richardson;  ///< of stretch/exact
};
[[nodiscard]] DropOrder order_of(const std::vector<DropPoint>& points);

[[nodiscard]] Table drop_table(const std::vector<DropPoint>& points);
[[nodiscard]] nlohmann::ordered_json drop_json(const std::vector<DropPoint>& points);

}  // namespace sluice

#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/sph/method/method.hpp"

namespace sluice {

/// What small noise on a free patch of 20 x 20 lattice particles at rest does in a run: no walls,
/// no gravity, double precision, velocities of 1e-9 c, so that nothing but the linear scheme acts.
/// With `displacement` the particles stand up to that many spacings off the lattice, either way.
struct NoiseGrowth {
  bool grows = false;   ///< beyond a hundredfold
  double factor = 0.0;  ///< largest speed at the end over that at the start
  int steps = 0;        ///< until it had grown beyond doubt, or `most_steps`
};
[[nodiscard]] NoiseGrowth measure_noise(const Method& method, int most_steps,
                                        double displacement = 0.0);

/// One cell of the map.
struct StabilityCell {
  double courant = 0.0;
  double growth_per_step = 0.0;  ///< predicted: spectral radius - 1
  bool predicted_stable = true;
  NoiseGrowth measured;
  [[nodiscard]] bool agrees() const { return predicted_stable != measured.grows; }
};

/// Cells of one integrator, alpha and delta, around the predicted limit.
struct StabilityRow {
  Integrator integrator = Integrator::modified_leap_frog;
  double alpha = 0.0;
  double delta = 0.0;
  double limit = 0.0;  ///< predicted, Courant number
  std::vector<StabilityCell> cells;

  /// Measured limit: the middle between the last stable and the first growing cell; 0 where the
  /// first one grows.
  [[nodiscard]] double measured_limit() const;
};

struct StabilityMap {
  std::vector<StabilityRow> rows;
  [[nodiscard]] std::size_t cells() const;
  [[nodiscard]] std::size_t disagreements() const;
};

/// Predicted and measured limits over (C, alpha, delta) for both integrators, the paper's kernel
/// and h = dx. `done` hears of each row. Takes about a minute.
[[nodiscard]] StabilityMap make_stability_map(const std::function<void(const StabilityRow&)>& done);

[[nodiscard]] std::string map_text_line(const StabilityRow& row);
[[nodiscard]] nlohmann::ordered_json map_json(const StabilityMap& map);
/// One panel for each integrator: Courant number to the right, a line for each alpha and delta;
/// full marks are stable, hollow ones grow, crossed ones differ from the prediction.
[[nodiscard]] std::string map_svg(const StabilityMap& map);

}  // namespace sluice

#pragma once

#include <cmath>
#include <vector>

#include "engine/store/files/series.hpp"

namespace sluice::test {

/// A sensor P1 that was sampled every millisecond from t = 0 on, Pa; dry where a value is NaN.
[[nodiscard]] inline Series pressure_series(const std::vector<double>& values) {
  Series series;
  series.name = "P1";
  series.kind = "pressure";
  series.columns = {{"value", "Pa"}};
  for (std::size_t n = 0; n < values.size(); ++n) {
    series.time.push_back(0.001 * static_cast<double>(n));
    series.duration.push_back(n == 0 ? 0.0 : 0.001);
    series.weight.push_back(std::isnan(values[n]) ? 0.0 : 1.0);
  }
  series.values = values;
  series.next_index = values.size();
  return series;
}

}  // namespace sluice::test

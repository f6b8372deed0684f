#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sluice {

/// Raw samples of one sensor. `values` holds `columns.size()` numbers per sample, row by row; a dry
/// sample is NaN, or the pressure of the air where a scene names it, with weight 0.
struct Series {
  struct Column {
    std::string name;  ///< "value" where a sensor has one
    std::string unit;  ///< SI
  };
  std::string name;
  std::string kind;
  std::vector<Column> columns;
  std::vector<double> time;      ///< s, strictly increasing
  std::vector<double> duration;  ///< Dt_n that the sample stands for in eq. 12: time since the
                                 ///< sensor's last sample, s
  std::vector<double> values;
  std::vector<double> weight;  ///< kernel weight that carried the value, dimensionless
  std::uint64_t next_index =
      0;  ///< the next sample is due at the first step with time >= next_index * interval

  [[nodiscard]] std::size_t size() const { return time.size(); }
  /// What was got of the interval that the scene asks for, s: no shorter than a time step. Nothing
  /// of fewer than two samples.
  [[nodiscard]] std::optional<double> mean_interval() const {
    if (size() < 2) return std::nullopt;
    return (time.back() - time.front()) / static_cast<double>(size() - 1);
  }
  friend bool operator==(const Series&, const Series&) = default;
};

}  // namespace sluice

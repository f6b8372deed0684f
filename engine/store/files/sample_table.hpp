#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/store/files/series.hpp"

namespace sluice {

/// Raw samples of sensors of one kind that are due at the same times, so that a time is kept once
/// for all of them: what a run gathers and its files hold.
struct SampleTable {
  std::string kind;
  std::vector<Series::Column> columns;  ///< of each sensor
  std::vector<std::string> names;       ///< of the sensors
  std::vector<std::uint64_t> places;    ///< of the sensors in the scene's list, from 0 on
  std::vector<double> time;             ///< s, strictly increasing
  std::vector<double> duration;         ///< s, as in Series
  std::vector<double> values;           ///< [samples, sensors, columns], SI; NaN as in Series
  std::vector<double> weight;           ///< [samples, sensors], dimensionless
  std::uint64_t next_index = 0;         ///< as in Series

  [[nodiscard]] std::size_t size() const { return time.size(); }
  [[nodiscard]] std::size_t sensors() const { return names.size(); }
  [[nodiscard]] std::size_t width() const { return names.size() * columns.size(); }
};

/// Sensors in all of the tables.
[[nodiscard]] std::size_t sensor_count(const std::vector<SampleTable>& tables);

/// About what the tables take in a file, bytes.
[[nodiscard]] std::uint64_t file_bytes(const std::vector<SampleTable>& tables);

/// A sensor's series as a table of its own, at place 0.
[[nodiscard]] SampleTable table_of(const Series& series);

/// The samples that a checkpoint holds in the tables of the scene's sensors, which are `empty`: the
/// first versions kept each sensor by itself. Throws StorageError(corrupt) where they are not of
/// the same sensors.
[[nodiscard]] std::vector<SampleTable> in_tables_like(const std::vector<SampleTable>& empty,
                                                      std::vector<SampleTable> found);

/// One series per sensor, in the order of the scene's list. The tables must be sound
/// (engine/store/files/rules.hpp).
[[nodiscard]] std::vector<Series> split(const std::vector<SampleTable>& tables);

}  // namespace sluice

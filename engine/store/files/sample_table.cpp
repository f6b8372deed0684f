#include "engine/store/files/sample_table.hpp"

namespace sluice {
namespace {

Series series_of(const SampleTable& table, std::size_t sensor) {
  const std::size_t columns = table.columns.size();
  Series series{table.names[sensor], table.kind, table.columns, table.time, table.duration, {}, {},
                table.next_index};
  series.values.reserve(table.size() * columns);
  series.weight.reserve(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::size_t entry = i * table.sensors() + sensor;
    const double* values = table.values.data() + entry * columns;
    series.values.insert(series.values.end(), values, values + columns);
    series.weight.push_back(table.weight[entry]);
  }
  return series;
}

}  // namespace

std::size_t sensor_count(const std::vector<SampleTable>& tables) {
  std::size_t count = 0;
  for (const SampleTable& table : tables) count += table.sensors();
  return count;
}

std::uint64_t file_bytes(const std::vector<SampleTable>& tables) {
  constexpr std::uint64_t kLabels = 4096;  // groups, names, units and descriptions of a table
  std::uint64_t numbers = 0;
  for (const SampleTable& table : tables) {
    numbers += table.size() * (2 + table.sensors() + table.width());
  }
  return numbers * sizeof(double) + kLabels * tables.size();
}

SampleTable table_of(const Series& series) {
  return {series.kind,   series.columns, {series.name},    {0}, series.time, series.duration,
          series.values, series.weight,  series.next_index};
}

std::vector<Series> split(const std::vector<SampleTable>& tables) {
  std::vector<Series> all(sensor_count(tables));
  for (const SampleTable& table : tables) {
    for (std::size_t sensor = 0; sensor < table.sensors(); ++sensor) {
      all[static_cast<std::size_t>(table.places[sensor])] = series_of(table, sensor);
    }
  }
  return all;
}

}  // namespace sluice

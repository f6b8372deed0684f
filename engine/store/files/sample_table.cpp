#include "engine/store/files/sample_table.hpp"

#include <algorithm>
#include <utility>

#include "engine/store/disk/errors.hpp"

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

bool same_sensors(const SampleTable& a, const SampleTable& b) {
  return a.names == b.names && a.places == b.places && a.kind == b.kind &&
         a.columns.size() == b.columns.size();
}

[[noreturn]] void refuse_samples() {
  throw StorageError(StorageFault::corrupt,
                     "the checkpoint's series are not those of the scene's sensors");
}

/// Fills a table with those of all sensors' series that are its own. Samples cannot be matched to
/// sensors by chance: names, columns and times must agree.
void fill(SampleTable& table, const std::vector<Series>& series) {
  std::vector<const Series*> sensors;
  for (std::size_t i = 0; i < table.sensors(); ++i) {
    const Series* const one = &series[static_cast<std::size_t>(table.places[i])];
    if (one->name != table.names[i] || one->kind != table.kind ||
        one->columns.size() != table.columns.size() ||
        (i > 0 && (one->time != sensors[0]->time || one->next_index != sensors[0]->next_index))) {
      refuse_samples();
    }
    sensors.push_back(one);
  }
  table.time = sensors[0]->time;
  table.duration = sensors[0]->duration;
  table.next_index = sensors[0]->next_index;
  const auto columns = static_cast<std::ptrdiff_t>(table.columns.size());
  for (std::size_t n = 0; n < table.size(); ++n) {
    for (const Series* const one : sensors) {
      const auto values = one->values.begin() + static_cast<std::ptrdiff_t>(n) * columns;
      table.values.insert(table.values.end(), values, values + columns);
      table.weight.push_back(one->weight[n]);
    }
  }
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

std::vector<SampleTable> in_tables_like(const std::vector<SampleTable>& empty,
                                        std::vector<SampleTable> found) {
  if (std::equal(empty.begin(), empty.end(), found.begin(), found.end(), same_sensors)) {
    return found;
  }
  const std::vector<Series> series = split(found);
  std::vector<SampleTable> tables = empty;
  if (series.size() != sensor_count(tables)) refuse_samples();
  for (SampleTable& table : tables) fill(table, series);
  return tables;
}

}  // namespace sluice

#include "engine/report/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "engine/space/axes.hpp"
#include "engine/store/read/filter.hpp"

namespace sluice {
namespace {

double time_unit(const Scene& scene) {
  return std::sqrt(scene.scales->height / scene.method.gravity.norm());
}

/// First column over T, scaled; nothing filtered.
Curve scaled_curve(const Series& series, const Scene& scene, double offset, double scale) {
  Curve curve;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const double value = series.values[n * series.columns.size()];
    curve.time.push_back(series.time[n] / time_unit(scene));
    curve.value.push_back(std::isnan(value) ? 0.0 : (value - offset) / scale);
  }
  return curve;
}

const Series* series_of(const std::vector<Series>& all, const Sensor& sensor) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Series& series) { return series.name == sensor.name; });
  return found == all.end() ? nullptr : &*found;
}

/// The first sensor of a kind near a place of the experiment, given in its own metres; a height is
/// measured over the whole of its line. Places are the same within 0.02 h0, heights 0.01 h0.
const Sensor* sensor_at(const Scene& scene, const Reference& reference, SensorKind kind,
                        const Vec2& place) {
  for (const Sensor& sensor : scene.sensors) {
    // Across the tank the experiment is taken for the same everywhere.
    Vec2 apart = sensor.position.head<2>() / scene.scales->height - place / reference.height;
    apart[kUpAxis] *= kind == SensorKind::surface_height ? 0.0 : 2.0;
    if (sensor.kind == kind && apart.cwiseAbs().maxCoeff() <= 0.02) return &sensor;
  }
  return nullptr;
}

PressureMeasures measure(const Reference& reference, std::span<const double> averages) {
  const Intervals& intervals = reference.pressure_times;
  const ReferenceMeasures& windows = reference.measures;
  PressureMeasures measures;
  measures.impulse = integral(intervals, averages, windows.comparison);
  measures.plateau = mean(intervals, averages, windows.plateau);
  measures.second_rise = second_rise(intervals, averages, windows.second_rise);
  return measures;
}

struct PressurePair {
  const PressureReference* reference;
  const Sensor* sensor;
  Curve curve;
};

std::vector<PressurePair> pair_pressures(const Scene& scene, const std::vector<Series>& all,
                                         const Reference& reference, double tau) {
  std::vector<PressurePair> pairs;
  for (const PressureReference& one : reference.pressures) {
    const Sensor* sensor = sensor_at(scene, reference, SensorKind::pressure, one.place);
    const Series* series = sensor != nullptr ? series_of(all, *sensor) : nullptr;
    if (series != nullptr) pairs.push_back({&one, sensor, pressure_curve(*series, scene, tau)});
  }
  return pairs;
}

PressureComparison weigh(PressurePair pair, const Scene& scene, const Reference& reference,
                         double shift) {
  const auto error = [&](std::span<const double> averages) {
    return relative_l2(reference.pressure_times, averages, pair.reference->values,
                       reference.measures.comparison);
  };
  PressureComparison comparison;
  comparison.relative_l2_not_shifted =
      error(interval_averages(pair.curve, reference.pressure_times));
  for (double& time : pair.curve.time) time += shift;
  const auto averages = interval_averages(pair.curve, reference.pressure_times);
  comparison.sensor = pair.sensor->name;
  comparison.height = pair.sensor->position[kUpAxis];
  comparison.smoothing_length = pair.sensor->smoothing_length > 0.0 ? pair.sensor->smoothing_length
                                                                    : scene.method.smoothing_length;
  comparison.air_pressure = pair.sensor->air_pressure;
  comparison.reference = pair.reference->name;
  comparison.peak_statistics = pair.reference->peak;
  comparison.simulation = measure(reference, averages);
  comparison.simulation.arrival = first_passage(pair.curve, reference.measures.arrival, 1.0);
  comparison.simulation.peak = peak(pair.curve, reference.measures.impact);
  comparison.experiment = measure(reference, pair.reference->values);
  comparison.experiment.arrival = pair.reference->arrival;
  comparison.relative_l2 = error(averages);
  comparison.simulated = std::move(pair.curve);
  return comparison;
}

/// Nothing unless all of the experiment's sensors have one.
std::optional<double> mean_of(const Comparison& comparison,
                              std::optional<double> PressureComparison::*error) {
  if (comparison.pressures.size() != comparison.reference->pressures.size()) return std::nullopt;
  double sum = 0.0;
  for (const PressureComparison& one : comparison.pressures) {
    if (!(one.*error)) return std::nullopt;
    sum += *(one.*error);
  }
  return sum / static_cast<double>(comparison.pressures.size());
}

void compare_pressures(Comparison& comparison, const Scene& scene,
                       std::vector<PressurePair> pairs) {
  if (pairs.empty()) return;
  const auto arrival =
      first_passage(pairs.front().curve, comparison.reference->measures.arrival, 1.0);
  if (arrival) comparison.shift = pairs.front().reference->arrival - *arrival;
  for (PressurePair& pair : pairs) {
    comparison.pressures.push_back(
        weigh(std::move(pair), scene, *comparison.reference, comparison.shift.value_or(0.0)));
  }
  if (comparison.shift)
    comparison.mean_relative_l2 = mean_of(comparison, &PressureComparison::relative_l2);
  comparison.mean_relative_l2_not_shifted =
      mean_of(comparison, &PressureComparison::relative_l2_not_shifted);
}

void compare_levels(Comparison& comparison, const Scene& scene, const std::vector<Series>& all) {
  const Reference& reference = *comparison.reference;
  const Window everything{-1.0, reference.level_times.centers().back() + 1.0};
  for (const LevelReference& one : reference.levels) {
    const Sensor* sensor = sensor_at(scene, reference, SensorKind::surface_height, one.place);
    const Series* series = sensor != nullptr ? series_of(all, *sensor) : nullptr;
    if (series == nullptr) continue;
    Curve curve = scaled_curve(*series, scene, 0.0, scene.scales->height);
    const auto difference =
        rms_difference(reference.level_times, interval_averages(curve, reference.level_times),
                       one.values, everything);
    comparison.levels.push_back({sensor->name, one.name, difference, std::move(curve)});
  }
}

/// How much later the simulated front passes the same places, where it is well under way.
std::optional<double> front_delay(const Curve& simulated, const Curve& measured) {
  double sum = 0.0;
  int count = 0;
  for (double place = 0.5; place <= 3.0; place += 0.5) {
    const auto ours = first_passage(simulated, place, 0.0);
    const auto theirs = first_passage(measured, place, 0.0);
    if (!theirs) continue;
    if (!ours) return std::nullopt;
    sum += *ours - *theirs;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

void compare_front(Comparison& comparison, const Scene& scene, const std::vector<Series>& all) {
  const Curve& measured = comparison.reference->front;
  for (const Sensor& sensor : scene.sensors) {
    const Series* series = series_of(all, sensor);
    if (sensor.kind != SensorKind::surge_front || series == nullptr) continue;
    Curve curve = scaled_curve(*series, scene, scene.scales->width, scene.scales->height);
    const Intervals times(measured.time);
    comparison.front = FrontComparison{
        sensor.name,
        rms_difference(times, interval_averages(curve, times), measured.value, {-1.0, 1e9}),
        front_delay(curve, measured),
        {}};
    comparison.front->simulated = std::move(curve);
    return;
  }
}

}  // namespace

std::optional<double> PressureComparison::place_in_band() const {
  if (!simulation.peak) return std::nullopt;
  return (simulation.peak->value - peak_statistics.low) /
         (peak_statistics.high - peak_statistics.low);
}

Curve pressure_curve(const Series& series, const Scene& scene, double tau) {
  Series filtered = series;
  if (filtered.size() > 0) filtered.values = gaussian_filter(filtered, tau).value;
  filtered.columns.resize(1);
  const double unit =
      scene.method.reference_density * scene.method.gravity.norm() * scene.scales->height;
  return scaled_curve(filtered, scene, 0.0, unit);
}

Comparison compare(const Scene& scene, const std::vector<Series>& series,
                   const Reference& reference, double tau) {
  Comparison comparison;
  comparison.reference = &reference;
  comparison.tau = tau;
  comparison.time_unit = time_unit(scene);
  compare_pressures(comparison, scene, pair_pressures(scene, series, reference, tau));
  compare_levels(comparison, scene, series);
  compare_front(comparison, scene, series);
  return comparison;
}

}  // namespace sluice

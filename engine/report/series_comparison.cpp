#include "engine/report/series_comparison.hpp"

#include <algorithm>
#include <cmath>

#include "engine/store/read/dimensionless.hpp"
#include "engine/store/read/filter.hpp"

namespace sluice {
namespace {

/// Times and values of the first column; what is dry is 0 or left out.
Curve curve_of(Series series, double tau) {
  const bool pressure = series.kind == "pressure";
  const bool dry_is_zero = series.kind == "surface_height";
  const std::size_t width = series.columns.size();
  for (double& value : series.values) {
    if (dry_is_zero && std::isnan(value)) value = 0.0;
  }
  if (pressure && series.size() > 0) series.values = gaussian_filter(series, tau).value;
  const std::size_t stride = pressure ? 1 : width;
  Curve curve;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const double value = series.values[n * stride];
    if (std::isnan(value)) continue;
    curve.time.push_back(series.time[n]);
    curve.value.push_back(value);
  }
  return curve;
}

void divide(Curve& curve, const Divisors& divisors) {
  for (double& time : curve.time) time /= divisors.time;
  for (double& value : curve.value) value /= divisors.value;
}

std::optional<Peak> highest_of(const std::vector<double>& time, const std::vector<double>& value) {
  std::optional<Peak> best;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!best || value[i] > best->value) best = Peak{time[i], value[i]};
  }
  return best;
}

std::optional<Peak> highest_within(const Curve& curve, double from, double to) {
  if (curve.size() == 0 || curve.time.back() < to) return std::nullopt;
  Curve part;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve.time[i] < from || curve.time[i] > to) continue;
    part.time.push_back(curve.time[i]);
    part.value.push_back(curve.value[i]);
  }
  return highest_of(part.time, part.value);
}

CurveComparison weigh(const ReferenceCurve& expected, Curve simulated) {
  CurveComparison comparison;
  const Intervals intervals(expected.time);
  const auto averages = interval_averages(simulated, intervals);
  const Window all{expected.time.front() - 1.0, expected.time.back() + 1.0};
  comparison.relative_l2 = relative_l2(intervals, averages, expected.value, all);
  comparison.rms_difference = rms_difference(intervals, averages, expected.value, all);
  comparison.expected_peak = highest_of(expected.time, expected.value);
  comparison.simulated_peak =
      highest_within(simulated, expected.time.front(), expected.time.back());
  comparison.simulated = std::move(simulated);
  return comparison;
}

CurveComparison compare_curve(const Scene& scene, const Series* series,
                              const ReferenceCurve& expected, ReferenceUnits units, double tau) {
  Curve simulated;
  if (series != nullptr) {
    simulated = curve_of(*series, tau);
    if (units == ReferenceUnits::dimensionless) {
      divide(simulated, dimensionless_divisors(scene, *series));
    }
  }
  CurveComparison comparison = weigh(expected, std::move(simulated));
  comparison.sensor = expected.sensor;
  comparison.expected = expected;
  if (series != nullptr) {
    comparison.kind = series->kind;
    comparison.unit = units == ReferenceUnits::dimensionless ? "1" : series->columns.front().unit;
  }
  return comparison;
}

}  // namespace

SeriesComparison compare_series(const Scene& scene, const std::vector<Series>& series,
                                const SceneReference& reference, double tau) {
  SeriesComparison comparison{reference.title, reference.citation, reference.units, tau, {}, {}};
  double sum = 0.0;
  bool complete = !reference.curves.empty();
  for (const ReferenceCurve& expected : reference.curves) {
    const auto found = std::find_if(series.begin(), series.end(),
                                    [&](const Series& one) { return one.name == expected.sensor; });
    comparison.curves.push_back(compare_curve(scene, found == series.end() ? nullptr : &*found,
                                              expected, reference.units, tau));
    complete = complete && comparison.curves.back().relative_l2;
    sum += comparison.curves.back().relative_l2.value_or(0.0);
  }
  if (complete) comparison.mean_relative_l2 = sum / static_cast<double>(comparison.curves.size());
  return comparison;
}

}  // namespace sluice

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/report/measures.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/series.hpp"

namespace sluice {

/// One sensor against the curve that the scene gives for it.
struct CurveComparison {
  std::string sensor;
  std::string kind;
  std::string unit;                      ///< of the values; "1" when dimensionless
  std::optional<double> relative_l2;     ///< absent: the run ends too early or the curve is zero
  std::optional<double> rms_difference;  ///< in `unit`
  std::optional<Peak> simulated_peak;    ///< over the curve's times
  std::optional<Peak> expected_peak;
  Curve simulated;
  ReferenceCurve expected;
};

/// A run against the curves of its own scene.
struct SeriesComparison {
  std::string title;
  std::string citation;
  ReferenceUnits units = ReferenceUnits::si;
  double tau = 0.0;  ///< s
  std::vector<CurveComparison> curves;
  std::optional<double> mean_relative_l2;  ///< over all curves; absent when one of them has none
};

/// Compares the first column of each sensor named by `reference` (of kind series) with its curve,
/// averaged over the curve's intervals; nothing is shifted. Pressures are filtered with `tau` (s).
/// Dry pressures and levels count as 0; other dry samples are left out. A sensor without samples
/// has no simulated curve and no measures.
[[nodiscard]] SeriesComparison compare_series(const Scene& scene, const std::vector<Series>& series,
                                              const SceneReference& reference, double tau);

}  // namespace sluice

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/report/measures.hpp"
#include "engine/report/reference.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/series.hpp"

namespace sluice {

/// The filter time that pressures are compared with, s.
inline constexpr double kComparisonTau = 0.002;
/// What is read off one pressure series. Absent: the run does not reach that far, or nothing such
/// happens in it.
struct PressureMeasures {
  std::optional<double> arrival;  ///< T
  std::optional<Peak> peak;       ///< of the first impact
  std::optional<double> impulse;  ///< integral of P dT over the comparison window
  std::optional<double> plateau;  ///< mean P
  std::optional<Rise> second_rise;
};

struct PressureComparison {
  std::string sensor;                  ///< the scene's name for it
  double height = 0.0;                 ///< above the floor, m
  double smoothing_length = 0.0;       ///< of the sensor, m
  std::optional<double> air_pressure;  ///< around it, Pa; absent: eq. 11, the fluid alone
  std::string reference;               ///< the experiment's name for it
  PressureMeasures simulation;
  PressureMeasures experiment;  ///< of one test; its peak is peak_statistics' business
  PeakStatistics peak_statistics;
  std::optional<double> relative_l2;              ///< after the shift
  std::optional<double> relative_l2_not_shifted;  ///< with the run's own times
  Curve simulated;                                ///< P over T, filtered and shifted

  /// Where the simulated peak lies among the tests: 0 at the 2.5th, 1 at the 97.5th percentile.
  [[nodiscard]] std::optional<double> place_in_band() const;
};

struct LevelComparison {
  std::string sensor;
  std::string reference;
  std::optional<double> rms_difference;  ///< h/h0
  Curve simulated;                       ///< h/h0 over T, not shifted
};

struct FrontComparison {
  std::string sensor;
  std::optional<double> rms_difference;  ///< (w - w0)/h0
  std::optional<double> delay;  ///< T that the simulation comes later at the same place, mean
  Curve simulated;              ///< (w - w0)/h0 over T, not shifted
};

/// A run against an experiment.
struct Comparison {
  const Reference* reference = nullptr;
  double tau = 0.0;             ///< s
  double time_unit = 0.0;       ///< s per unit of T: sqrt(h0/g)
  std::optional<double> shift;  ///< T added to all pressure times; absent: nothing arrived
  std::vector<PressureComparison> pressures;
  std::optional<double> mean_relative_l2;  ///< over all of the experiment's sensors, shifted
  std::optional<double> mean_relative_l2_not_shifted;
  std::vector<LevelComparison> levels;
  std::optional<FrontComparison> front;
};

/// Pressure series as P over T, after the time filter of eq. 12 with `tau` (s), in which dry
/// samples count as 0: what `sluice sensors --filter gaussian` prints.
[[nodiscard]] Curve pressure_curve(const Series& series, const Scene& scene, double tau);

/// Compares `series` (raw) with an experiment that matches the scene (matching_reference). The
/// time origins of experiment and simulation differ, so all pressures are shifted alike, such that
/// the first sensor arrives as in the experiment; levels and front are not shifted. Sensors belong
/// together when they are within 2 % of h0 in x and 1 % in y.
[[nodiscard]] Comparison compare(const Scene& scene, const std::vector<Series>& series,
                                 const Reference& reference, double tau = kComparisonTau);

}  // namespace sluice

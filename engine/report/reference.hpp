#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/measures.hpp"
#include "engine/scene/model/scene.hpp"

namespace sluice {

/// Maximum impact pressure over repeated tests, P = p/(rho g h0).
struct PeakStatistics {
  double median = 0.0;
  double low = 0.0;   ///< 2.5th percentile
  double high = 0.0;  ///< 97.5th percentile
};

/// How far repeated tests lie apart: percentiles of P, one average per interval.
struct PressureBand {
  std::vector<double> low;   ///< 2.5th percentile
  std::vector<double> high;  ///< 97.5th percentile
};

/// A pressure sensor of an experiment on the wall that the surge hits.
struct PressureReference {
  std::string name;
  Vec2 place = Vec2::Zero();   ///< from the lower corner of the tank that the column stands in, m
  double arrival = 0.0;        ///< T
  std::vector<double> values;  ///< P, one average per interval
  PeakStatistics peak;
  std::optional<PressureBand> band;
};

/// A place where the surface was measured.
struct LevelReference {
  std::string name;
  Vec2 place = Vec2::Zero();   ///< on the floor, from that corner, m
  std::vector<double> values;  ///< h/h0, mean over the tests, one average per interval
};

/// What is read off the pressures of an experiment and of its simulation, T and P.
struct ReferenceMeasures {
  double arrival = 0.0;  ///< the pressure that counts as the arrival of the surge, P
  Window comparison;     ///< where pressures are compared
  Window impact;         ///< where the first peak is looked for
  Window plateau;        ///< between impact and second rise, ends included
  RiseWindows second_rise;
  std::vector<double> pictures;  ///< times that pictures are shown of
  Window front_axis;             ///< of the front's plot
  Window pressure_axis;          ///< of the pressures' plots
};

/// Figures of a dam-break experiment, dimensionless with its own h0, rho and g.
struct Reference {
  std::string name;  ///< name of its file
  std::string title;
  std::string citation;
  double height = 0.0;       ///< initial column height h0, m
  double width = 0.0;        ///< initial column width w0, m
  double tank_width = 0.0;   ///< m
  double tank_height = 0.0;  ///< m
  Intervals pressure_times;
  std::vector<PressureReference> pressures;
  Intervals level_times;
  std::vector<LevelReference> levels;
  Curve front;         ///< T, (w - w0)/h0
  int peak_tests = 0;  ///< behind the statistics of peaks
  ReferenceMeasures measures;

  /// The pressure sensors in words: "P1-P4".
  [[nodiscard]] std::string pressures_text() const;
};

/// Reads a reference. `text` is a file of schemas/references; its layout is that of the one there.
/// Throws std::runtime_error naming `name` and what is missing or of the wrong length.
[[nodiscard]] Reference parse_reference(const std::string& name, const std::string& text);

/// The references that are built into the program.
[[nodiscard]] const std::vector<Reference>& references();

/// The built-in reference of this name, one of kExperimentWords. Throws std::logic_error when the
/// program has lost it.
[[nodiscard]] const Reference& reference_of(std::string_view name);

/// The reference whose tank and column have the shape of the scene's, whatever their size: tank
/// width and column width in column heights within 1 %. Nothing for a scene without gravity
/// straight down, tank or scales.
[[nodiscard]] const Reference* matching_reference(const Scene& scene);

}  // namespace sluice

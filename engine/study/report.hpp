#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/store/series.hpp"
#include "engine/study/evidence.hpp"

namespace sluice {

/// What every sensor saw, whatever the scene.
struct SensorSummary {
  std::string name;
  std::string kind;
  std::string column;
  std::string unit;
  std::size_t samples = 0;
  std::optional<double> first_wet;   ///< s
  std::optional<double> highest;     ///< of the filtered series for a pressure, raw otherwise
  std::optional<double> highest_at;  ///< s
  std::optional<double> last;
};

/// What a run came to: its sensors, its comparison with an experiment where one matches, and its
/// outcome.
struct Report {
  Scene scene;
  double tau = kComparisonTau;  ///< time filter of pressures, s
  std::vector<SensorSummary> sensors;
  std::optional<Evidence> evidence;  ///< absent: no experiment matches the scene
  nlohmann::ordered_json outcome;    ///< outcome.json; null while the run has not ended
};

[[nodiscard]] Report make_report(const Scene& scene, const std::vector<Series>& series,
                                 const nlohmann::ordered_json& outcome,
                                 double tau = kComparisonTau);

/// Reads scene.json, series.h5 and, where there is one, outcome.json of a job folder; the run may
/// be going on. Throws StorageError when the folder holds no job or its series cannot be read, and
/// SceneError for a scene that cannot.
[[nodiscard]] Report report_of_folder(const std::filesystem::path& folder,
                                      double tau = kComparisonTau);

/// For people: tables of at most 100 columns. "-" is a value that there is none of.
[[nodiscard]] std::string report_text(const Report& report);

/// For programs: the same figures, null where there is none.
[[nodiscard]] nlohmann::ordered_json report_json(const Report& report);

}  // namespace sluice

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/report/comparison.hpp"
#include "engine/report/run_facts.hpp"
#include "engine/report/series_comparison.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/series.hpp"
#include "engine/store/files/snapshot_io.hpp"

namespace sluice {

/// What every sensor saw, whatever the scene.
struct SensorSummary {
  std::string name;
  std::string kind;
  std::string column;
  std::string unit;
  std::size_t samples = 0;
  std::optional<double> first_wet;   ///< the first sample that saw fluid, s
  std::optional<double> highest;     ///< of the filtered series for a pressure, raw otherwise
  std::optional<double> highest_at;  ///< s
  std::optional<double> lowest;      ///< of the same
  std::optional<double> lowest_at;   ///< s
  std::optional<double> last;
  std::optional<double> mean;  ///< over time, of the same as highest; dry pressures count as 0
};

/// What a run came to: its sensors, its comparison with a reference where it has one, its cost and
/// its outcome.
struct Report {
  Scene scene;
  double tau = kComparisonTau;  ///< time filter of pressures, s
  std::vector<SensorSummary> sensors;
  std::optional<Comparison>
      comparison;  ///< against an experiment: the scene's own or one of its shape
  std::optional<SeriesComparison> series_comparison;  ///< against the curves of the scene
  nlohmann::ordered_json outcome;                     ///< outcome.json; null while the run goes on
  RunFacts facts;                                     ///< the same, read
  Conservation conservation;

  /// The mean relative L2 of the reference's sensors, whatever kind it is.
  [[nodiscard]] std::optional<double> error() const;
};

[[nodiscard]] Report make_report(const Scene& scene, const std::vector<Series>& series,
                                 const nlohmann::ordered_json& outcome,
                                 double tau = kComparisonTau);

/// Throws StorageError when the folder holds no job or its series cannot be read, and SceneError
/// for a scene that cannot.
[[nodiscard]] Report report_of_folder(const std::filesystem::path& folder,
                                      double tau = kComparisonTau);

/// For people: tables. "-" is a value that there is none of.
[[nodiscard]] std::string report_text(const Report& report);
[[nodiscard]] std::string report_markdown(const Report& report);

/// For programs: the same figures, null where there is none.
[[nodiscard]] nlohmann::ordered_json report_json(const Report& report);

/// One page without scripts that loads nothing: the tables, every sensor's plot and a picture of
/// each of `frames`, coloured by pressure. `series` as for make_report.
[[nodiscard]] std::string report_html(const Report& report, const std::vector<Series>& series,
                                      const std::vector<Snapshot>& frames);

/// The pressures over the experiment's, or whatever else is compared, two plots in a row; empty
/// where nothing is compared.
[[nodiscard]] std::string report_svg(const Report& report);

/// The snapshots that the report's pictures show (engine/report/snapshots.hpp). One that cannot be
/// read is left out.
[[nodiscard]] std::vector<Snapshot> picture_snapshots(const std::filesystem::path& folder,
                                                      const Report& report);

/// Makes a report of a finished or running job and publishes report.json, report.md and report.html
/// in `target`. Throws what report_of_folder() and publish_text() throw.
void publish_report(const std::filesystem::path& folder, const std::filesystem::path& target,
                    double tau = kComparisonTau);

/// Makes the report in the folder of a run that is complete and has none, or not all of it: one
/// that was killed, or met a full disk, after its last step. Whether there is a whole one now; a
/// run that is not complete gets none. Throws as publish_report(), and locked while a process works
/// there.
bool publish_missing_report(const std::filesystem::path& folder);

}  // namespace sluice

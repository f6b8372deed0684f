#include "engine/study/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/scene/parse.hpp"
#include "engine/store/errors.hpp"
#include "engine/store/file_system.hpp"
#include "engine/store/filter.hpp"
#include "engine/store/job_folder.hpp"
#include "engine/store/series_file.hpp"

namespace sluice {
namespace {

/// Far more than any text of a job needs.
constexpr std::size_t kMaxTextBytes = 1024 * 1024;

SensorSummary summarise(const Series& series, std::size_t column, double tau) {
  const std::size_t width = series.columns.size();
  SensorSummary summary;
  summary.name = series.name;
  summary.kind = series.kind;
  summary.column = series.columns[column].name;
  summary.unit = series.columns[column].unit;
  summary.samples = series.size();
  const bool filtered = series.kind == "pressure" && series.size() > 0;
  const std::vector<double> smooth =
      filtered ? gaussian_filter(series, tau, column).value : std::vector<double>{};
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (std::isnan(series.values[n * width + column])) continue;
    const double value = filtered ? smooth[n] : series.values[n * width + column];
    if (!summary.first_wet) summary.first_wet = series.time[n];
    if (!summary.highest || value > *summary.highest) {
      summary.highest = value;
      summary.highest_at = series.time[n];
    }
    summary.last = value;
  }
  return summary;
}

/// A broken outcome.json is no reason to refuse the figures.
nlohmann::ordered_json read_outcome(const JobPaths& paths) {
  if (!std::filesystem::exists(paths.outcome())) return nullptr;
  return nlohmann::ordered_json::parse(read_text(paths.outcome(), kMaxTextBytes), nullptr, false);
}

}  // namespace

Report make_report(const Scene& scene, const std::vector<Series>& series,
                   const nlohmann::ordered_json& outcome, double tau) {
  Report report{scene, tau, {}, std::nullopt, outcome};
  if (!report.outcome.is_object()) report.outcome = nullptr;
  for (const Series& one : series) {
    for (std::size_t column = 0; column < one.columns.size(); ++column) {
      report.sensors.push_back(summarise(one, column, tau));
    }
  }
  const Reference* reference = matching_reference(scene);
  if (reference != nullptr) report.evidence = compare(scene, series, *reference, tau);
  return report;
}

Report report_of_folder(const std::filesystem::path& folder, double tau) {
  const JobPaths paths(folder);
  if (!JobFolder::holds_job(folder)) {
    throw StorageError(
        StorageFault::not_ours,
        fmt::format("{}: holds no job; name a folder that `sluice run` made", folder.string()));
  }
  const ParseResult parsed =
      parse_scene(read_text(paths.scene(), kMaxTextBytes), StabilityCheck::skip);
  if (!parsed.scene) throw SceneError(parsed.problems.front());
  if (!std::filesystem::exists(paths.series())) {
    throw StorageError(StorageFault::io,
                       fmt::format("{}: the run has written no series yet; a scene without "
                                   "sensors never does",
                                   paths.series().string()));
  }
  return make_report(*parsed.scene, read_series(paths.series()), read_outcome(paths), tau);
}

}  // namespace sluice

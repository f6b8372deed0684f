#include "engine/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/snapshots.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/job_paths.hpp"
#include "engine/store/read/filter.hpp"
#include "engine/store/read/job_reader.hpp"

namespace sluice {
namespace {

bool is_filtered(const Series& series) { return series.kind == "pressure" && series.size() > 0; }

/// Over the time of all samples that have a value.
std::optional<double> mean_of_column(const Series& series, std::size_t column,
                                     const std::vector<double>& smooth) {
  double sum = 0.0;
  double time = 0.0;
  std::optional<double> last;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const double value =
        smooth.empty() ? series.values[n * series.columns.size() + column] : smooth[n];
    if (std::isnan(value)) continue;
    sum += value * series.duration[n];
    time += series.duration[n];
    last = value;
  }
  return time > 0.0 ? std::optional(sum / time) : last;
}

/// `smooth` is the filtered column, empty where it is not filtered.
SensorSummary summarise(const Series& series, std::size_t column,
                        const std::vector<double>& smooth) {
  const std::size_t width = series.columns.size();
  SensorSummary summary;
  summary.name = series.name;
  summary.kind = series.kind;
  summary.column = series.columns[column].name;
  summary.unit = series.columns[column].unit;
  summary.samples = series.size();
  summary.mean = mean_of_column(series, column, smooth);
  for (std::size_t n = 0; n < series.size(); ++n) {
    const double raw = series.values[n * width + column];
    if (std::isnan(raw)) continue;
    const double value = smooth.empty() ? raw : smooth[n];
    // Where a scene names the pressure of the air there is a value without any fluid.
    if (!summary.first_wet && series.weight[n] > 0.0) summary.first_wet = series.time[n];
    if (!summary.highest || value > *summary.highest) {
      summary.highest = value;
      summary.highest_at = series.time[n];
    }
    if (!summary.lowest || value < *summary.lowest) {
      summary.lowest = value;
      summary.lowest_at = series.time[n];
    }
    summary.last = value;
  }
  return summary;
}

/// Sensors of one table, or as good as that.
bool sampled_together(const Series& a, const Series& b) {
  return a.time == b.time && a.duration == b.duration && a.columns.size() == b.columns.size();
}

/// The filtered column of every series that is filtered, the others' empty. What was sampled
/// together is filtered together.
std::vector<std::vector<double>> smooth_columns(const std::vector<Series>& all, std::size_t column,
                                                double tau) {
  std::vector<std::vector<const Series*>> groups;
  for (const Series& series : all) {
    if (!is_filtered(series) || column >= series.columns.size()) continue;
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& members) {
      return sampled_together(*members.front(), series);
    });
    (group == groups.end() ? groups.emplace_back() : *group).push_back(&series);
  }
  std::vector<std::vector<double>> smooth(all.size());
  for (const std::vector<const Series*>& group : groups) {
    std::vector<Filtered> filtered = gaussian_filter(group, tau, column);
    for (std::size_t k = 0; k < group.size(); ++k) {
      smooth[static_cast<std::size_t>(group[k] - all.data())] = std::move(filtered[k].value);
    }
  }
  return smooth;
}

std::vector<SensorSummary> summarise_all(const std::vector<Series>& all, double tau) {
  std::size_t columns = 0;
  for (const Series& series : all) columns = std::max(columns, series.columns.size());
  std::vector<std::vector<std::vector<double>>> smooth;  // by column
  for (std::size_t column = 0; column < columns; ++column) {
    smooth.push_back(smooth_columns(all, column, tau));
  }
  std::vector<SensorSummary> summaries;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t column = 0; column < all[i].columns.size(); ++column) {
      summaries.push_back(summarise(all[i], column, smooth[column][i]));
    }
  }
  return summaries;
}

/// What the scene is compared with: the reference it names, else an experiment of its shape.
const Reference* experiment_of(const Scene& scene) {
  if (!scene.reference) return matching_reference(scene);
  if (scene.reference->kind != ReferenceKind::experiment) return nullptr;
  return &reference_of(scene.reference->experiment);
}

}  // namespace

std::optional<double> Report::error() const {
  if (series_comparison) return series_comparison->mean_relative_l2;
  return comparison ? comparison->mean_relative_l2 : std::nullopt;
}

Report make_report(const Scene& scene, const std::vector<Series>& series,
                   const nlohmann::ordered_json& outcome, double tau) {
  Report report{scene, tau, {}, std::nullopt, std::nullopt, outcome, {}, {}};
  if (!report.outcome.is_object()) report.outcome = nullptr;
  report.sensors = summarise_all(series, tau);
  if (const Reference* reference = experiment_of(scene)) {
    report.comparison = compare(scene, series, *reference, tau);
  }
  if (scene.reference && scene.reference->kind == ReferenceKind::series) {
    report.series_comparison = compare_series(scene, series, *scene.reference, tau);
  }
  report.facts = run_facts(report.outcome);
  report.conservation = conservation_of(series, report.facts);
  return report;
}

Report report_of_folder(const std::filesystem::path& folder, double tau) {
  const JobRecord job = JobReader(folder).record();
  return make_report(job.scene, job.series, job.outcome, tau);
}

std::vector<Snapshot> picture_snapshots(const std::filesystem::path& folder, const Report& report) {
  std::vector<Snapshot> frames;
  for (const std::filesystem::path& path : picture_files(folder, report)) {
    if (auto frame = try_snapshot(path)) frames.push_back(*std::move(frame));
  }
  return frames;
}

void publish_report(const std::filesystem::path& folder, const std::filesystem::path& target,
                    double tau) {
  const JobRecord job = JobReader(folder).record();
  const Report report = make_report(job.scene, job.series, job.outcome, tau);
  const JobPaths paths(target);
  // Another folder than the job's own is its user's, whose links are meant.
  const auto put = [&](const std::filesystem::path& path, const std::string& text) {
    target == folder ? publish_text(path, text) : write_text(path, text);
  };
  put(paths.report(), report_json(report).dump(2) + "\n");
  put(paths.report_markdown(), report_markdown(report));
  put(paths.report_html(), report_html(report, job.series, picture_snapshots(folder, report)));
}

bool publish_missing_report(const std::filesystem::path& folder) {
  const JobPaths paths(folder);
  const auto has_all = [&] {
    return is_present(paths.report()) && is_present(paths.report_markdown()) &&
           is_present(paths.report_html());
  };
  if (has_all()) return true;
  if (!JobReader(folder).completed()) return false;
  const JobFolder held = JobFolder::open(folder);  // nobody else writes here meanwhile
  publish_report(folder, folder);
  return true;
}

}  // namespace sluice

#include "engine/report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/checks.hpp"
#include "cli/client/fetched_job.hpp"
#include "cli/client/job_names.hpp"
#include "cli/client/service_client.hpp"
#include "cli/job_data.hpp"
#include "cli/verbs.hpp"
#include "engine/report/animation.hpp"
#include "engine/report/snapshots.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/read/job_reader.hpp"

namespace sluice {
namespace {

enum class ReportFormat { text, json, markdown, html, svg, apng };

struct ReportArguments {
  std::string target;  ///< a job's folder, or its id at a service
  bool of_service = false;
  ServiceOptions service;
  std::filesystem::path output;
  double tau = kComparisonTau;
  ReportFormat format = ReportFormat::text;
  Quantity colour = Quantity::pressure;
  Look look = Look::rendered;
  bool json = false;
  std::string outcome;  ///< JSON, for a run that left none
};

std::string formatted(const ReportArguments& arguments, const std::filesystem::path& folder,
                      ReportFormat format) {
  JobRecord job = JobReader(folder).record();
  if (!job.outcome.is_object()) {
    job.outcome = nlohmann::ordered_json::parse(arguments.outcome, nullptr, false);
  }
  const Report report = make_report(job.scene, job.series, job.outcome, arguments.tau);
  switch (format) {
    case ReportFormat::json:
      return report_json(report).dump(2) + "\n";
    case ReportFormat::markdown:
      return report_markdown(report);
    case ReportFormat::html:
      return report_html(report, job.series, picture_snapshots(folder, report));
    case ReportFormat::apng:
      if (std::string moving = animation_png(folder, report, arguments.colour, arguments.look);
          !moving.empty()) {
        return moving;
      }
      throw CommandEnd(ExitCode::usage,
                       fmt::format("{} has no snapshots to show: its scene has no key "
                                   "output.frames, or it did not run yet",
                                   arguments.target));
    case ReportFormat::svg:
      if (std::string sheet = report_svg(report); !sheet.empty()) return sheet;
      throw CommandEnd(ExitCode::usage,
                       "nothing to draw: no experiment matches this scene, and it names no "
                       "reference; --format html has the plots of all sensors");
    case ReportFormat::text:
      break;
  }
  return report_text(report);
}

void write_files(const ReportArguments& arguments, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(arguments.output, error);
  if (error) {
    throw CommandEnd(ExitCode::storage_failure,
                     fmt::format("cannot make {}: {}; name another folder with --output",
                                 arguments.output.string(), error.message()));
  }
  publish_report(folder, arguments.output, arguments.tau);
  write_text(arguments.output / "report.txt", formatted(arguments, folder, ReportFormat::text));
}

/// A look at a job is also the time to make what its run could not leave. Who may only read the
/// folder sees the report all the same.
void leave_missing_report(const std::filesystem::path& folder) {
  try {
    publish_missing_report(folder);
  } catch (const StorageError&) {
  }
}

ReportFormat format_of(const ReportArguments& arguments) {
  return arguments.json ? ReportFormat::json : arguments.format;
}

void report_folder(const ReportArguments& arguments, const std::filesystem::path& folder) {
  const std::string shown = formatted(arguments, folder, format_of(arguments));
  leave_missing_report(folder);
  if (!arguments.output.empty()) write_files(arguments, folder);
  std::fwrite(shown.data(), 1, shown.size(), stdout);
}

/// The snapshots that the report shows.
std::vector<std::filesystem::path> snapshots_shown(const ReportArguments& arguments,
                                                   const std::filesystem::path& folder) {
  const ReportFormat format = format_of(arguments);
  const bool page = format == ReportFormat::html || !arguments.output.empty();
  std::vector<std::filesystem::path> frames;
  if (format == ReportFormat::apng) frames = spread_files(folder, kMostAnimated);
  if (format != ReportFormat::apng && !page) return frames;
  // An animation has the colours of the page's pictures.
  const auto pictures = picture_files(folder, report_of_folder(folder, arguments.tau));
  frames.insert(frames.end(), pictures.begin(), pictures.end());
  return frames;
}

void report_of_service(const ReportArguments& arguments) {
  ServiceClient service(arguments.service);
  FetchedJob job(service, job_named(service, arguments.target));
  try {
    job.fetch_snapshots(service, snapshots_shown(arguments, job.folder()));
    report_folder(arguments, job.folder());
  } catch (const StorageError& error) {
    throw StorageError(error.fault(), job.in_users_words(error.what()));
  }
}

void report(ReportArguments arguments) {
  if (!(arguments.tau > 0.0) || !std::isfinite(arguments.tau)) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("--tau is {}, but must be a positive number of seconds, such as "
                                 "{}",
                                 arguments.tau, kComparisonTau));
  }
  if (!is_of_service(arguments.service, arguments.of_service, arguments.target)) {
    require_folder(arguments.target);
    return report_folder(arguments, arguments.target);
  }
  report_of_service(arguments);
}

}  // namespace

void add_report(CLI::App& app) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* verb =
      app.add_subcommand("report", "Say what a run came to, and compare it with an experiment.");
  verb->add_option("target", arguments->target,
                   "Job folder, of a running job or an ended one, or the job's id at a service")
      ->required();
  const std::map<std::string, ReportFormat> formats{
      {"text", ReportFormat::text},         {"json", ReportFormat::json},
      {"markdown", ReportFormat::markdown}, {"html", ReportFormat::html},
      {"svg", ReportFormat::svg},           {"apng", ReportFormat::apng}};
  const std::map<std::string, Quantity> quantities{{"pressure", Quantity::pressure},
                                                   {"speed", Quantity::speed}};
  const std::map<std::string, Look> looks{{"rendered", Look::rendered}, {"section", Look::section}};
  CLI::Option* format =
      verb->add_option(
              "--format", arguments->format,
              "text, json, markdown, html: one page with plots and pictures, svg: the plots "
              "over the reference, or apng: an animation of all snapshots")
          ->transform(one_of(formats));
  verb->add_option("--colour", arguments->colour, "What colours an animation's particles")
      ->transform(one_of(quantities));
  verb->add_option(
          "--view", arguments->look,
          "How an animation shows a scene of space: rendered, as it is seen from one side, "
          "or section, a cut through the middle")
      ->transform(one_of(looks));
  verb->add_flag("--json", arguments->json, "The same as --format json")->excludes(format);
  verb->add_option("--tau", arguments->tau, "Time filter of pressures, s")
      ->check(number_above_zero())
      ->capture_default_str();
  verb->add_option(
      "--output", arguments->output,
      "Also write report.txt, report.json, report.md and report.html into this folder");
  // The service knows how a run ended whose worker was lost.
  verb->add_option("--outcome", arguments->outcome)->group("");
  add_service_switch(*verb, arguments->service, arguments->of_service);
  verb->footer(
      "Example: sluice report dambreak-paper --format html > dambreak-paper.html\n"
      "         sluice report dambreak-paper --format apng > dambreak-paper.png\n"
      "         sluice report j0r2mt1q8kq0f7a3c1d2e --server http://127.0.0.1:8080");
  verb->callback([arguments] { report(*arguments); });
}

}  // namespace sluice

#include "engine/study/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/fetched_job.hpp"
#include "cli/service_client.hpp"
#include "cli/verbs.hpp"
#include "engine/store/publish.hpp"

namespace sluice {
namespace {

struct ReportArguments {
  std::string target;  ///< a job's folder, or its id at a service
  bool of_service = false;
  ServiceOptions service;
  std::filesystem::path output;
  double tau = kComparisonTau;
  bool json = false;
};

void write_files(const std::filesystem::path& folder, const std::string& text,
                 const std::string& json) {
  std::filesystem::create_directories(folder);
  publish_text(folder / "report.txt", text);
  publish_text(folder / "report.json", json);
}

Report report_of(const ReportArguments& arguments) {
  if (!arguments.of_service) return report_of_folder(arguments.target, arguments.tau);
  ServiceClient service(arguments.service);
  const FetchedJob job(service, arguments.target);
  return report_of_folder(job.folder(), arguments.tau);
}

void report(const ReportArguments& arguments) {
  if (!(arguments.tau > 0.0) || !std::isfinite(arguments.tau)) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("--tau is {}, but must be a positive number of seconds, such as "
                                 "{}",
                                 arguments.tau, kComparisonTau));
  }
  const Report made = report_of(arguments);
  const std::string text = report_text(made);
  const std::string json = report_json(made).dump(2) + "\n";
  if (!arguments.output.empty()) write_files(arguments.output, text, json);
  std::fputs((arguments.json ? json : text).c_str(), stdout);
}

}  // namespace

void add_report(CLI::App& app) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* verb =
      app.add_subcommand("report", "Say what a run came to, and compare it with an experiment.");
  verb->add_option("target", arguments->target,
                   "Job folder, of a run that goes on or has ended; with --server, the job's id")
      ->required();
  verb->add_flag("--json", arguments->json, "Print JSON for programs");
  verb->add_option("--tau", arguments->tau, "Time filter of pressures, s")->capture_default_str();
  verb->add_option("--output", arguments->output,
                   "Also write report.txt and report.json into this folder");
  add_service_switch(*verb, arguments->service, arguments->of_service);
  verb->footer(
      "Example: sluice report dambreak-paper\n"
      "         sluice report j0r2mt1q8kq0f7a3c1d2e --server http://127.0.0.1:8080");
  verb->callback([arguments] { report(*arguments); });
}

}  // namespace sluice

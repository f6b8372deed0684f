#include "engine/study/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/verbs.hpp"
#include "engine/store/publish.hpp"

namespace sluice {
namespace {

struct ReportArguments {
  std::filesystem::path folder;
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

void report(const ReportArguments& arguments) {
  if (!(arguments.tau > 0.0) || !std::isfinite(arguments.tau)) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("--tau is {}, but must be a positive number of seconds, such as "
                                 "{}",
                                 arguments.tau, kComparisonTau));
  }
  const Report made = report_of_folder(arguments.folder, arguments.tau);
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
  verb->add_option("folder", arguments->folder, "Job folder, of a run that goes on or has ended")
      ->required();
  verb->add_flag("--json", arguments->json, "Print JSON for programs");
  verb->add_option("--tau", arguments->tau, "Time filter of pressures, s")->capture_default_str();
  verb->add_option("--output", arguments->output,
                   "Also write report.txt and report.json into this folder");
  verb->footer("Example: sluice report dambreak-paper");
  verb->callback([arguments] { report(*arguments); });
}

}  // namespace sluice

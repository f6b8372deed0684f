#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/run/signals.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/verify/elliptical_drop.hpp"
#include "engine/verify/stability_case.hpp"
#include "engine/verify/stability_map.hpp"
#include "engine/verify/stability_report.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

struct StabilityArguments {
  std::vector<std::string> cases;
  std::string scheme = "recommended";
  fs::path folder;
  fs::path json;
  fs::path html;
  fs::path svg;
  bool quick = false;
  bool map = false;
  bool order = false;
  bool list = false;
};

/// A folder of one's own that goes away, or the one that was asked for.
class SuiteFolder {
 public:
  explicit SuiteFolder(const fs::path& wanted)
      : path_(wanted.empty()
                  ? fs::temp_directory_path() / fmt::format("sluice-stability-{}", ::getpid())
                  : wanted),
        temporary_(wanted.empty()) {
    fs::create_directories(path_);
    if (!fs::is_empty(path_)) {
      throw CommandEnd(ExitCode::usage,
                       fmt::format("{} is not empty: name a new folder", path_.string()));
    }
  }
  ~SuiteFolder() {
    std::error_code ignored;
    if (temporary_) fs::remove_all(path_, ignored);
  }
  SuiteFolder(const SuiteFolder&) = delete;
  SuiteFolder& operator=(const SuiteFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool temporary_;
};

std::vector<StabilityCase> chosen(const std::vector<std::string>& names) {
  const std::vector<StabilityCase> all = all_cases();
  if (names.empty()) return all;
  std::vector<std::string_view> known;
  for (const StabilityCase& each : all) known.push_back(each.name);
  std::vector<StabilityCase> picked;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw CommandEnd(ExitCode::usage,
                       fmt::format("there is no case {}: {}", name, hint(name, known)));
    }
    picked.push_back(all[static_cast<std::size_t>(found - known.begin())]);
  }
  return picked;
}

nlohmann::ordered_json chosen_scheme(const std::string& name) {
  if (name == "recommended") return recommended_scheme();
  if (name == "paper") return paper_scheme();
  return scheme_of(nlohmann::ordered_json::parse(canonical_text(read_scene(name).scene)));
}

void write_if_asked(const fs::path& path, const std::string& text) {
  if (!path.empty()) write_text(path, text);
}

void run_suite(const StabilityArguments& arguments) {
  const std::vector<StabilityCase> cases = chosen(arguments.cases);
  const nlohmann::ordered_json scheme = chosen_scheme(arguments.scheme);
  // Until the process has ended, and so never destroyed: a wish that comes twice must not end it
  // before its verdicts are told.
  [[maybe_unused]] static const SignalRequests& signals = *new SignalRequests;
  const SuiteFolder folder(arguments.folder);
  CaseRunner bench(folder.path(), arguments.quick ? SuiteForm::quick : SuiteForm::full, scheme);
  std::vector<JudgedCase> judged;
  for (const StabilityCase& each : cases) {
    const std::string_view cause = arguments.scheme == "paper" ? each.paper_miss : "";
    judged.push_back({each, run_case(each, bench), cause});
    fmt::print("{}\n", suite_line(judged.back()));
    std::fflush(stdout);
  }
  write_if_asked(arguments.json, suite_json(judged).dump(2) + "\n");
  write_if_asked(arguments.html, suite_html(judged));
  fmt::print("{}\n", tally_text(tally(judged)));
  if (tally(judged).missed > 0) throw CommandEnd(ExitCode::numerical_failure);
}

void run_map(const StabilityArguments& arguments) {
  const StabilityMap map = make_stability_map([](const StabilityRow& row) {
    fmt::print("{}\n", map_text_line(row));
    std::fflush(stdout);
  });
  write_if_asked(arguments.json, map_json(map).dump(2) + "\n");
  write_if_asked(arguments.svg, map_svg(map));
  fmt::print("{} cells, {} differ from the prediction (+ stable, - grows, ! differs)\n",
             map.cells(), map.disagreements());
}

void run_order(const StabilityArguments& arguments) {
  // Until the process has ended, and so never destroyed: a wish that comes twice must not end it
  // before its verdicts are told.
  [[maybe_unused]] static const SignalRequests& signals = *new SignalRequests;
  const SuiteFolder folder(arguments.folder);
  CaseRunner bench(folder.path(), arguments.quick ? SuiteForm::quick : SuiteForm::full,
                   chosen_scheme(arguments.scheme));
  const std::vector<DropPoint> points = run_drops(bench);
  write_if_asked(arguments.json, drop_json(points).dump(2) + "\n");
  fmt::print("{}", table_text(drop_table(points)));
}

void stability(const StabilityArguments& arguments) {
  if (arguments.list) {
    for (const StabilityCase& each : all_cases()) {
      fmt::print("{:<18} {}; {}\n", each.name, each.about, each.gate);
    }
    return;
  }
  if (arguments.map) return run_map(arguments);
  try {
    arguments.order ? run_order(arguments) : run_suite(arguments);
  } catch (const SuiteStopped& stopped) {
    throw CommandEnd(ExitCode::checkpointed,
                     fmt::format("{}: cases without a line above have no verdict; name them to "
                                 "resume",
                                 stopped.what()));
  }
}

}  // namespace

void add_stability(CLI::App& app) {
  const auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* verb =
      app.add_subcommand("stability", "Run stiff and extreme cases and hold each against its gate");
  verb->add_option("case", arguments->cases, "Cases to run; all when none is named");
  verb->add_option("--scheme", arguments->scheme,
                   "recommended, paper, or a scene (JSON) whose numerics to take")
      ->capture_default_str();
  verb->add_flag("--quick", arguments->quick, "Small forms of the cases");
  verb->add_flag("--list", arguments->list, "Name the cases and their gates");
  CLI::Option* map = verb->add_flag("--map", arguments->map,
                                    "Predicted and measured limits of the Courant number instead");
  verb->add_flag("--order", arguments->order,
                 "Order of convergence on the elliptical drop, over four spacings, instead")
      ->excludes(map);
  verb->add_option("--json", arguments->json, "Also write JSON into this file");
  verb->add_option("--html", arguments->html, "Also write a report with pictures into this file")
      ->excludes(map);
  verb->add_option("--svg", arguments->svg, "With --map: draw it into this file")->needs(map);
  verb->add_option("--folder", arguments->folder,
                   "Keep the cases' job folders here, checkpoints included");
  verb->footer(
      "Exit code 0: all gates met, or missed for a cause named beside them; 4: some "
      "missed; 85: stopped.\nExample: sluice stability still-tank --quick");
  verb->callback([arguments] { stability(*arguments); });
}

}  // namespace sluice

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "cli/adopt_scene.hpp"
#include "cli/checks.hpp"
#include "cli/client/service_study.hpp"
#include "cli/run_pool.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/execute/local_executor.hpp"
#include "engine/report/study_row.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/publish.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/study/study_output.hpp"
#include "service/jobs/job_ids.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

namespace fs = std::filesystem;

struct StudyArguments {
  std::string study;  ///< a file; with --server also the id of a study
  ServiceStudy service;
  fs::path folder;
  int cores = 0;
  std::vector<double> below;
  bool json = false;
  bool no_run = false;

  [[nodiscard]] fs::path file() const { return study; }
};

/// A study with the files that its scenes name, which lie beside it.
struct StudyFile {
  StudyPlan plan;
  SceneParts parts;
};

StudyFile read_study(const fs::path& file) {
  std::string path = file.string();
  if (const std::string wrong = existing_file()(path); !wrong.empty()) {
    throw CommandEnd(ExitCode::usage, wrong);
  }
  const fs::path beside = file.parent_path();
  const SceneParts parts = parts_beside(file);
  StudyPlan plan = plan_study(
      read_text(file, kMaxSceneBytes + 1),
      [&](const std::string& name) { return read_text(beside / name, kMaxSceneBytes + 1); },
      kMaxStudyRuns, SceneOrigin::user, parts);
  if (plan.problems.empty()) return {std::move(plan), parts};
  for (const Problem& problem : plan.problems) {
    std::fputs(fmt::format("{}: {}: {}\n", file.string(),
                           problem.pointer.empty() ? "(the whole study)" : problem.pointer,
                           problem.message)
                   .c_str(),
               stderr);
  }
  const std::size_t count = plan.problems.size();
  throw CommandEnd(ExitCode::invalid_scene,
                   fmt::format("{} is no valid study: {} problem{}", file.string(), count,
                               count == 1 ? "" : "s"));
}

/// Each once, with the first run that has it: most are of all runs.
void print_warnings(const fs::path& file, const std::vector<StudyRun>& runs) {
  std::set<std::pair<std::string, std::string>> told;
  for (const StudyRun& run : runs) {
    for (const Problem& warning : run.warnings) {
      if (!told.emplace(warning.pointer, warning.message).second) continue;
      std::fputs(fmt::format("{}: warning: run {}: {}: {}\n", file.string(), run.name,
                             warning.pointer, warning.message)
                     .c_str(),
                 stderr);
    }
  }
}

/// The folder of a study: study.json, runs/NAME with a log beside each, and the results.
class StudyFolder {
 public:
  explicit StudyFolder(fs::path root) : root_(std::move(root)) {}

  [[nodiscard]] fs::path run(const StudyRun& run) const { return root_ / "runs" / run.name; }
  [[nodiscard]] fs::path log(const StudyRun& run) const {
    return root_ / "runs" / (run.name + ".log");
  }
  [[nodiscard]] fs::path lock() const { return root_ / "lock"; }

  void make() const {
    std::error_code error;
    fs::create_directories(root_ / "runs", error);
    if (error) {
      throw CommandEnd(ExitCode::storage_failure,
                       fmt::format("cannot make {}: {}; name another folder with --folder",
                                   (root_ / "runs").string(), error.message()));
    }
  }

  [[nodiscard]] StudyResult read(const StudyPlan& plan) const {
    std::vector<StudyRow> rows;
    for (const StudyRun& one : plan.runs) rows.push_back(read_row(run(one), one));
    return evaluate(plan.study, plan.runs, std::move(rows));
  }

  void publish_study(const std::string& text) const { publish_text(root_ / "study.json", text); }

  void publish(const StudyResult& result) const {
    publish_text(root_ / "results.md", study_markdown(result));
    publish_text(root_ / "results.csv", study_csv(result));
    publish_text(root_ / "results.json", study_json(result).dump(2) + "\n");
    publish_text(root_ / "error-cost.svg", chart_svg(study_chart(result), SvgPlace::file));
  }

 private:
  fs::path root_;
};

/// Makes the folder the working directory: it keeps its study, whatever it is called meanwhile.
StudyFolder entered(const fs::path& root) {
  std::error_code error;
  fs::current_path(root, error);
  if (!error) return StudyFolder(".");
  throw CommandEnd(ExitCode::storage_failure,
                   fmt::format("cannot enter {}: {}", root.string(), error.message()));
}

/// Runs what is not done yet, several at once, and says how each ended.
class StudyRunner {
 public:
  StudyRunner(const StudyPlan& plan, const SceneParts& parts, const StudyFolder& folder, int cores,
              RunPool& pool)
      : plan_(plan),
        parts_(parts),
        folder_(folder),
        pool_(pool),
        at_once_(static_cast<std::size_t>(std::max(1, cores / plan.study.threads))) {}

  /// False when it was asked to stop before the end.
  bool run_all() {
    std::vector<std::size_t> open = open_runs();
    std::size_t next = 0;
    while (next < open.size() || pool_.running() > 0) {
      while (!stopping_ && next < open.size() && pool_.running() < at_once_) start(open[next++]);
      if (pool_.running() == 0) break;
      if (const auto ended = pool_.wait()) {
        tell(ended->number);
      } else {
        stop();
      }
    }
    return !stopping_;
  }

 private:
  /// All but what is completed and what failed by its own numbers, which would fail again.
  std::vector<std::size_t> open_runs() {
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < plan_.runs.size(); ++k) {
      const RunState state = read_row(folder_.run(plan_.runs[k]), plan_.runs[k]).state;
      if (state == RunState::completed || state == RunState::failed) {
        ++done_;
      } else {
        open.push_back(k);
      }
    }
    if (done_ > 0) say(fmt::format("{} of {} runs are done already", done_, plan_.runs.size()));
    return open;
  }

  void start(std::size_t number) {
    const StudyRun& run = plan_.runs[number];
    prepare_folder(folder_.run(run), run.scene_text, run.scene, parts_of(run.scene, parts_));
    pool_.start(number, folder_.run(run), folder_.log(run), plan_.study.threads);
  }

  void tell(std::size_t number) {
    const StudyRun& run = plan_.runs[number];
    const StudyRow row = read_row(folder_.run(run), run);
    std::string text =
        fmt::format("[{}/{}] {}: {}", ++done_, plan_.runs.size(), run.name, to_string(row.state));
    if (row.error) text += fmt::format(", error {:.4f}", *row.error);
    if (row.core_seconds) text += fmt::format(", {:.4g} core-seconds", *row.core_seconds);
    if (!row.reason.empty()) text += ": " + row.reason;
    say(text);
  }

  void stop() {
    if (!stopping_) say("stopping: what runs writes a checkpoint; run the study again to resume");
    stopping_ = true;
    pool_.stop_all();
  }

  /// A terminal that was closed is no reason to end: nothing here throws.
  static void say(const std::string& text) {
    std::fputs((text + "\n").c_str(), stderr);
    std::fflush(stderr);
  }

  const StudyPlan& plan_;
  const SceneParts& parts_;
  const StudyFolder& folder_;
  RunPool& pool_;
  std::size_t at_once_;
  std::size_t done_ = 0;
  bool stopping_ = false;
};

void end_unless_complete(const StudyResult& result, const fs::path& folder) {
  const auto open = std::count_if(result.rows.begin(), result.rows.end(), [](const StudyRow& row) {
    return row.state == RunState::waiting || row.state == RunState::stopped;
  });
  if (open == 0) return;
  throw CommandEnd(ExitCode::storage_failure,
                   fmt::format("{} of {} runs did not end: see the logs in {}", open,
                               result.rows.size(), (folder / "runs").string()));
}

/// The study as text with its base scene in it, because a service reads no files for others.
std::string whole_document(const StudyArguments& arguments) {
  const fs::path file = arguments.file();
  static_cast<void>(read_study(file));
  Json document = Json::parse(read_text(file, kMaxSceneBytes + 1));
  const auto take_in = [&](Json& scene) {
    if (!scene.is_string()) return;
    scene =
        Json::parse(read_text(file.parent_path() / scene.get<std::string>(), kMaxSceneBytes + 1));
  };
  take_in(document["scene"]);
  if (document.contains("cases")) {
    for (Json& one : document["cases"]) {
      if (one.contains("scene")) take_in(one["scene"]);
    }
  }
  for (const double target : arguments.below) document["targets"].push_back(target);
  return document.dump();
}

void study_by_service(const StudyArguments& arguments) {
  if (arguments.no_run || !arguments.folder.empty() || arguments.cores > 0) {
    throw CommandEnd(ExitCode::usage,
                     "--folder, --cores and --no-run belong to a study on this machine: leave them "
                     "out with --server");
  }
  ServiceStudy options = arguments.service;
  options.json = arguments.json;
  std::error_code ignored;
  if (!fs::exists(arguments.study, ignored)) return show_study(options, arguments.study);
  submit_study(options, whole_document(arguments), arguments.study);
}

/// Does `action`, which stands in the folder `root`, and tells its errors to those who do not.
template <class Action>
auto told_from(const fs::path& root, const Action& action) {
  try {
    return action();
  } catch (const StorageError& error) {
    throw told_outside(root, error);
  } catch (const CommandEnd& end) {
    throw CommandEnd(static_cast<ExitCode>(end.code()),
                     told_outside(root, std::string(end.what())));
  }
}

void study(StudyArguments arguments) {
  ServiceStudy& service = arguments.service;
  if (is_of_service(service.service, service.of_service, arguments.study)) {
    return study_by_service(arguments);
  }
  if (arguments.service.watch || !arguments.service.key.empty()) {
    throw CommandEnd(ExitCode::usage, "--watch and --idempotency-key go with --server");
  }
  auto [plan, parts] = read_study(arguments.file());
  print_warnings(arguments.file(), plan.runs);
  plan.study.targets.insert(plan.study.targets.end(), arguments.below.begin(),
                            arguments.below.end());
  const fs::path root = arguments.folder.empty() ? fs::path(plan.study.name) : arguments.folder;
  const std::string text = read_text(arguments.file(), kMaxSceneBytes + 1);
  StudyFolder(root).make();
  const FolderLock lock(StudyFolder(root).lock());
  const StudyFolder folder = entered(root);
  // Until the results are written: a signal that comes twice must not end the study before.
  RunPool pool(local_executor());
  bool finished = true;
  if (!arguments.no_run) {
    folder.publish_study(text);
    const int cores = arguments.cores > 0
                          ? arguments.cores
                          : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    StudyRunner runner(plan, parts, folder, cores, pool);
    finished = told_from(root, [&] { return runner.run_all(); });
  }
  const StudyResult result = told_from(root, [&] {
    StudyResult rows = folder.read(plan);
    folder.publish(rows);
    return rows;
  });
  const std::string shown = arguments.json ? study_json(result).dump(2) + "\n" : study_text(result);
  std::fwrite(shown.data(), 1, shown.size(), stdout);
  if (!finished) throw CommandEnd(ExitCode::checkpointed);
  if (!arguments.no_run) end_unless_complete(result, root);
}

}  // namespace

void add_study(CLI::App& app) {
  const auto arguments = std::make_shared<StudyArguments>();
  CLI::App* verb = app.add_subcommand(
      "study", "Run a scene with its keys varied, and compare error and cost of all runs");
  verb->add_option("study", arguments->study,
                   "The study (JSON; schemas/study.schema.json); with --server also the id of one "
                   "that was submitted")
      ->required();
  verb->add_option("--folder", arguments->folder,
                   "Where its runs and results go, and where it resumes; by default the study's "
                   "name in this folder");
  verb->add_option("--cores", arguments->cores, "Cores to use; by default all")
      ->check(whole_between(1, 1024));
  verb->add_option("--below", arguments->below,
                   "An error for which the cheapest set-up is sought, beside the study's targets")
      ->check(number_above_zero());
  verb->add_flag("--json", arguments->json, "Print JSON for programs");
  verb->add_flag("--no-run", arguments->no_run, "Only put together what is there");
  add_service_study_options(*verb, arguments->service);
  verb->footer(
      "The folder then holds results.md, results.csv, results.json and error-cost.svg. Stop it "
      "with\nCtrl-C (exit 85); the same command resumes.\nExample: sluice study "
      "schemas/examples/study-quick.json --folder first-study\n"
      "         sluice study schemas/examples/study-quick.json --server http://127.0.0.1:8080 "
      "--watch");
  verb->callback([arguments] { study(*arguments); });
}

}  // namespace sluice

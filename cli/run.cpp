#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/adopt_scene.hpp"
#include "cli/checks.hpp"
#include "cli/machine.hpp"
#include "cli/run_end.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/run/reporter.hpp"
#include "engine/run/run_loop.hpp"
#include "engine/run/signals.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

enum class ProgressForm { automatic, bar, json, none };

struct RunArguments {
  std::string target;
  std::string folder;
  int threads = 0;
  std::string simd;
  ProgressForm progress = ProgressForm::automatic;
  std::optional<std::uint64_t> stop_after_step;
  std::optional<std::uint64_t> checkpoint_every;
  bool no_checkpoint = false;
  double storage_patience = RunOptions{}.storage_patience;
};

/// A scene's name as the name of a folder.
std::string folder_name(const std::string& scene_name) {
  std::string name;
  for (const char letter : scene_name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' ||
                       letter == '-' || (letter == '.' && !name.empty());
    name += plain ? letter : '-';
  }
  return name.empty() ? "job" : name;
}

struct OpenedJob {
  JobFolder folder;
  Scene scene;
};

OpenedJob open_job(const fs::path& root) {
  JobFolder folder = JobFolder::open(root);
  Scene scene = job_scene_or_end(folder.scene_text(), folder.paths().scene());
  return {std::move(folder), std::move(scene)};
}

OpenedJob make_job(const fs::path& scene_path, const std::string& wanted_folder) {
  SceneFile file = read_scene(scene_path);
  const fs::path root = wanted_folder.empty() ? folder_name(file.scene.name) : wanted_folder;
  if (!JobFolder::holds_job(root)) {
    return {JobFolder::create(root, file.text, file.parts), std::move(file.scene)};
  }
  JobFolder folder = JobFolder::open(root);
  adopt_scene(folder, file.text, file.scene);
  return {std::move(folder), std::move(file.scene)};
}

OpenedJob find_job(const RunArguments& arguments) {
  if (!fs::is_directory(arguments.target)) return make_job(arguments.target, arguments.folder);
  if (!arguments.folder.empty()) {
    throw CommandEnd(ExitCode::usage, "--folder goes with a scene, not with a folder");
  }
  return open_job(arguments.target);
}

RunOptions options_of(const RunArguments& arguments, const Scene& scene) {
  RunOptions options;
  options.execution = {arguments.threads > 0 ? arguments.threads : default_threads(scene),
                       arguments.simd};
  options.stop_after_step = arguments.stop_after_step;
  options.storage_patience = arguments.storage_patience;
  if (arguments.no_checkpoint) options.checkpoints = CheckpointPolicy::at_end_only;
  if (arguments.checkpoint_every) {
    options.checkpoints = CheckpointPolicy::every_steps;
    options.checkpoint_steps = *arguments.checkpoint_every;
  }
  return options;
}

ProgressForm chosen_form(ProgressForm form) {
  if (form != ProgressForm::automatic) return form;
  return isatty(STDOUT_FILENO) == 1 ? ProgressForm::bar : ProgressForm::json;
}

std::unique_ptr<Reporter> make_reporter(ProgressForm form) {
  if (form == ProgressForm::bar) return std::make_unique<BarReporter>(stdout);
  if (form == ProgressForm::json) return std::make_unique<JsonReporter>(stdout);
  return std::make_unique<SilentReporter>();
}

/// A report of an earlier, shorter run says nothing about this one.
void remove_report(const JobPaths& paths) {
  std::error_code ignored;
  for (const fs::path& path : {paths.report(), paths.report_markdown(), paths.report_html()}) {
    fs::remove(path, ignored);
  }
}

void run(const RunArguments& arguments) {
  // Until the process has ended, and so never destroyed: a wish that comes twice must not end it
  // before it has said how it went.
  static const SignalRequests& signals = *new SignalRequests;
  OpenedJob job = find_job(arguments);
  job.folder.enter();
  const std::string earlier = completed_outcome(job.folder, job.scene);
  remove_report(job.folder.paths());
  const ProgressForm form = chosen_form(arguments.progress);
  const auto reporter = make_reporter(form);
  const Outcome outcome =
      run_job(job.folder, job.scene, options_of(arguments, job.scene), *reporter);
  const std::string closing = closing_text(job.folder, outcome, earlier);
  leave_report(job.folder, outcome, arguments.storage_patience,
               [] { return signals.stop_requested(); });
  job.folder.remove_leftovers();
  // Stdout belongs to the JSON lines where they are written.
  std::FILE* const out = form == ProgressForm::bar ? stdout : stderr;
  std::fputs((closing + next_commands(job.folder, job.scene, outcome)).c_str(), out);
  if (outcome.exit_code == ExitCode::done) return;
  // Without a digest, what the run goes on from is not where it stopped: that needs words.
  const bool plain_stop =
      outcome.exit_code == ExitCode::checkpointed && !outcome.physics_digest.empty();
  throw CommandEnd(outcome.exit_code, plain_stop ? "" : outcome.reason);
}

void add_test_options(CLI::App& verb, RunArguments& arguments) {
  const std::string group = "For tests and scripts";
  verb.add_option("--stop-after-step", arguments.stop_after_step,
                  "Stop with a checkpoint, exit 85, once this step is done")
      ->check(whole_from(0))
      ->group(group);
  auto* every = verb.add_option("--checkpoint-every", arguments.checkpoint_every,
                                "A checkpoint every N steps instead of by its cost")
                    ->check(whole_from(1))
                    ->group(group);
  verb.add_flag("--no-checkpoint", arguments.no_checkpoint,
                "No checkpoint before the end or a stop")
      ->excludes(every)
      ->group(group);
  verb.add_option("--storage-patience", arguments.storage_patience,
                  "Seconds to keep trying when the disk is full or refuses")
      ->check(number_between(0.0, 1e6))
      ->capture_default_str()
      ->group(group);
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* verb = app.add_subcommand("run", "Run a scene, or resume the job in a folder");
  verb->add_option("target", arguments->target, "A scene (JSON) or a job's folder")
      ->required()
      ->check(existing_or_stdin());
  verb->add_option("--folder", arguments->folder,
                   "The job's folder for a scene; by default the scene's name in this folder");
  add_execution_options(*verb, arguments->threads, arguments->simd);
  const std::map<std::string, ProgressForm> forms{{"auto", ProgressForm::automatic},
                                                  {"bar", ProgressForm::bar},
                                                  {"json", ProgressForm::json},
                                                  {"none", ProgressForm::none}};
  verb->add_option("--progress", arguments->progress,
                   "auto: a bar on a terminal, else one JSON line a second")
      ->transform(one_of(forms));
  add_test_options(*verb, *arguments);
  verb->footer(
      "SIGUSR1 asks for a checkpoint; SIGTERM or Ctrl-C stops with one (exit 85); once more "
      "after two seconds: at once.\nExample: sluice run dambreak-quick.json --folder first-try && "
      "sluice run first-try");
  verb->callback([arguments] { run(*arguments); });
}

}  // namespace sluice

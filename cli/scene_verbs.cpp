#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/machine.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/run/progress.hpp"
#include "engine/run/simulation.hpp"
#include "engine/run/stopwatch.hpp"
#include "engine/scene/estimate.hpp"
#include "engine/scene/initial.hpp"
#include "engine/scene/parse.hpp"
#include "engine/scene/plan.hpp"
#include "engine/scene/stability.hpp"
#include "engine/scene/walls.hpp"
#include "engine/store/file_system.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// Above this many particles no trial is made: filling the scene alone would take long.
constexpr std::uint64_t kTrialParticles = 5'000'000;
constexpr double kTrialSeconds = 0.5;

struct SceneArguments {
  std::string scene;
  bool json = false;
  bool no_calibration = false;
  int threads = 0;
  std::string simd;
};

/// What a short trial on this machine showed.
struct Calibration {
  double seconds_per_step = 0.0;
  double particle_steps_per_second = 0.0;
  double time_step = 0.0;  ///< of the trial's last step, s
  int threads = 1;
};

/// Steps the scene itself for about half a second; the first step is left out, because it sorts
/// and allocates.
Calibration calibrate(const Scene& scene, const Execution& execution) {
  Simulation simulation(scene, execution);
  simulation.step();
  const std::uint64_t first = simulation.solver().step_count();
  const std::uint64_t before = simulation.particle_steps();
  const Stopwatch clock;
  do {
    simulation.step();
  } while (clock.seconds() < kTrialSeconds && !simulation.finished());
  const double seconds = clock.seconds();
  const auto steps = static_cast<double>(simulation.solver().step_count() - first);
  return {seconds / steps, static_cast<double>(simulation.particle_steps() - before) / seconds,
          simulation.solver().time_step(), simulation.solver().threads()};
}

std::string size_text(std::uint64_t bytes) {
  constexpr double kMebi = 1024.0 * 1024.0;
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / kMebi);
}

void print_items(std::string_view title, const std::vector<PlanItem>& items) {
  if (items.empty()) return;
  fmt::print("{}\n", title);
  for (const PlanItem& item : items) {
    fmt::print("  {:<24} {} [{}]\n", item.name, item.description, item.reason);
  }
}

void print_plan(const Plan& plan, const Estimate& estimate, const StabilityPrediction& outlook,
                const std::optional<Calibration>& trial) {
  print_items("passes and terms that run", plan.passes);
  print_items("left out", plan.passes_left_out);
  print_items("fields", plan.fields);
  print_items("fields not allocated", plan.fields_left_out);
  print_items("files", plan.files);
  print_items("files not written", plan.files_left_out);
  fmt::print("estimate\n  {} fluid and {} wall particles, about {} steps of {:.3g} s\n",
             estimate.fluid_particles, estimate.wall_particles, estimate.steps, estimate.time_step);
  fmt::print("  {} of memory, {} on disk, {} samples, {} frames\n",
             size_text(estimate.memory_bytes), size_text(estimate.disk_bytes), estimate.samples,
             estimate.frames);
  fmt::print("stability\n  {}\n", stability_text(outlook));
  if (!trial) return;
  fmt::print(
      "  {} on {} threads, from a trial of {} s ({:.1f} million particle steps per second)\n",
      duration_text(trial->seconds_per_step * static_cast<double>(estimate.steps)), trial->threads,
      kTrialSeconds, trial->particle_steps_per_second * 1e-6);
}

void print_plan_json(const Plan& plan, const Estimate& estimate, const StabilityPrediction& outlook,
                     const std::optional<Calibration>& trial) {
  Json object{{"plan", Json::parse(plan_json(plan))},
              {"estimate", Json::parse(estimate_json(estimate))},
              {"stability", Json::parse(stability_json(outlook))}};
  object["calibration"] = nullptr;
  if (trial) {
    object["calibration"] =
        Json{{"seconds", trial->seconds_per_step * static_cast<double>(estimate.steps)},
             {"seconds_per_step", trial->seconds_per_step},
             {"particle_steps_per_second", trial->particle_steps_per_second},
             {"time_step", trial->time_step},
             {"threads", trial->threads}};
  }
  fmt::print("{}\n", object.dump(2));
}

void show_plan(const SceneArguments& arguments) {
  const Scene scene = read_scene(arguments.scene).scene;
  const Estimate needs = estimate(scene);
  const bool small = needs.fluid_particles + needs.wall_particles <= kTrialParticles;
  std::optional<Calibration> trial;
  if (!arguments.no_calibration && small) {
    const int threads = arguments.threads > 0 ? arguments.threads : default_threads(scene);
    try {
      trial = calibrate(scene, {threads, arguments.simd});
    } catch (const NumericalFailure& failure) {
      throw CommandEnd(ExitCode::numerical_failure,
                       fmt::format("the trial failed: {}", failure.what()));
    }
  }
  (arguments.json ? print_plan_json : print_plan)(plan(scene), needs, predict_stability(scene),
                                                  trial);
}

/// All problems as JSON on stdout: for editors and scripts.
void validate_as_json(const std::string& path) {
  ParseResult result = parse_scene(read_text(path, kMaxSceneBytes + 1));
  if (result.scene && estimate(*result.scene).fluid_particles <= kTrialParticles) {
    if (auto problem = problem_when_filled(*result.scene)) {
      result.problems.push_back(*std::move(problem));
    }
  }
  Json problems = Json::array();
  for (const Problem& problem : result.problems) {
    problems.push_back(Json{{"pointer", problem.pointer}, {"message", problem.message}});
  }
  const Json report{{"valid", result.problems.empty()}, {"problems", problems}};
  fmt::print("{}\n", report.dump(2));
  if (!result.problems.empty()) throw CommandEnd(ExitCode::invalid_scene);
}

void validate(const SceneArguments& arguments) {
  if (arguments.json) return validate_as_json(arguments.scene);
  const Scene scene = read_scene(arguments.scene).scene;
  Estimate needs = estimate(scene);
  // Regions that overlap show only when they are filled; what displaces fluid is then known too.
  if (needs.fluid_particles <= kTrialParticles) {
    needs.fluid_particles = start_plan(scene).fluid_particles;
    needs.wall_particles = scene_walls(scene).size();
  }
  fmt::print("{} is a valid scene: {} fluid and {} wall particles\n", arguments.scene,
             needs.fluid_particles, needs.wall_particles);
}

std::shared_ptr<SceneArguments> add_scene_options(CLI::App& verb) {
  auto arguments = std::make_shared<SceneArguments>();
  verb.add_option("scene", arguments->scene, "A scene (JSON)")
      ->required()
      ->check(CLI::ExistingFile);
  verb.add_flag("--json", arguments->json, "Print JSON");
  return arguments;
}

}  // namespace

void add_validate(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("validate", "Check a scene and name every problem at once");
  const auto arguments = add_scene_options(*verb);
  verb->footer("Example: sluice validate my-scene.json");
  verb->callback([arguments] { validate(*arguments); });
}

void add_plan(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "plan",
      "Show what a scene runs and leaves out, and what it takes; steps it for half a second");
  const auto arguments = add_scene_options(*verb);
  verb->add_flag("--no-calibration", arguments->no_calibration, "Do not step the scene");
  add_execution_options(*verb, arguments->threads, arguments->simd);
  verb->footer("Example: sluice plan my-scene.json --threads 2");
  verb->callback([arguments] { show_plan(*arguments); });
}

}  // namespace sluice

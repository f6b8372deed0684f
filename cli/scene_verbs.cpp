#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/checks.hpp"
#include "cli/client/job_text.hpp"
#include "cli/machine.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/forecast/plan.hpp"
#include "engine/scene/forecast/stability.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// Above this many particles none is made: filling the scene alone would take long.
constexpr std::uint64_t kTrialParticles = 5'000'000;

struct SceneArguments {
  std::string scene;
  bool json = false;
  bool no_calibration = false;
  int threads = 0;
  std::string simd;
};

/// What a run takes on this machine.
struct Cost {
  double seconds = 0.0;
  double particle_steps_per_second = 0.0;
  int threads = 1;
};

Cost cost_of(const Scene& scene, const Estimate& needs, const SceneArguments& arguments) {
  const int threads = arguments.threads > 0 ? arguments.threads : default_threads(scene);
  const double seconds = expected_core_seconds(scene, needs, arguments.simd) / threads;
  const double particle_steps =
      static_cast<double>(needs.fluid_particles) * static_cast<double>(needs.steps);
  return {seconds, particle_steps / seconds, threads};
}

std::string size_text(std::uint64_t bytes) {
  constexpr double kMebi = 1024.0 * 1024.0;
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / kMebi);
}

void print_items(std::string_view title, const std::vector<PlanItem>& items) {
  if (items.empty()) return;
  fmt::print("{}\n", title);
  for (const PlanItem& item : items) {
    fmt::print("  {:<29} {} [{}]\n", item.name, item.description, item.reason);
  }
}

void print_plan(const Plan& plan, const Estimate& estimate, const StabilityPrediction& outlook,
                const std::optional<Cost>& cost) {
  print_items("numerics", plan.numerics);
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
  if (cost) {
    fmt::print(
        "  {} on {} thread{} of an otherwise idle machine ({:.1f} million particle steps per "
        "second)\n",
        cost_text(cost->seconds), cost->threads, cost->threads == 1 ? "" : "s",
        cost->particle_steps_per_second * 1e-6);
  }
  fmt::print("stability\n  {}\n", stability_text(outlook));
}

Json list_of(const std::vector<Problem>& problems) {
  Json list = Json::array();
  for (const Problem& problem : problems) {
    list.push_back(Json{{"pointer", problem.pointer}, {"message", problem.message}});
  }
  return list;
}

void print_plan_json(const Plan& plan, const Estimate& estimate, const StabilityPrediction& outlook,
                     const std::optional<Cost>& cost, const std::vector<Problem>& warnings) {
  Json object{{"plan", Json::parse(plan_json(plan))},
              {"estimate", Json::parse(estimate_json(estimate))},
              {"stability", Json::parse(stability_json(outlook))},
              {"warnings", list_of(warnings)}};
  object["calibration"] = nullptr;
  if (cost) {
    object["calibration"] =
        Json{{"seconds", cost->seconds},
             {"seconds_per_step", cost->seconds / static_cast<double>(estimate.steps)},
             {"particle_steps_per_second", cost->particle_steps_per_second},
             {"time_step", estimate.time_step},
             {"threads", cost->threads}};
  }
  fmt::print("{}\n", object.dump(2));
}

/// With the particles counted as they are made, unless that would take long. Throws SceneError for
/// what shows only when a scene is filled: regions that overlap.
Estimate estimate_of(const Scene& scene) {
  const Estimate rough = estimate(scene);
  const bool small = rough.fluid_particles + rough.wall_particles <= kTrialParticles;
  return small ? exact_estimate(scene) : rough;
}

void show_plan(const SceneArguments& arguments) {
  const SceneFile file = read_scene(arguments.scene);
  const Scene& scene = file.scene;
  const Estimate needs = estimate_of(scene);
  std::optional<Cost> cost;
  if (!arguments.no_calibration) cost = cost_of(scene, needs, arguments);
  const StabilityPrediction outlook = predict_stability(scene);
  if (arguments.json) return print_plan_json(plan(scene), needs, outlook, cost, file.warnings);
  print_plan(plan(scene), needs, outlook, cost);
  fmt::print("{}", warnings_text(file.warnings, arguments.scene));
}

/// All problems and warnings as JSON on stdout: for editors and scripts.
void validate_as_json(const std::string& path) {
  ParseResult result = parse_scene(read_scene_bytes(path), parts_beside(path));
  if (result.scene && estimate(*result.scene).fluid_particles <= kTrialParticles) {
    if (auto problem = problem_when_filled(*result.scene)) {
      result.problems.push_back(*std::move(problem));
    }
  }
  const Json report{{"valid", result.problems.empty()},
                    {"problems", list_of(result.problems)},
                    {"warnings", list_of(result.warnings)}};
  fmt::print("{}\n", report.dump(2));
  if (!result.problems.empty()) throw CommandEnd(ExitCode::invalid_scene);
}

void validate(const SceneArguments& arguments) {
  if (arguments.json) return validate_as_json(arguments.scene);
  const SceneFile file = read_scene(arguments.scene);
  const Estimate needs = estimate_of(file.scene);
  fmt::print("{}", warnings_text(file.warnings, arguments.scene));
  fmt::print("{} is a valid scene: {} fluid and {} wall particles\n", arguments.scene,
             needs.fluid_particles, needs.wall_particles);
}

std::shared_ptr<SceneArguments> add_scene_options(CLI::App& verb) {
  auto arguments = std::make_shared<SceneArguments>();
  verb.add_option("scene", arguments->scene, "A scene (JSON), or - for stdin")
      ->required()
      ->check(file_or_stdin());
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
      "plan", "Show what a scene runs and leaves out, and what it takes on this machine");
  const auto arguments = add_scene_options(*verb);
  verb->add_flag("--no-calibration", arguments->no_calibration, "Do not measure the machine");
  add_execution_options(*verb, arguments->threads, arguments->simd);
  verb->footer("Example: sluice plan my-scene.json --threads 2");
  verb->callback([arguments] { show_plan(*arguments); });
}

}  // namespace sluice

#include "engine/verify/case_runner.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "engine/run/events.hpp"
#include "engine/run/run_loop.hpp"
#include "engine/run/simulation.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/store/files/digest.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// Keeps the warnings of a run.
class WarningKeeper final : public Reporter {
 public:
  explicit WarningKeeper(std::vector<std::string>& kept) : kept_(&kept) {}
  void progress(const Progress&) override {}
  void event(const RunEvent& event) override {
    if (event.kind == EventKind::warning) kept_->push_back(event.message());
  }

 private:
  std::vector<std::string>* kept_;
};

/// The state at step 0 with other velocities, as the checkpoint that the job goes on from.
Checkpoint prepared(const Scene& scene, const CaseRunner::Prepare& prepare) {
  Checkpoint start = Simulation(scene, {}).checkpoint();
  Particles& particles = start.solver.particles;
  prepare(particles);
  if (scene.method.integrator == Integrator::modified_leap_frog) {
    particles.velocity_half = particles.velocity;
  }
  const Solver solver(scene.method, scene.domain, start.solver, scene_walls(scene), {});
  start.guards = initial_baselines(scene.method, start.solver, solver.energy());
  return start;
}

}  // namespace

bool CaseRun::completed() const { return problems.empty() && outcome.exit_code == ExitCode::done; }

const Series& CaseRun::sensor(std::string_view name) const {
  for (const Series& each : series) {
    if (each.name == name) return each;
  }
  throw std::logic_error(fmt::format("the case has no sensor {}", name));
}

CaseRun CaseRunner::run(const Json& scene, StabilityCheck stability, const Prepare& prepare) {
  CaseRun run;
  const Json whole = scene.contains("numerics") ? scene : with_scheme(scene, scheme_);
  const std::string text = whole.dump(2) + "\n";
  ParseResult parsed = parse_scene(text, stability, SceneOrigin::job);
  if (!parsed.scene) {
    run.problems = std::move(parsed.problems);
    return run;
  }
  run.scene = *std::move(parsed.scene);
  if (const auto problem = problem_when_filled(run.scene)) {
    run.problems.push_back(*problem);
    return run;
  }
  const std::string name = fmt::format("{:03}-{}", ++runs_, run.scene.name);
  JobFolder folder = JobFolder::create(folder_ / name, text);
  if (prepare) folder.write_checkpoint(prepared(run.scene, prepare));

  WarningKeeper reporter(run.warnings);
  RunOptions options;
  run.outcome = run_job(folder, run.scene, options, reporter);
  if (run.outcome.exit_code == ExitCode::checkpointed) throw SuiteStopped();
  if (auto restored = folder.newest_checkpoint(identity_of(run.scene))) {
    run.checkpoint = name + "/" + restored->path.filename().string();
    run.last = std::move(restored->checkpoint);
  }
  if (std::filesystem::exists(folder.paths().series())) {
    run.series = read_series(folder.paths().series());
  }
  return run;
}

}  // namespace sluice

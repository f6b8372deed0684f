#include "engine/run/outcome.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/run/build_id.hpp"
#include "engine/run/machine_name.hpp"
#include "engine/run/reporter.hpp"
#include "engine/store/files/digest.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct CostLine {
  std::string name;
  double seconds;
};

/// All that was timed, then what is left of the total.
std::vector<CostLine> cost_lines(const Account& account) {
  std::vector<CostLine> lines;
  double named = 0.0;
  const auto add = [&](std::string name, double seconds) {
    lines.push_back({std::move(name), seconds});
    named += seconds;
  };
  for (std::size_t pass = 0; pass < kPassCount; ++pass) {
    add(std::string(to_string(static_cast<Pass>(pass))), account.pass_seconds[pass]);
  }
  add("checkpoints", account.checkpoint_seconds);
  add("output", account.output_seconds);
  lines.push_back({"guards and the rest", std::max(0.0, account.seconds - named)});
  return lines;
}

double share(double seconds, const Account& account) {
  return account.seconds > 0.0 ? seconds / account.seconds : 0.0;
}

Json cost_json(const Account& account) {
  Json passes = Json::array();
  for (const CostLine& line : cost_lines(account)) {
    passes.push_back(
        {{"name", line.name}, {"seconds", line.seconds}, {"share", share(line.seconds, account)}});
  }
  return Json{{"seconds", account.seconds},
              {"core_seconds", account.core_seconds},
              {"steps", account.steps},
              {"particle_steps", account.particle_steps},
              {"particle_steps_per_second", account.rate()},
              {"checkpoints", account.checkpoints},
              {"engine_bytes", account.engine_bytes},
              {"passes", passes}};
}

Json extremes_json(const Outcome& outcome) {
  const GuardBaselines& seen = outcome.extremes;
  return Json{{"max_speed", seen.max_speed_seen},
              {"min_density_ratio", 1.0 + seen.min_density_excess_seen / outcome.reference_density},
              {"max_density_ratio", 1.0 + seen.max_density_excess_seen / outcome.reference_density},
              {"min_time_step", seen.min_time_step_seen},
              {"max_neighbours", seen.max_neighbours_seen},
              {"initial_energy", seen.initial_energy},
              {"highest_energy", seen.highest_energy},
              {"energy_scale", seen.energy_scale}};
}

Json departed_json(const Departed& departed) {
  return Json{{"mass", departed.mass},
              {"momentum", departed.momentum},
              {"kinetic_energy", departed.energy.kinetic},
              {"potential_energy", departed.energy.potential},
              {"internal_energy", departed.energy.internal}};
}

Json digests_json(const Outcome& outcome) {
  Json series = Json::object();
  for (const auto& [name, digest] : outcome.series_digests) series[name] = digest;
  Json object = Json::object();
  object["physics"] = outcome.physics_digest.empty() ? Json(nullptr) : Json(outcome.physics_digest);
  object["series"] = std::move(series);
  return object;
}

}  // namespace

double Account::rate() const {
  return seconds > 0.0 ? static_cast<double>(particle_steps) / seconds : 0.0;
}

std::string_view Outcome::state() const {
  if (exit_code == ExitCode::done) return "completed";
  return exit_code == ExitCode::checkpointed ? "stopped" : "failed";
}

Outcome describe_simulation(const Simulation& simulation) {
  const Solver& solver = simulation.solver();
  Outcome outcome;
  outcome.build = build_id();
  outcome.machine = machine_name();
  outcome.simd_target = solver.simd_target();
  outcome.threads = solver.threads();
  outcome.bit_exact = simulation.bit_exact();
  outcome.step = solver.step_count();
  outcome.time = solver.time();
  outcome.end_time = simulation.scene().end_time;
  outcome.particles = solver.particle_count();
  outcome.wall_particles = solver.wall_count();
  for (std::size_t i = 0; i < kRemovalCauses; ++i) {
    const auto cause = static_cast<RemovalCause>(i);
    Departed& kind = is_exclusion(cause)                 ? outcome.excluded
                     : cause == RemovalCause::overtopped ? outcome.overtopped
                                                         : outcome.leaked;
    kind.merge(simulation.departed(cause));
  }
  outcome.energy = solver.energy().total();
  outcome.extremes = simulation.baselines();
  outcome.reference_density = simulation.scene().method.reference_density;
  for (const Series& series : split(simulation.samples())) {
    outcome.series_digests.emplace_back(series.name, series_digest(series));
  }
  outcome.account.particle_steps = simulation.particle_steps();
  outcome.account.engine_bytes = solver.memory_bytes();
  outcome.account.pass_seconds = solver.pass_seconds();
  outcome.account.pass_seconds[static_cast<std::size_t>(Pass::sample)] =
      simulation.sample_seconds();
  return outcome;
}

Json to_json(const Outcome& outcome) {
  Json object{{"state", outcome.state()},
              {"exit_code", static_cast<int>(outcome.exit_code)},
              {"reason", outcome.reason},
              {"diagnosis", outcome.diagnosis ? to_json(*outcome.diagnosis) : Json(nullptr)},
              {"step", outcome.step},
              {"time", outcome.time},
              {"end_time", outcome.end_time},
              {"particles", outcome.particles},
              {"wall_particles", outcome.wall_particles}};
  object["removed"] = Json{{"overtopped", outcome.overtopped.count},
                           {"leaked", outcome.leaked.count},
                           {"excluded", outcome.excluded.count}};
  object["taken_along"] = Json{{"overtopped", departed_json(outcome.overtopped)},
                               {"leaked", departed_json(outcome.leaked)},
                               {"excluded", departed_json(outcome.excluded)}};
  object["energy"] = outcome.energy;
  object["extremes"] = extremes_json(outcome);
  object["digests"] = digests_json(outcome);
  object["bit_exact"] = outcome.bit_exact;
  object["build"] = outcome.build;
  object["machine"] = outcome.machine;
  object["simd_target"] = outcome.simd_target;
  object["threads"] = outcome.threads;
  object["this_attempt"] = cost_json(outcome.account);
  return object;
}

std::string summary_text(const Outcome& outcome) {
  const Account& account = outcome.account;
  std::string text = fmt::format(
      "{} at step {}, t = {:.6g} s of {:.6g} s\n"
      "  {:.2f} million fluid-particle steps per second ({} steps in {:.2f} s, {} thread{}{}{})\n",
      outcome.state(), outcome.step, outcome.time, outcome.end_time, account.rate() * 1e-6,
      account.steps, account.seconds, outcome.threads, outcome.threads == 1 ? "" : "s",
      outcome.simd_target.empty() ? "" : ", ", outcome.simd_target);
  for (const CostLine& line : cost_lines(account)) {
    text += fmt::format("  {:<20} {:>9.3f} s {:>6.1f} %\n", line.name, line.seconds,
                        100.0 * share(line.seconds, account));
  }
  text += fmt::format("  {} fluid and {} wall particles, {} overtopped, {} leaked, {} excluded\n",
                      outcome.particles, outcome.wall_particles, outcome.overtopped.count,
                      outcome.leaked.count, outcome.excluded.count);
  if (!outcome.physics_digest.empty()) {
    text += fmt::format("  physics SHA-256 {}{}\n", outcome.physics_digest,
                        outcome.bit_exact ? "" : " (resumed with another build or SIMD target)");
  }
  return text;
}

ExitCode exit_code_of(StorageFault fault) {
  switch (fault) {
    case StorageFault::locked:
      return ExitCode::folder_locked;
    case StorageFault::no_usable_checkpoint:
    case StorageFault::unsupported_version:
      return ExitCode::no_usable_checkpoint;
    case StorageFault::wrong_scene:
      return ExitCode::invalid_scene;
    case StorageFault::not_ours:
    case StorageFault::already_exists:
      return ExitCode::usage;
    case StorageFault::disk_full:
    case StorageFault::io:
    case StorageFault::unwritable:
    case StorageFault::corrupt:
    case StorageFault::invalid_content:
    case StorageFault::lost:
      return ExitCode::storage_failure;
  }
  return ExitCode::storage_failure;
}

}  // namespace sluice

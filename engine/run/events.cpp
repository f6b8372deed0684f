#include "engine/run/events.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "engine/run/build_id.hpp"
#include "engine/run/exit_code.hpp"
#include "engine/run/reporter.hpp"
#include "engine/space/axes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

Json started_fields(const Simulation& simulation, const JobFolder& folder) {
  const Solver& solver = simulation.solver();
  // A few may be gone before the first step: they have started as well.
  const std::size_t gone = solver.step_count() == 0 ? solver.removed_count() : 0;
  return Json{{"scene", simulation.scene().name},
              {"folder", folder.name().string()},
              {"step", solver.step_count()},
              {"time", solver.time()},
              {"end_time", simulation.scene().end_time},
              {"particles", solver.particle_count() + gone},
              {"wall_particles", solver.wall_count()},
              {"threads", solver.threads()},
              {"simd_target", solver.simd_target()},
              {"build", build_id()},
              {"bit_exact", simulation.bit_exact()}};
}

/// The number that an exclusion was for, and its limit.
struct Excess {
  std::string_view what;
  double value;
  double limit;
};

std::optional<Excess> excess_of(const RemovedParticle& removed, const Method& method) {
  const double ratio = 1.0 + removed.density_excess / method.reference_density;
  switch (removed.cause) {
    case RemovalCause::too_fast:
      return Excess{"speed (m/s)", removed.velocity.stableNorm(), method.sound_speed};
    case RemovalCause::too_dense:
      return Excess{"density ratio", ratio, 1.0 + Method::kDensityLeeway};
    case RemovalCause::too_thin:
      return Excess{"density ratio", ratio, 1.0 - Method::kDensityLeeway};
    case RemovalCause::overtopped:
    case RemovalCause::leaked:
    case RemovalCause::not_finite:
      return {};
  }
  return {};
}

std::string message_of(const RemovedParticle& removed, const std::optional<Excess>& excess) {
  const std::string why = excess
                              ? fmt::format("{}, {} {:.4g}, limit {:.4g}", to_string(removed.cause),
                                            excess->what, excess->value, excess->limit)
                              : std::string(to_string(removed.cause));
  return fmt::format("particle {:.0f} at step {}, t = {:.6g} s, ({:.6g}) m: {}", removed.id,
                     removed.step, removed.time, fmt::join(removed.position, ", "), why);
}

Json removal_fields(const RemovedParticle& removed, const Method& method) {
  const auto excess = excess_of(removed, method);
  Json fields{{"particle", removed.id},
              {"cause", to_string(removed.cause)},
              {"step", removed.step},
              {"time", removed.time}};
  for (Eigen::Index axis = 0; axis < removed.position.size(); ++axis) {
    fields[axis_name(axis)] = removed.position[axis];
  }
  fields["value"] = excess ? Json(excess->value) : Json(nullptr);
  fields["limit"] = excess ? Json(excess->limit) : Json(nullptr);
  fields["message"] = message_of(removed, excess);
  return fields;
}

EventKind removal_kind(const RemovedParticle& removed) {
  return is_exclusion(removed.cause) ? EventKind::excluded : EventKind::leaked;
}

}  // namespace

std::string_view to_string(EventKind kind) {
  constexpr std::array<std::string_view, 10> names{"started", "resumed",  "packed", "checkpoint",
                                                   "warning", "excluded", "leaked", "finished",
                                                   "stopped", "failed"};
  return names[static_cast<std::size_t>(kind)];
}

RunEvent started_event(const Simulation& simulation, const JobFolder& folder) {
  return {EventKind::started, started_fields(simulation, folder)};
}

RunEvent resumed_event(const Simulation& simulation, const JobFolder& folder,
                       const std::filesystem::path& checkpoint) {
  Json fields = started_fields(simulation, folder);
  fields["file"] = checkpoint.filename().string();
  return {EventKind::resumed, std::move(fields)};
}

RunEvent packed_event(const Simulation& simulation) {
  const PackingReport& packing = *simulation.packing();
  return {EventKind::packed, Json{{"particles", packing.particles},
                                  {"iterations", packing.iterations},
                                  {"residual", packing.residual},
                                  {"core_seconds", simulation.start_seconds()}}};
}

RunEvent checkpoint_event(const Simulation& simulation, const std::filesystem::path& checkpoint,
                          double seconds) {
  return {EventKind::checkpoint, Json{{"file", checkpoint.filename().string()},
                                      {"step", simulation.solver().step_count()},
                                      {"time", simulation.solver().time()},
                                      {"seconds", seconds}}};
}

RunEvent warning_event(const std::string& message) {
  return {EventKind::warning, Json{{"message", message}}};
}

RunEvent warning_event(const Diagnosis& warning) {
  Json fields = to_json(warning);
  fields["message"] = warning.text();
  return {EventKind::warning, std::move(fields)};
}

RunEvent not_written_event(std::string_view what, const StorageError& error, double wait) {
  return {EventKind::warning,
          Json{{"message", fmt::format("{} was not written, next try in {:.1f} s: {}", what, wait,
                                       error.what())},
               {"fault", to_string(error.fault())}}};
}

RunEvent removal_event(const RemovedParticle& removed, const Method& method) {
  return {removal_kind(removed), removal_fields(removed, method)};
}

RunEvent removals_event(const RemovedParticle& last, std::size_t count) {
  return {removal_kind(last),
          Json{{"step", last.step},
               {"time", last.time},
               {"count", count},
               {"message", fmt::format("{} particles up to step {}, t = {:.6g} s", count, last.step,
                                       last.time)}}};
}

RunEvent ended_event(const Outcome& outcome) {
  Json fields = to_json(outcome);
  if (!outcome.reason.empty()) fields["message"] = outcome.reason;
  switch (outcome.exit_code) {
    case ExitCode::done:
      return {EventKind::finished, std::move(fields)};
    case ExitCode::checkpointed:
      return {EventKind::stopped, std::move(fields)};
    default:
      return {EventKind::failed, std::move(fields)};
  }
}

RunEvent refused_event(const StorageError& error) {
  return {EventKind::failed, Json{{"exit_code", static_cast<int>(exit_code_of(error.fault()))},
                                  {"fault", to_string(error.fault())},
                                  {"message", error.what()}}};
}

}  // namespace sluice

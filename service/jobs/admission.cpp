#include "service/jobs/admission.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "engine/scene/filling/initial.hpp"
#include "engine/scene/forecast/stability.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/store/files/digest.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// Regions that overlap, and how many particles there are exactly, show only when they are filled.
/// Larger scenes are left to the worker, which does it in its own memory.
constexpr std::uint64_t kTrialParticles = 100'000;

[[noreturn]] void refuse_scene(const std::vector<Problem>& problems) {
  refuse(ProblemType::invalid_scene, "the whole scene", problems);
}

void fill(Admitted& admitted) {
  Estimate& size = admitted.estimate;
  if (size.fluid_particles + size.wall_particles > kTrialParticles) return;
  try {
    size = exact_estimate(admitted.scene);
  } catch (const SceneError& error) {
    refuse_scene({error.problem()});
  }
}

void check_limits(const Estimate& estimate, const ServiceLimits& limits) {
  const Json errors = broken_limits(estimate, limits);
  if (errors.empty()) return;
  const Json& first = errors.front();
  throw ApiError(ProblemType::over_limit,
                 fmt::format("the scene needs {} = {}, this service allows {}",
                             first["limit"].get<std::string>(), first["value"].dump(),
                             first["allowed"].dump()),
                 {{"errors", errors}});
}

Admitted admit(ParseResult result, const ServiceLimits& limits) {
  if (!result.scene) refuse_scene(result.problems);
  Admitted admitted{*std::move(result.scene), {}, {}, {}, std::move(result.warnings)};
  admitted.estimate = estimate(admitted.scene);
  check_limits(admitted.estimate, limits);
  fill(admitted);
  check_limits(admitted.estimate, limits);  // of the exact numbers
  return admitted;
}

}  // namespace

Admitted admit_scene(const std::string& text, const ServiceLimits& limits,
                     const SceneParts& parts) {
  Admitted admitted = admit(parse_scene(text, parts), limits);
  admitted.parts = parts_of(admitted.scene, parts);
  try {
    admitted.text = text_for_folder(text, parts);
  } catch (const SceneError& error) {
    refuse_scene({error.problem()});
  }
  return admitted;
}

Admitted admit_job_scene(const std::string& text, const ServiceLimits& limits,
                         const SceneParts& parts) {
  Admitted admitted =
      admit(parse_scene(text, StabilityCheck::refuse, SceneOrigin::job, parts), limits);
  admitted.text = text;
  return admitted;
}

void refuse(ProblemType type, std::string_view whole, const std::vector<Problem>& problems) {
  const Problem& first = problems.front();
  throw ApiError(
      type,
      fmt::format("{} problem{}; first, {}: {}", problems.size(), problems.size() == 1 ? "" : "s",
                  first.pointer.empty() ? whole : first.pointer, first.message),
      {{"errors", problem_list(problems)}});
}

Json problem_list(const std::vector<Problem>& problems) {
  Json list = Json::array();
  for (const Problem& problem : problems) {
    list.push_back({{"pointer", problem.pointer}, {"detail", problem.message}});
  }
  return list;
}

Json broken_limits(const Estimate& estimate, const ServiceLimits& limits) {
  Json errors = Json::array();
  const auto compare = [&](std::string_view name, std::uint64_t value, std::uint64_t limit) {
    if (value > limit) errors.push_back({{"limit", name}, {"value", value}, {"allowed", limit}});
  };
  compare("particles", estimate.fluid_particles + estimate.wall_particles,
          limits.particles_per_job);
  compare("memory_bytes", estimate.memory_bytes, memory_limit(limits));
  if (limits.disk_per_job > 0) {
    compare("disk_bytes", estimate.disk_bytes, limits.disk_per_job);
  }
  return errors;
}

Json estimate_document(const Scene& scene, const Estimate& estimate, int threads) {
  Json document = Json::parse(estimate_json(estimate));
  document["seconds"] = expected_core_seconds(scene, estimate) / std::max(threads, 1);
  document["stability"] = Json::parse(stability_json(predict_stability(scene)));
  return document;
}

void describe_scene(Job& job, const Scene& scene, const Estimate& estimate) {
  job.name = scene.name;
  job.end_time = scene.end_time;
  job.scene_hash = scene_hash(identity_text(scene));
  job.estimate = estimate_document(scene, estimate, job.threads).dump();
}

}  // namespace sluice

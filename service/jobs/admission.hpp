#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/scene_parts.hpp"
#include "service/http/problem.hpp"
#include "service/jobs/job.hpp"
#include "service/jobs/limits.hpp"

namespace sluice {

/// A scene that this service takes, with what it will cost.
struct Admitted {
  Scene scene;
  Estimate estimate;
  std::string text;              ///< as the job's folder keeps it
  std::vector<NamedPart> parts;  ///< the files that it names
  std::vector<Problem> warnings;
};

/// Parses a scene and holds it against the limits. Throws ApiError: invalid_scene with every
/// problem as {pointer, detail}, over_limit with every limit that it breaks. `parts` gives the
/// files that came with it.
[[nodiscard]] Admitted admit_scene(const std::string& text, const ServiceLimits& limits,
                                   const SceneParts& parts = no_parts);

/// The same for the scene of a job that was taken before and is to end later.
[[nodiscard]] Admitted admit_job_scene(const std::string& text, const ServiceLimits& limits,
                                       const SceneParts& parts);

/// As an array of {pointer, detail}.
[[nodiscard]] nlohmann::ordered_json problem_list(const std::vector<Problem>& problems);

/// Throws ApiError of this type with every problem as {pointer, detail}; there is at least one.
/// `whole` is what an empty pointer points to, such as "the whole scene".
[[noreturn]] void refuse(ProblemType type, std::string_view whole,
                         const std::vector<Problem>& problems);

/// Every limit that a scene breaks, as {limit, value, allowed}; an empty array when none.
[[nodiscard]] nlohmann::ordered_json broken_limits(const Estimate& estimate,
                                                   const ServiceLimits& limits);

/// particles, steps, memory, disk, about how long it takes on `threads` threads, and how far the
/// Courant number is from the largest stable one.
[[nodiscard]] nlohmann::ordered_json estimate_document(const Scene& scene, const Estimate& estimate,
                                                       int threads);

/// What a job has from its scene: name, end time, hash and estimate. Its threads must be set.
void describe_scene(Job& job, const Scene& scene, const Estimate& estimate);

}  // namespace sluice

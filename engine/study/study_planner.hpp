#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/study/study.hpp"

namespace sluice {

/// Whose scenes they are, and the files that these name.
struct SceneSource {
  SceneOrigin origin = SceneOrigin::user;
  const SceneParts& parts;
};

/// Makes the runs of a study whose own keys are in order: every case with every point of the grid,
/// and its members. `bases` holds the scene of each case, with the present names of its keys. What
/// is wrong with a run goes to `problems`.
void make_runs(StudyPlan& plan, std::vector<nlohmann::json> bases, const SceneSource& source,
               Problems& problems);

}  // namespace sluice

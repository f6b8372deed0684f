#pragma once

#include <string>
#include <vector>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// A part of a run, with why it is there or why it is left out.
struct PlanItem {
  std::string name;
  std::string description;
  std::string reason;  ///< "always", the key or the scheme that asks for it or leaves it out
};

/// What runs for a scene, and what its absent keys leave out.
struct Plan {
  std::vector<PlanItem> numerics;         ///< each number and word of the method, as
                                          ///< wall_shear.coefficient, and whose it is
  std::vector<PlanItem> passes;           ///< passes of a step and the terms in their sums
  std::vector<PlanItem> passes_left_out;  ///< not run
  std::vector<PlanItem> fields;           ///< arrays of one number per particle
  std::vector<PlanItem> fields_left_out;  ///< not allocated and not written
  std::vector<PlanItem> files;            ///< written into the job's folder
  std::vector<PlanItem> files_left_out;   ///< not written
};

[[nodiscard]] Plan plan(const Scene& scene);

/// The same as a JSON object: seven arrays of {name, description, reason}.
[[nodiscard]] std::string plan_json(const Plan& plan);

}  // namespace sluice

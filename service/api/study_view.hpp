#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine/study/study_result.hpp"
#include "service/api/api_context.hpp"

namespace sluice {

/// A study as it stands: its result from the reports of its jobs that are complete.
struct StudyView {
  StudyRecord record;
  StudyResult result;
  std::vector<std::optional<Job>> jobs;  ///< one per run; absent: deleted, or not made yet
};

/// A run whose job was deleted counts with what was kept of it.
[[nodiscard]] StudyView view_study(const ApiContext& context, const StudyRecord& record);

/// What GET /v1/studies lists: name, state (`open` while a job of it may still run, else `ended`)
/// and how many of its jobs are in which state.
[[nodiscard]] nlohmann::ordered_json study_summary(const ApiContext& context,
                                                   const StudyRecord& record);
/// What GET /v1/studies/{id} shows: the same, each run with its job, and the result.
[[nodiscard]] nlohmann::ordered_json study_document(const ApiContext& context,
                                                    const StudyView& view);

}  // namespace sluice

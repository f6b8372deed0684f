#pragma once

#include <functional>
#include <string>

#include "engine/run/outcome.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {

// What `sluice run` leaves and says once a run has ended.

/// The outcome.json of a run that reached the scene's end; empty when there is none.
[[nodiscard]] std::string completed_outcome(const JobFolder& folder, const Scene& scene);

/// The account of this run. One that had nothing left to do says so; where `earlier` is what
/// completed_outcome gave before, it keeps that outcome and tells its account.
[[nodiscard]] std::string closing_text(JobFolder& folder, const Outcome& outcome,
                                       const std::string& earlier);

/// Commands to paste: what to do next. Nothing for a folder that is no longer this job's.
[[nodiscard]] std::string next_commands(const JobFolder& folder, const Scene& scene,
                                        const Outcome& outcome);

/// Leaves the report beside the results of a complete run, for those who only read files. What goes
/// wrong here makes no run a failure: it is tried for `patience` seconds, or until somebody is
/// `hurried` (insist.hpp), and `sluice report` can make it again.
void leave_report(const JobFolder& folder, const Outcome& outcome, double patience,
                  const std::function<bool()>& hurried);

}  // namespace sluice

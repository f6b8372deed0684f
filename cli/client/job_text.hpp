#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/verbs.hpp"
#include "engine/run/progress.hpp"

namespace sluice {

// A job's JSON, as the service shows it, in words.

/// Where it stands; nothing before its first progress.
[[nodiscard]] std::optional<Progress> progress_of(const nlohmann::ordered_json& job);

/// "queued", "running, attempt 2", "running, asked to cancel", "failed: reason".
[[nodiscard]] std::string state_text(const nlohmann::ordered_json& job);

/// How a job at rest got there: "completed at step 1900, t = 1.4 s of 1.4 s"; with what to do when
/// it failed.
[[nodiscard]] std::string rest_text(const nlohmann::ordered_json& job);

/// What a run takes: two digits below ten seconds, then as duration_text.
[[nodiscard]] std::string cost_text(double seconds);

/// Particles, steps, memory, disk and time of an estimate: two lines, each indented.
[[nodiscard]] std::string estimate_text(const nlohmann::ordered_json& estimate);

/// All that a person wants to see of one job.
[[nodiscard]] std::string job_text(const nlohmann::ordered_json& job);

/// A table with one line per job of an array.
[[nodiscard]] std::string table_text(const nlohmann::ordered_json& jobs);

/// Whether nothing more happens to the job unless somebody asks for it.
[[nodiscard]] bool is_at_rest(const nlohmann::ordered_json& job);

/// How a verb that waited for a job at rest ends: returns for a completed one, else throws the
/// CommandEnd for a failed, cancelled or paused one.
void end_as(const nlohmann::ordered_json& job);

}  // namespace sluice

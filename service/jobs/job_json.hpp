#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "service/jobs/job.hpp"

namespace sluice {

/// A job as GET /v1/jobs lists it: scheduling, progress and why it waits (`waiting`, null when
/// empty). Times are RFC 3339 in UTC.
[[nodiscard]] nlohmann::ordered_json job_summary(const Job& job, const std::string& waiting);

/// A job as GET /v1/jobs/{id} shows it: the summary, the process that runs it (`pid`, null without
/// one), estimate, outcome and links.
[[nodiscard]] nlohmann::ordered_json job_document(const Job& job, const std::string& waiting,
                                                  std::optional<int> worker);

/// An event's number, job, time, name and detail.
[[nodiscard]] nlohmann::ordered_json event_json(const JobEvent& event);

/// Unix time in ms as "2025-01-31T12:00:00.000Z"; null for 0.
[[nodiscard]] nlohmann::ordered_json time_json(std::int64_t unix_ms);

/// JSON text that is kept in a row; null when it is empty or broken.
[[nodiscard]] nlohmann::ordered_json stored_json(const std::string& text);

}  // namespace sluice

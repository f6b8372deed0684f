#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace sluice {

/// Writes one line on stderr: a JSON object with the time and these fields. What came from outside
/// is escaped, so that a line stays a line. Thread-safe.
void log_line(const nlohmann::ordered_json& fields);

/// A line about what the scheduler could not do.
void log_scheduler(std::string_view message);

}  // namespace sluice

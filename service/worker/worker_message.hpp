#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sluice {

/// Longest line of a worker's output that is read; a longer one is cut.
inline constexpr std::size_t kLongestWorkerLine = std::size_t{64} << 10;

/// One line of a worker's output: {"event": name, ...}.
struct WorkerMessage {
  std::string event;                  ///< progress, started, resumed, checkpoint, warning, ...
  std::string detail;                 ///< JSON object: all but the event's name
  std::optional<std::uint64_t> step;  ///< where the line has one
  std::string text;                   ///< "message" or "reason", where the line has one
};

/// Nothing when the line is no JSON object with an event's name, or is beyond the bounds of
/// read_stored_json().
[[nodiscard]] std::optional<WorkerMessage> parse_worker_line(std::string_view line);

/// At most `bytes` of the text and only what a person can read: other bytes than printable ASCII
/// become '?'. For what a worker says that is no JSON.
[[nodiscard]] std::string printable(std::string_view text, std::size_t bytes);

}  // namespace sluice

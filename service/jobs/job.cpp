#include "service/jobs/job.hpp"

#include <array>
#include <cstddef>

namespace sluice {
namespace {

// In the order of the enumerations.
constexpr std::array<std::string_view, 6> kStates = {"queued",    "running", "paused",
                                                     "completed", "failed",  "cancelled"};
constexpr std::array<std::string_view, 8> kActions = {"claim", "complete", "fail",   "requeue",
                                                      "pause", "resume",   "cancel", "release"};
constexpr std::array<std::string_view, 3> kStops = {"none", "pause", "cancel"};

template <class Enumeration, std::size_t kCount>
std::optional<Enumeration> find(const std::array<std::string_view, kCount>& words,
                                std::string_view word) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (words[i] == word) return static_cast<Enumeration>(i);
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(JobState state) { return kStates.at(static_cast<std::size_t>(state)); }
std::string_view to_string(JobAction action) {
  return kActions.at(static_cast<std::size_t>(action));
}
std::string_view to_string(PendingStop stop) { return kStops.at(static_cast<std::size_t>(stop)); }

std::optional<JobState> job_state(std::string_view word) { return find<JobState>(kStates, word); }
std::optional<PendingStop> pending_stop(std::string_view word) {
  return find<PendingStop>(kStops, word);
}

bool is_ended(JobState state) {
  return state == JobState::completed || state == JobState::failed || state == JobState::cancelled;
}

}  // namespace sluice

#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "service/jobs/job_store.hpp"

namespace sluice {

/// Who asks for a transition.
enum class Actor {
  user,       ///< a request, or the service on its own account
  attempt,    ///< whoever holds the token of the running attempt
  scheduler,  ///< JobStore::claim alone
};

/// Where a job stands: its state, and for a running one what it was asked for and has yet to obey.
struct Standing {
  JobState state = JobState::queued;
  PendingStop pending = PendingStop::none;
  friend bool operator==(const Standing&, const Standing&) = default;
};

/// One allowed transition. What is not in the table is a conflict.
struct Transition {
  Standing from;
  Actor actor = Actor::user;
  JobAction action = JobAction::claim;
  Standing to;
  std::string_view event;        ///< of its row in the history; empty when nothing happens
  bool needs_later_end = false;  ///< only with a later end time than the job's
};

/// All of them; service/README.md shows them as a table.
[[nodiscard]] std::span<const Transition> transitions();
[[nodiscard]] std::optional<Transition> find_transition(const Standing& from, Actor actor,
                                                        JobAction action);

/// Finds the transition and checks what it needs. Throws JobStoreError: conflict, saying why, when
/// there is none, when `token` is not that of the running attempt, or when an end time is not later
/// than the job's. An empty `token` stands for a user.
[[nodiscard]] Transition require_transition(const Job& job, JobAction action,
                                            const std::string& token, const JobChange& change);

/// The job after the transition at the Unix time `now_ms`. A resume clears reason and crashes.
[[nodiscard]] Job after_transition(const Job& job, const Transition& transition,
                                   const JobChange& change, std::int64_t now_ms);

}  // namespace sluice

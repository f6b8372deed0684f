#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "engine/run/outcome.hpp"
#include "engine/run/simulation.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {

/// What a run tells: an attempt begins with started or resumed, and ends with one of the last
/// three.
enum class EventKind {
  started,     ///< from the scene
  resumed,     ///< from a checkpoint
  packed,      ///< the fluid was packed before the start
  checkpoint,  ///< one was published
  warning,
  excluded,  ///< a particle, or so many of them
  leaked,
  finished,  ///< the end time was reached
  stopped,   ///< as asked, with a checkpoint
  failed,
};
[[nodiscard]] std::string_view to_string(EventKind kind);

/// In JSON {"event": kind, ...fields}. What people read is in the field "message", where there is
/// one.
struct RunEvent {
  EventKind kind;
  nlohmann::ordered_json fields;  ///< an object

  [[nodiscard]] std::string message() const { return fields.value("message", ""); }
};

[[nodiscard]] RunEvent started_event(const Simulation& simulation, const JobFolder& folder);
[[nodiscard]] RunEvent resumed_event(const Simulation& simulation, const JobFolder& folder,
                                     const std::filesystem::path& checkpoint);
/// Of a simulation whose fluid was packed.
[[nodiscard]] RunEvent packed_event(const Simulation& simulation);
/// `seconds`: what writing it took.
[[nodiscard]] RunEvent checkpoint_event(const Simulation& simulation,
                                        const std::filesystem::path& checkpoint, double seconds);
[[nodiscard]] RunEvent warning_event(const std::string& message);
[[nodiscard]] RunEvent warning_event(const Diagnosis& warning);
/// `what` was not written and is tried again in `wait` seconds.
[[nodiscard]] RunEvent not_written_event(std::string_view what, const StorageError& error,
                                         double wait);
/// One particle that was excluded or has leaked, and the number and limit that it was for.
[[nodiscard]] RunEvent removal_event(const RemovedParticle& removed, const Method& method);
/// So many of them in all, up to `last`.
[[nodiscard]] RunEvent removals_event(const RemovedParticle& last, std::size_t count);
[[nodiscard]] RunEvent ended_event(const Outcome& outcome);
/// There is no attempt, because no checkpoint can be resumed from.
[[nodiscard]] RunEvent refused_event(const StorageError& error);

}  // namespace sluice

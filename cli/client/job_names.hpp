#pragma once

#include <string>

#include "cli/client/service_client.hpp"

namespace sluice {

// What may be written for a job or a study: its id, the beginning of it where no other one begins
// so, or `last` for the newest.

/// The id of the job. Asks the service only for what is no whole id. Throws CommandEnd: not_found,
/// or usage naming the first ones when several begin so.
[[nodiscard]] std::string job_named(ServiceClient& service, const std::string& word);
/// As above; goes on asking as `patience` says.
[[nodiscard]] std::string job_named(ServiceClient& service, const std::string& word,
                                    const Patience& patience);
/// The id of the study.
[[nodiscard]] std::string study_named(ServiceClient& service, const std::string& word);
/// The id of the job or, for a word that begins as a study's id does, of the study.
[[nodiscard]] std::string job_or_study_named(ServiceClient& service, const std::string& word);

}  // namespace sluice

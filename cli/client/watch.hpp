#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/client/service_client.hpp"

namespace sluice {

enum class WatchForm {
  automatic,  ///< a bar on a terminal, else lines
  bar,
  lines,
  json,  ///< the job's JSON as it came, a line for each change
};

struct WatchOptions {
  WatchForm form = WatchForm::automatic;
  double interval = 5.0;  ///< s between lines of progress, which a bar does not need
  double retry = 600.0;   ///< s to go on while no service answers
};

/// Adds --progress, --interval and --retry.
void add_watch_options(CLI::App& verb, WatchOptions& options);

/// Shows a job until nothing more happens to it, through restarts of the service. Returns when it
/// has completed; throws CommandEnd: numerical_failure when it failed, job_cancelled, checkpointed
/// when it is paused, unreachable, not_found. Ctrl-C ends the watching and not the job.
void watch_job(ServiceClient& service, const std::string& id, const WatchOptions& options);

}  // namespace sluice

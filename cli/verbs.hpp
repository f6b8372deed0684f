#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>

#include "engine/run/exit_code.hpp"

namespace sluice {

/// How verbs that speak to a service end, beside ExitCode: a job that failed is
/// numerical_failure, a paused one is checkpointed.
enum class ClientExit : int {
  not_found = 8,       ///< no such job, sensor or file
  wrong_state = 9,     ///< the job's state does not allow it
  unreachable = 10,    ///< no service answers there
  job_cancelled = 11,  ///< the job that was watched was cancelled
  refused = 12,        ///< the token is missing or wrong, or the host is not allowed
  service_failed = 13  ///< the service cannot do it now: stopping, queue full, disk full, a defect
};

/// Ends the program with a code. With a message, main prints it as one line on stderr.
class CommandEnd : public std::runtime_error {
 public:
  explicit CommandEnd(ExitCode code, const std::string& message = "")
      : std::runtime_error(message), code_(static_cast<int>(code)) {}
  explicit CommandEnd(ClientExit code, const std::string& message = "")
      : std::runtime_error(message), code_(static_cast<int>(code)) {}
  [[nodiscard]] int code() const { return code_; }

 private:
  int code_;
};

// Each adds its verb, with its options, its help and what it does. A new verb is one such function
// and one line in the table of main.cpp.
void add_run(CLI::App& app);
void add_validate(CLI::App& app);
void add_plan(CLI::App& app);
void add_inspect(CLI::App& app);
void add_sensors(CLI::App& app);
void add_export(CLI::App& app);
void add_report(CLI::App& app);
void add_study(CLI::App& app);
void add_serve(CLI::App& app);
void add_submit(CLI::App& app);
void add_list(CLI::App& app);
void add_show(CLI::App& app);
void add_watch(CLI::App& app);
void add_cancel(CLI::App& app);
void add_pause(CLI::App& app);
void add_resume(CLI::App& app);
void add_checkpoint(CLI::App& app);
void add_delete(CLI::App& app);
void add_stability(CLI::App& app);
void add_help(CLI::App& app);
void add_version(CLI::App& app);
void add_completion(CLI::App& app);
void add_man(CLI::App& app);

}  // namespace sluice

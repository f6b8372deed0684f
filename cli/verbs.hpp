#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>

#include "engine/run/exit_code.hpp"

namespace sluice {

/// Ends the program with a code. With a message, main prints it as one line on stderr.
class CommandEnd : public std::runtime_error {
 public:
  explicit CommandEnd(ExitCode code, const std::string& message = "")
      : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
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
void add_serve(CLI::App& app);

}  // namespace sluice

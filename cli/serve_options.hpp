#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "service/http/http_server.hpp"
#include "service/scheduler/scheduler.hpp"

namespace sluice {

/// Which requests `sluice serve` writes a line about.
enum class AccessLog {
  none,
  changes,  ///< changing requests and errors
  all,
};

enum class Rows { keep, rebuild };

struct ServeOptions {
  std::filesystem::path data;
  std::filesystem::path token_file;
  HttpOptions http;
  ServiceLimits limits;
  AccessLog log = AccessLog::changes;
  Rows rows = Rows::keep;
};

/// Adds all options of `sluice serve` to its verb.
void add_serve_options(CLI::App& verb, ServeOptions& options);

}  // namespace sluice

#pragma once

#include <string>
#include <vector>

namespace sluice {

/// The variable in a worker's environment that tells whose attempt it is.
inline constexpr const char* kTokenVariable = "SLUICE_ATTEMPT";

/// The environment of the worker of the attempt `token`, "NAME=value": that name, and of this
/// process's what a program needs to run. Nothing else, which may be secret.
[[nodiscard]] std::vector<std::string> worker_environment(const std::string& token);

}  // namespace sluice

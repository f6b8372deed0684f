#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// One thread per core that this process may use, but no more than one per two thousand fluid
/// particles: below that, waiting for one another costs more than it saves.
[[nodiscard]] int default_threads(const Scene& scene);

/// Adds --threads (0: default_threads) and --simd to a verb.
void add_execution_options(CLI::App& verb, int& threads, std::string& simd);

}  // namespace sluice

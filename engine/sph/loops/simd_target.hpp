#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sluice {

/// Names of the SIMD targets that were compiled and that this machine runs, best first: "AVX3",
/// "AVX2", "SSE4".
[[nodiscard]] std::vector<std::string> simd_targets();

/// What "" stands for from now on, in place of the best: for a whole program, before it has
/// threads. Throws std::invalid_argument, naming the possible ones, when this machine does not run
/// it.
void set_default_simd_target(const std::string& target);

/// Calls `body` with Highway's dispatch set to `target`, "" for the default. Throws
/// std::invalid_argument, naming the possible ones, when this machine does not run it. One call at
/// a time.
void with_simd_target(const std::string& target, const std::function<void()>& body);

}  // namespace sluice

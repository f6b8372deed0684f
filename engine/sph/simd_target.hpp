#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sluice {

/// Names of the SIMD targets that were compiled and that this machine runs, best first: "AVX3",
/// "AVX2", "SSE4".
[[nodiscard]] std::vector<std::string> simd_targets();

/// Calls `body` with Highway's dispatch set to `target`, "" for the best. Throws
/// std::invalid_argument, naming the possible ones, when this machine does not run it. One call at
/// a time.
void with_simd_target(const std::string& target, const std::function<void()>& body);

}  // namespace sluice

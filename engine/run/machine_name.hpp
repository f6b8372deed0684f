#pragma once

#include <string>

namespace sluice {

/// Processor and number of logical cores, such as "AMD EPYC 9R45, 2 cores". Reads no file, so that
/// a sandboxed run knows it too.
[[nodiscard]] const std::string& machine_name();

}  // namespace sluice

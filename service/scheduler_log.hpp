#pragma once

#include <string_view>

namespace sluice {

/// One line on stderr about what the scheduler could not do.
void log_scheduler(std::string_view message);

}  // namespace sluice

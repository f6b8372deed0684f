#include "service/scheduler_log.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace sluice {

void log_scheduler(std::string_view message) {
  std::fputs(fmt::format("sluice: {}\n", message).c_str(), stderr);
}

}  // namespace sluice

#include "service/jobs/service_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>

namespace sluice {

using Json = nlohmann::ordered_json;

void log_line(const Json& fields) {
  using namespace std::chrono;
  const auto now = time_point_cast<milliseconds>(system_clock::now());
  const auto whole = floor<seconds>(now);
  Json line{{"at", fmt::format("{:%FT%T}.{:03}Z", whole, (now - whole).count())}};
  line.update(fields);
  const std::string text = line.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
  std::fputs(text.c_str(), stderr);
}

void log_scheduler(std::string_view message) {
  log_line({{"event", "scheduler"}, {"message", message}});
}

}  // namespace sluice

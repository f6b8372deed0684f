#include "service/jobs/retention_clock.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/publish.hpp"

namespace sluice {
namespace {

constexpr double kDay = 86400.0;  // s
constexpr double kLeast = 1.0;    // s

std::filesystem::path retention_file(const std::filesystem::path& data) {
  return data / "retention.json";
}

}  // namespace

RetentionClock::RetentionClock(double kept, std::int64_t known_ms)
    : leap_(std::clamp(0.1 * kept, kLeast, kDay)),
      grace_(std::clamp(kept, kLeast, kDay)),
      now_ms_(known_ms) {}

std::int64_t RetentionClock::look(std::int64_t wall_ms, double steady) {
  const double elapsed = looked_ ? steady - last_look_ : 0.0;
  if (!looked_ && now_ms_ == 0) now_ms_ = wall_ms;
  looked_ = true;
  last_look_ = steady;
  new_leap_.reset();
  now_ms_ += static_cast<std::int64_t>(std::llround(1000.0 * elapsed));
  const double ahead = 1e-3 * static_cast<double>(wall_ms - now_ms_);
  if (ahead <= leap_) {
    // Also when it was set back: an earlier time deletes less.
    now_ms_ = wall_ms;
    leapt_at_.reset();
  } else if (!leapt_at_) {
    leapt_at_ = steady;
    new_leap_ = ahead;
  } else if (steady - *leapt_at_ >= grace_) {
    now_ms_ = wall_ms;
    leapt_at_.reset();
  }
  return now_ms_;
}

std::int64_t read_retention_time(const std::filesystem::path& data) {
  try {
    constexpr std::uint64_t kLargest = 1024;
    return read_stored_json(read_text(retention_file(data), kLargest))
        .at("time_ms")
        .get<std::int64_t>();
  } catch (const std::exception&) {
    return 0;  // the newest event will do
  }
}

void write_retention_time(const std::filesystem::path& data, std::int64_t now_ms) {
  publish_text(retention_file(data), nlohmann::json{{"time_ms", now_ms}}.dump() + "\n");
}

}  // namespace sluice

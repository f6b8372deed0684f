#include "service/jobs/job_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "engine/scene/format/json_text.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/publish.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 20;
constexpr int kMostThreads = 4096;

json to_json(const JobFile& file) {
  return {{"label", file.label},
          {"priority", file.priority},
          {"threads", file.threads},
          {"created_ms", file.created_ms},
          {"key", file.key},
          {"body_hash", file.body_hash},
          {"held", file.held ? json(to_string(*file.held)) : json(nullptr)}};
}

std::optional<JobState> read_held(const json& value) {
  if (value.is_null()) return std::nullopt;
  const auto state = job_state(value.get<std::string>());
  if (state != JobState::paused && state != JobState::cancelled && state != JobState::failed) {
    throw std::invalid_argument("held is neither paused nor cancelled nor failed");
  }
  return state;
}

int read_int(const json& value, int low, int high) {
  // As double first, so that no number is cut when it is cast.
  const double number = value.get<double>();
  if (!value.is_number_integer() || number < low || number > high) {
    throw std::invalid_argument(fmt::format("a number is outside {} to {}", low, high));
  }
  return static_cast<int>(number);
}

std::int64_t read_time(const json& value) {
  constexpr double kLatest = 1e15;
  const double number = value.get<double>();
  if (!value.is_number_integer() || number < 0.0 || number > kLatest) {
    throw std::invalid_argument("created_ms is no time");
  }
  return value.get<std::int64_t>();
}

JobFile from_json(const json& object) {
  JobFile file;
  file.label = object.at("label").get<std::string>();
  file.priority = read_int(object.at("priority"), -1'000'000'000, 1'000'000'000);
  file.threads = read_int(object.at("threads"), 1, kMostThreads);
  file.created_ms = read_time(object.at("created_ms"));
  file.key = object.at("key").get<std::string>();
  file.body_hash = object.at("body_hash").get<std::string>();
  file.held = read_held(object.at("held"));
  return file;
}

}  // namespace

std::optional<JobState> held_in(JobState state) {
  const bool is_held =
      state == JobState::paused || state == JobState::cancelled || state == JobState::failed;
  return is_held ? std::optional(state) : std::nullopt;
}

fs::path job_file_path(const fs::path& folder) { return folder / "job.json"; }

std::string job_file_text(const JobFile& file) {
  // Text of users that is no UTF-8 must not keep a job from being written down.
  return to_json(file).dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

void write_job_file(const fs::path& folder, const JobFile& file) {
  publish_text(job_file_path(folder), job_file_text(file));
}

JobFile read_job_file(const fs::path& folder) {
  const fs::path path = job_file_path(folder);
  const std::string text = read_text(path, kLargestFile, Links::refuse);
  try {
    return from_json(read_stored_json(text));
  } catch (const std::exception& error) {
    throw StorageError(StorageFault::corrupt, fmt::format("{}: {}", path.string(), error.what()));
  }
}

void note_held(const fs::path& folder, std::optional<JobState> held) {
  if (!is_present(job_file_path(folder))) return;
  JobFile file = read_job_file(folder);
  if (file.held == held) return;
  file.held = held;
  write_job_file(folder, file);
}

}  // namespace sluice

#include "engine/run/reporter.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "engine/run/events.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// Names from outside may hold bytes that are no UTF-8: they must not end a run.
std::string line_of(const Json& object) {
  return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json named(std::string_view name, const Json& fields) {
  Json object{{"event", name}};
  object.update(fields);
  return object;
}

void put(std::FILE* out, const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), out);
  std::fflush(out);
}

Json optional_number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::string describe_start(const RunEvent& event) {
  const Json& fields = event.fields;
  return fmt::format(
      "{} {} in {} at step {}, t = {:.6g} s: {} fluid and {} wall particles, {} threads, {}",
      to_string(event.kind), fields.value("scene", ""), fields.value("folder", ""),
      fields.value("step", std::uint64_t{0}), fields.value("time", 0.0),
      fields.value("particles", std::uint64_t{0}), fields.value("wall_particles", std::uint64_t{0}),
      fields.value("threads", 1), fields.value("simd_target", ""));
}

/// What a person is told; nothing where the bar or the closing account says it.
std::string describe(const RunEvent& event) {
  switch (event.kind) {
    case EventKind::started:
    case EventKind::resumed:
      return describe_start(event);
    case EventKind::warning:
    case EventKind::excluded:
    case EventKind::leaked:
      return fmt::format("{}: {}", to_string(event.kind), event.message());
    case EventKind::packed:
    case EventKind::checkpoint:
    case EventKind::finished:
    case EventKind::stopped:
    case EventKind::failed:
      return {};
  }
  return {};
}

}  // namespace

Json to_json(const Progress& progress) {
  Json object{{"step", progress.step},
              {"time", progress.time},
              {"end_time", progress.end_time},
              {"fraction", progress.fraction()},
              {"particles", progress.particles},
              {"overtopped", progress.overtopped},
              {"leaked", progress.leaked},
              {"excluded", progress.excluded},
              {"time_step", progress.time_step},
              {"step_limit", to_string(progress.step_limit)},
              {"max_speed", progress.max_speed},
              {"elapsed", progress.elapsed},
              {"eta", optional_number(progress.remaining())},
              {"checkpoint_age", optional_number(progress.checkpoint_age)}};
  object["model_seconds_per_second"] =
      progress.rate ? Json(progress.rate->model_time) : Json(nullptr);
  object["steps_per_second"] = progress.rate ? Json(progress.rate->steps) : Json(nullptr);
  object["particle_steps_per_second"] =
      progress.rate ? Json(progress.rate->particle_steps) : Json(nullptr);
  return object;
}

Json to_json(const Diagnosis& diagnosis) {
  return Json{{"reason", diagnosis.reason}, {"step", diagnosis.step},
              {"time", diagnosis.time},     {"value", diagnosis.value},
              {"limit", diagnosis.limit},   {"suggestion", diagnosis.suggestion}};
}

void JsonReporter::progress(const Progress& progress) {
  put(out_, line_of(named("progress", to_json(progress))));
}

void JsonReporter::event(const RunEvent& event) {
  put(out_, line_of(named(to_string(event.kind), event.fields)));
}

std::size_t StatusLine::width() const {
  winsize size{};
  const bool known = ioctl(fileno(out_), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  // The last column stays free: some terminals wrap when it is written.
  return known ? size.ws_col - 1U : 99U;
}

void StatusLine::draw(std::string text) {
  text.resize(std::min(text.size(), width()));
  const std::size_t length = text.size();
  if (length < drawn_) text.append(drawn_ - length, ' ');
  drawn_ = length;
  put(out_, fmt::format("\r{}", text));
}

void StatusLine::clear() {
  if (drawn_ > 0) put(out_, fmt::format("\r{:{}}\r", "", drawn_));
  drawn_ = 0;
}

void BarReporter::progress(const Progress& progress) {
  bar_.draw(progress_bar(progress, bar_.width()));
}

void BarReporter::event(const RunEvent& event) {
  if (event.kind == EventKind::checkpoint) return;
  bar_.clear();
  const std::string line = describe(event);
  if (!line.empty()) put(out_, line + "\n");
}

LoggingReporter::LoggingReporter(Reporter& next, std::filesystem::path log)
    : next_(&next), log_(std::move(log)) {}

void LoggingReporter::event(const RunEvent& event) {
  next_->event(event);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  Json line{{"at", fmt::format("{:%FT%TZ}", now)}};
  line.update(named(to_string(event.kind), event.fields));
  const FileDescriptor file(uninterrupted([&] {
    return ::open(log_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644);
  }));
  if (file.get() < 0) return;
  const std::string text = line_of(line);
  try {
    // One write as a rule, so that a line is whole or cut short at the end of the file.
    write_whole(FileSystem::real(), file.get(), std::as_bytes(std::span(text)), log_);
  } catch (const StorageError&) {
    // A run goes on without its log.
  }
}

}  // namespace sluice

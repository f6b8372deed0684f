#include "cli/client/job_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/colour.hpp"
#include "cli/json_text.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// "2025-01-31T12:00:00.000Z" as "2025-01-31 12:00:00"; "-" without one.
std::string time_text(const Json& job, std::string_view key) {
  std::string text = text_at(job, key);
  if (text.empty()) return "-";
  text.resize(std::min<std::size_t>(text.size(), 19));
  std::ranges::replace(text, 'T', ' ');
  return text;
}

std::string percent_text(const Json& job) {
  // Its last progress is of up to a second before the end.
  if (text_at(job, "state") == "completed") return "100.0 %";
  const auto progress = progress_of(job);
  return progress ? fmt::format("{:.1f} %", 100.0 * progress->fraction()) : "-";
}

/// Why it is where it is, whatever that is, in a table: without what to do about it.
std::string why_text(const Json& job) {
  const std::string reason = text_at(job, "reason");
  const std::string why = reason.empty() ? text_at(job, "waiting") : reason;
  return why.substr(0, why.find("; "));
}

double number_or(const Json& object, std::string_view key, double otherwise) {
  return number_at(object, key).value_or(otherwise);
}

/// A count that may come from anywhere, as a double that fits.
std::uint64_t whole(double number) {
  return static_cast<std::uint64_t>(std::clamp(number, 0.0, 1e15));
}

std::string outcome_text(const Json& outcome) {
  return fmt::format("{} at step {}, t = {:.6g} s of {:.6g} s", text_at(outcome, "state"),
                     count_at(outcome, "step"), number_or(outcome, "time", 0.0),
                     number_or(outcome, "end_time", 0.0));
}

template <class Line>
void add_progress(const Json& job, const Line& line) {
  if (const auto progress = progress_of(job)) line("progress", progress_text(*progress));
  if (const auto age = number_at(member(job, "progress"), "checkpoint_age")) {
    line("checkpoint", fmt::format("{} old at that time", duration_text(age)));
  }
}

}  // namespace

std::optional<Progress> progress_of(const Json& job) {
  const Json& from = member(job, "progress");
  if (!from.is_object()) return {};
  Progress progress;
  progress.step = whole(number_or(from, "step", 0.0));
  progress.time = number_or(from, "time", 0.0);
  progress.end_time = number_or(from, "end_time", number_or(job, "end_time", 0.0));
  progress.time_step = number_or(from, "time_step", 0.0);
  if (text_at(from, "step_limit") == to_string(StepLimit::force)) {
    progress.step_limit = StepLimit::force;
  }
  progress.particles = whole(number_or(from, "particles", 0.0));
  if (const auto speed = number_at(from, "model_seconds_per_second")) {
    progress.rate = Rate{*speed, number_or(from, "steps_per_second", 0.0),
                         number_or(from, "particle_steps_per_second", 0.0)};
  }
  return progress;
}

std::string state_text(const Json& job) {
  const std::string state = text_at(job, "state");
  std::string text = in_colour_of(state, state);
  const std::string stop = text_at(job, "stop_requested");
  const double attempts = number_or(job, "attempts", 0.0);
  if (state == "running" && attempts > 1.0) {
    text += fmt::format(", attempt {}", count_at(job, "attempts"));
  }
  if (!stop.empty()) text += fmt::format(", asked to {}", stop);
  const std::string reason = text_at(job, "reason");
  return reason.empty() ? text : fmt::format("{}: {}", text, reason);
}

std::string rest_text(const Json& job) {
  const Json& outcome = member(job, "outcome");
  const std::string state = text_at(job, "state");
  if (state == "completed" && outcome.is_object()) return outcome_text(outcome);
  const std::string advice = text_at(member(outcome, "diagnosis"), "suggestion");
  const std::string text = state_text(job);
  const bool told = advice.empty() || text.find(advice) != std::string::npos;
  return state != "failed" || told ? text : fmt::format("{}; {}", text, advice);
}

std::string cost_text(double seconds) {
  constexpr double kFew = 10.0;
  return seconds < kFew ? fmt::format("{:.2g} s", seconds) : duration_text(seconds);
}

std::string estimate_text(const Json& estimate) {
  if (!estimate.is_object()) return {};
  return fmt::format(
      "  {} fluid and {} wall particles, about {} steps: {} on an otherwise idle machine\n"
      "  {} of memory, {} on disk, {} samples, {} frames\n",
      count_at(estimate, "fluid_particles"), count_at(estimate, "wall_particles"),
      count_at(estimate, "steps"), cost_text(number_or(estimate, "seconds", 0.0)),
      size_text(number_at(estimate, "memory_bytes")), size_text(number_at(estimate, "disk_bytes")),
      count_at(estimate, "samples"), count_at(estimate, "frames"));
}

std::string job_text(const Json& job) {
  std::string text = fmt::format("{} {}\n", text_at(job, "id"), state_text(job));
  const auto line = [&text](std::string_view name, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {:<10} {}\n", name, value);
  };
  line("name", text_at(job, "name"));
  line("label", text_at(job, "label"));
  line("waiting", text_at(job, "waiting"));
  if (!is_at_rest(job)) add_progress(job, line);
  if (member(job, "pid").is_number()) line("process", count_at(job, "pid"));
  line("end time", fmt::format("{:.6g} s of model time", number_or(job, "end_time", 0.0)));
  line("scheduling", fmt::format("priority {}, threads {}, attempts {}, lost since progress {}",
                                 count_at(job, "priority"), count_at(job, "threads"),
                                 count_at(job, "attempts"), count_at(job, "crashes")));
  line("created", time_text(job, "created_at"));
  line("started", time_text(job, "started_at"));
  line("ended", time_text(job, "ended_at"));
  const Json& outcome = member(job, "outcome");
  if (outcome.is_object()) line("outcome", outcome_text(outcome));
  const std::string needs = estimate_text(member(job, "estimate"));
  return needs.empty() ? text : text + "  estimate\n" + needs;
}

std::string table_text(const Json& jobs) {
  std::string text = fmt::format("{:<21} {:<9} {:>8} {:<19} {}\n", "ID", "STATE", "PROGRESS",
                                 "CREATED (UTC)", "NAME");
  for (const Json& job : jobs) {
    const std::string label = text_at(job, "label");
    const std::string why = why_text(job);
    const std::string state = text_at(job, "state");
    text += fmt::format("{:<21} {} {:>8} {:<19} {}{}{}\n", text_at(job, "id"),
                        in_colour_of(state, fmt::format("{:<9}", state)), percent_text(job),
                        time_text(job, "created_at"), text_at(job, "name"),
                        label.empty() ? "" : fmt::format(" [{}]", label),
                        why.empty() ? "" : fmt::format(": {}", why));
  }
  return text;
}

bool is_at_rest(const Json& job) {
  const std::string state = text_at(job, "state");
  return state != "queued" && state != "running";
}

void end_as(const Json& job) {
  const std::string state = text_at(job, "state");
  if (state == "completed") return;
  if (state == "cancelled") throw CommandEnd(ClientExit::job_cancelled);
  if (state == "paused") throw CommandEnd(ExitCode::checkpointed);
  throw CommandEnd(ExitCode::numerical_failure);
}

}  // namespace sluice

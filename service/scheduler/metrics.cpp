#include "service/scheduler/metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "service/jobs/job_json.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

/// A request's method as a label: one of few, whatever was sent.
std::string method_label(std::string_view method) {
  static constexpr std::array kMethods{"GET", "HEAD", "POST", "DELETE", "OPTIONS"};
  return std::ranges::find(kMethods, method) != kMethods.end() ? std::string(method) : "other";
}

void add_head(std::string& out, std::string_view name, std::string_view type,
              std::string_view help) {
  out += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
}

struct RunningGauge {
  const char* name;
  const char* key;  ///< in a progress line
  const char* help;
};

constexpr std::array kRunningGauges{
    RunningGauge{"sluice_job_step", "step", "Step that a running job has reached."},
    RunningGauge{"sluice_job_model_time_seconds", "time", "Model time of a running job."},
    RunningGauge{"sluice_job_steps_per_second", "steps_per_second", "Speed of a running job."},
    RunningGauge{"sluice_job_particle_steps_per_second", "particle_steps_per_second",
                 "Fluid-particle steps per second of a running job."},
    RunningGauge{"sluice_job_checkpoint_age_seconds", "checkpoint_age",
                 "Age of a running job's last checkpoint at its last progress line."},
};

void add_running_jobs(std::string& out, const JobStore& store) {
  JobFilter filter;
  filter.state = JobState::running;
  filter.limit = 1000;
  std::vector<std::pair<std::string, Json>> jobs;
  for (const Job& job : store.list(filter)) {
    Json progress = stored_json(job.progress);
    if (progress.is_object()) jobs.emplace_back(job.id, std::move(progress));
  }
  for (const RunningGauge& gauge : kRunningGauges) {
    add_head(out, gauge.name, "gauge", gauge.help);
    for (const auto& [id, progress] : jobs) {
      const auto value = progress.find(gauge.key);
      if (value == progress.end() || !value->is_number()) continue;
      out += fmt::format("{}{{job=\"{}\"}} {}\n", gauge.name, id, value->get<double>());
    }
  }
}

}  // namespace

void Metrics::count(std::string_view method, int status, double seconds) {
  const std::scoped_lock lock(mutex_);
  ++requests_[{method_label(method), status}];
  const auto bucket = std::ranges::lower_bound(kBounds, seconds) - kBounds.begin();
  ++latencies_[static_cast<std::size_t>(bucket)];
  latency_sum_ += seconds;
}

void Metrics::count_events(const JobStore& store) {
  for (;;) {
    const auto events = store.events("", last_event_, 1000);
    for (const JobEvent& event : events) ++events_[event.name];
    if (events.empty()) return;
    last_event_ = events.back().number;
  }
}

std::string Metrics::text(const JobStore& store) {
  std::string out;
  add_head(out, "sluice_jobs", "gauge", "Jobs by state.");
  for (const auto& [state, count] : store.count_by_state()) {
    out += fmt::format("sluice_jobs{{state=\"{}\"}} {}\n", to_string(state), count);
  }
  add_running_jobs(out, store);

  const std::scoped_lock lock(mutex_);
  count_events(store);
  add_head(out, "sluice_job_events_total", "counter",
           "Events of all jobs since the start, checkpoints among them.");
  for (const auto& [name, count] : events_) {
    out += fmt::format("sluice_job_events_total{{event=\"{}\"}} {}\n", name, count);
  }
  add_head(out, "sluice_http_requests_total", "counter", "Requests by method and status.");
  for (const auto& [label, count] : requests_) {
    out += fmt::format("sluice_http_requests_total{{method=\"{}\",status=\"{}\"}} {}\n",
                       label.first, label.second, count);
  }
  add_head(out, "sluice_http_request_seconds", "histogram",
           "From a request's last byte to its answer's; event streams are left out.");
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < kBounds.size(); ++n) {
    sum += latencies_[n];
    out += fmt::format("sluice_http_request_seconds_bucket{{le=\"{}\"}} {}\n", kBounds[n], sum);
  }
  sum += latencies_.back();
  out += fmt::format(
      "sluice_http_request_seconds_bucket{{le=\"+Inf\"}} {0}\n"
      "sluice_http_request_seconds_sum {1}\nsluice_http_request_seconds_count {0}\n",
      sum, latency_sum_);
  return out;
}

}  // namespace sluice

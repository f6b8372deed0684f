#include "tests/service/jobs/store_support.hpp"

#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <tuple>

namespace sluice::test {

namespace fs = std::filesystem;

DataFolder::DataFolder() {
  std::string name = (fs::temp_directory_path() / "sluice-data-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot make a temporary folder");
  }
  path_ = name;
}

DataFolder::~DataFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Job a_job(int priority, int threads) {
  Job job;
  job.name = "dam";
  job.label = "käse 'quoted' \"twice\"";
  job.priority = priority;
  job.threads = threads;
  job.created_ms = 1'700'000'000'123;
  job.scene_hash = "00112233445566778899aabbccddeeff";
  job.end_time = 0.1;
  job.estimate = R"({"steps":3})";
  return job;
}

Job add_job(JobStore& store, int priority, int threads) {
  return store.submit(a_job(priority, threads), "", "", 1'000'000).job;
}

Job add_job_in(JobStore& store, JobState state, PendingStop pending) {
  const std::string id = add_job(store).id;
  if (state == JobState::queued) return store.find(id).value();
  if (state == JobState::paused) return store.apply(id, JobAction::pause, "", {});
  if (state == JobState::cancelled) return store.apply(id, JobAction::cancel, "", {});
  const Job running = store.claim(1, {}).value();
  if (running.id != id) throw std::logic_error("another job was queued");
  if (pending == PendingStop::pause) return store.apply(id, JobAction::pause, "", {});
  if (pending == PendingStop::cancel) return store.apply(id, JobAction::cancel, "", {});
  if (state == JobState::completed) {
    return store.apply(id, JobAction::complete, running.token, {});
  }
  if (state == JobState::failed) return store.apply(id, JobAction::fail, running.token, {});
  return running;
}

bool same(const Job& a, const Job& b) {
  const auto members = [](const Job& job) {
    return std::tie(job.id, job.state, job.pending_stop, job.name, job.label, job.priority,
                    job.threads, job.created_ms, job.updated_ms, job.started_ms, job.ended_ms,
                    job.token, job.attempts, job.crashes, job.reason, job.scene_hash, job.end_time,
                    job.estimate, job.progress, job.outcome);
  };
  return members(a) == members(b);
}

std::string history(const JobStore& store, const std::string& id) {
  std::string names;
  for (const JobEvent& event : store.events(id, 0, 1000)) {
    names += (names.empty() ? "" : " ") + event.name;
  }
  return names;
}

}  // namespace sluice::test

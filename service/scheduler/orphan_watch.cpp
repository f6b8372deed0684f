#include "service/scheduler/orphan_watch.hpp"

#include <fmt/format.h>

#include <exception>
#include <iterator>
#include <utility>

#include "engine/store/files/job_folder.hpp"
#include "service/jobs/service_log.hpp"
#include "service/worker/orphan.hpp"

namespace sluice {
namespace {

JobPaths paths(const std::filesystem::path& data, const Job& job) {
  return JobPaths(data / "jobs" / job.id);
}

}  // namespace

void OrphanWatch::look(double now, const std::function<void(const Job&)>& conclude) {
  for (auto orphan = orphans_.begin(); orphan != orphans_.end();) {
    const bool in_use = is_in_use(paths(data_, orphan->job));
    if (in_use) kill_when_late(*orphan, now);
    orphan = !in_use && concluded(*orphan, conclude) ? orphans_.erase(orphan) : std::next(orphan);
  }
}

/// One job's trouble must not hold up the others, nor what follows in the scheduler's round.
bool OrphanWatch::concluded(Orphan& orphan, const std::function<void(const Job&)>& conclude) const {
  try {
    conclude(orphan.job);
    return true;
  } catch (const std::exception& error) {
    if (!std::exchange(orphan.complained, true)) {
      log_scheduler(fmt::format("job {}: what its last worker left cannot be judged yet: {}",
                                orphan.job.id, error.what()));
    }
    return false;
  }
}

void OrphanWatch::kill_when_late(Orphan& orphan, double now) const {
  if (now - orphan.since <= stop_seconds_ || std::exchange(orphan.killed, true)) return;
  const bool ours = kill_orphan(paths(data_, orphan.job), orphan.job.token);
  log_scheduler(fmt::format("job {}: {}", orphan.job.id,
                            ours ? "a worker of the last service did not stop and was killed"
                                 : "another process uses its folder; it resumes when that ends"));
}

int OrphanWatch::threads() const {
  int sum = 0;
  for (const Orphan& orphan : orphans_) sum += orphan.job.threads;
  return sum;
}

}  // namespace sluice

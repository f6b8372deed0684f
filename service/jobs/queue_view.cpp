#include "service/jobs/queue_view.hpp"

#include <algorithm>

namespace sluice {
namespace {

constexpr double kOldest = 1.0;  // s
constexpr std::size_t kQueuePage = 1000;

bool before(const QueueView::Entry& a, const QueueView::Entry& b) {
  if (a.priority != b.priority) return a.priority > b.priority;
  return a.id < b.id;
}

}  // namespace

std::size_t QueueView::ahead_of(const Job& job, double now) const {
  const std::lock_guard lock(mutex_);
  refresh(now);
  const Entry own{job.priority, job.threads, job.id};
  return static_cast<std::size_t>(std::lower_bound(entries_.begin(), entries_.end(), own, before) -
                                  entries_.begin());
}

std::optional<QueueView::Entry> QueueView::first(int threads,
                                                 const std::vector<std::string>& except,
                                                 double now) const {
  const std::lock_guard lock(mutex_);
  refresh(now);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.threads <= threads &&
           std::find(except.begin(), except.end(), entry.id) == except.end();
  });
  if (found == entries_.end()) return {};
  return *found;
}

void QueueView::refresh(double now) const {
  if (read_at_ && now - *read_at_ < kOldest) return;
  entries_.clear();
  JobFilter filter;
  filter.state = JobState::queued;
  filter.limit = kQueuePage;
  for (;;) {
    const std::vector<Job> page = store_.list(filter);
    for (const Job& job : page) entries_.push_back({job.priority, job.threads, job.id});
    if (page.size() < kQueuePage) break;
    filter.after = page.back().id;
  }
  std::sort(entries_.begin(), entries_.end(), before);
  read_at_ = now;
}

}  // namespace sluice

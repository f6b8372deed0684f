#include "service/jobs/live_progress.hpp"

#include <algorithm>

namespace sluice {

bool LiveProgress::note(const std::string& id, const std::string& progress, std::int64_t now_ms) {
  const auto [place, added] = entries_.try_emplace(id);
  Entry& entry = place->second;
  entry.progress = progress;
  entry.noted_ms = now_ms;
  if (added) entry.written_ms = now_ms;
  // A clock that was set back must not keep rows from their progress.
  return now_ms - entry.written_ms >= kToDiskMs || now_ms < entry.written_ms;
}

void LiveProgress::note_written(const std::string& id, std::int64_t now_ms) {
  const auto place = entries_.find(id);
  if (place != entries_.end()) place->second.written_ms = now_ms;
}

void LiveProgress::show_in(Job& job) const {
  const auto place = entries_.find(job.id);
  if (place == entries_.end()) return;
  job.progress = place->second.progress;
  job.updated_ms = std::max(job.updated_ms, place->second.noted_ms);
}

}  // namespace sluice

#include "service/scheduler/back_offs.hpp"

namespace sluice {

void BackOffs::note(const std::string& id, NextTry next, int crashes, double now) {
  if (next == NextTry::at_once) {
    waits_.erase(id);
    return;
  }
  Wait& wait = waits_[id];
  const bool repeated = wait.why == next;
  wait.count = next == NextTry::after_crash ? crashes : (repeated ? wait.count + 1 : 1);
  wait.why = next;
  wait.until = now + back_off(wait.count);
}

std::vector<std::string> BackOffs::waiting(double now) const {
  std::vector<std::string> ids;
  for (const auto& [id, wait] : waits_) {
    if (now < wait.until) ids.push_back(id);
  }
  return ids;
}

int BackOffs::count(const std::string& id, NextTry why) const {
  const auto found = waits_.find(id);
  return found != waits_.end() && found->second.why == why ? found->second.count : 0;
}

std::optional<BackOffs::Wait> BackOffs::find(const std::string& id, double now) const {
  const auto found = waits_.find(id);
  if (found == waits_.end() || now >= found->second.until) return {};
  return found->second;
}

}  // namespace sluice

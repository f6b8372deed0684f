#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "service/jobs/job.hpp"

namespace sluice {

/// The last progress of running jobs. It changes every second, and nobody needs it back after a
/// power cut, so its way to the disk is taken only now and then: requests would wait for it. Not
/// for several threads at once.
class LiveProgress {
 public:
  /// Between two times that a row gets its progress, ms.
  static constexpr std::int64_t kToDiskMs = 10'000;

  /// Notes it; true when the row is due to get it.
  [[nodiscard]] bool note(const std::string& id, const std::string& progress, std::int64_t now_ms);
  /// The row has it.
  void note_written(const std::string& id, std::int64_t now_ms);
  /// Puts into a job what is newer than its row.
  void show_in(Job& job) const;
  void forget(const std::string& id) { entries_.erase(id); }

 private:
  struct Entry {
    std::string progress;
    std::int64_t noted_ms = 0;
    std::int64_t written_ms = 0;
  };
  std::map<std::string, Entry> entries_;
};

}  // namespace sluice

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// Name of the file in a job's folder that keeps what its workers wrote to stderr.
inline constexpr const char* kWorkerLogName = "worker.log";

/// What one attempt writes to stderr, appended to the job's file up to a limit; the file begins
/// anew when it has become too long. A log that cannot be written is lost and disturbs nobody.
class WorkerLog {
 public:
  static constexpr std::size_t kLongestAttempt = std::size_t{256} << 10;
  static constexpr std::size_t kLongestFile = std::size_t{1} << 20;

  WorkerLog(const std::filesystem::path& folder, std::string_view head);
  void append(std::string_view bytes);
  /// The last line that was not empty, printable and of bounded length; also when none was kept.
  [[nodiscard]] std::string last_line() const;

 private:
  void put(std::string_view bytes) const;

  FileDescriptor file_;
  std::size_t room_ = kLongestAttempt;
  std::string tail_;
};

}  // namespace sluice

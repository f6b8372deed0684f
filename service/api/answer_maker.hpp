#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/store/disk/apart.hpp"
#include "service/http/slots.hpp"

namespace sluice {

/// Makes answers from the large files of jobs, each in a child process: what lies in a file cannot
/// hurt the service, and the memory that reading takes goes with the child. So the service itself
/// never reads HDF5. About as many are made at once as there are cores, within a budget of memory,
/// and they give way to the service's own threads; others wait a little. Thread-safe.
class AnswerMaker {
 public:
  struct Limits {
    int threads = 80;                   ///< requests that make or wait
    std::int64_t memory = 256LL << 20;  ///< of all children together, as `memory_for` says
    double patience = 3.0;              ///< s that a request waits for its share
    int children = default_children();  ///< at work at once
  };
  AnswerMaker() : AnswerMaker(Limits{}) {}
  explicit AnswerMaker(const Limits& limits)
      : limits_(limits),
        threads_(limits.threads),
        children_(limits.children),
        memory_(limits.memory) {}

  /// What `work`, which reads the file, returns or throws: ApiError or StorageError. It runs in the
  /// child of a process with threads: see work_apart. Throws ApiError(overloaded), and
  /// StorageError(corrupt) when the file cannot be survived; that is then known, and it is not read
  /// again.
  [[nodiscard]] std::string from_file(const std::filesystem::path& path,
                                      const std::function<std::string()>& work);

  /// What a program prints that works up `bytes` of files in `folder`. Throws ApiError(overloaded),
  /// and StorageError with what it said when it ends in any other way than with 0: corrupt when
  /// that is for the files, else io.
  [[nodiscard]] std::string by_program(std::uint64_t bytes, const std::filesystem::path& program,
                                       const std::filesystem::path& folder,
                                       const std::vector<std::string>& arguments);

 private:
  /// A file by its inode, size and time of change.
  struct Stamp {
    unsigned long device = 0;
    unsigned long inode = 0;
    long size = 0;
    long changed_seconds = 0;
    long changed_nanoseconds = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Damaged {
    Stamp stamp;
    std::string message;
  };
  struct Share {
    std::shared_ptr<void> thread;
    std::shared_ptr<void> child;
    std::shared_ptr<void> memory;
  };

  /// The number of cores, and two at least, so that a long one holds up no other.
  [[nodiscard]] static int default_children();
  [[nodiscard]] static Stamp stamp_of(const std::filesystem::path& path);
  [[nodiscard]] Share share_for(std::uint64_t bytes);
  void refuse_damaged(const Stamp& stamp);

  const Limits limits_;
  Slots threads_;
  Slots children_;
  Slots memory_;
  std::mutex mutex_;
  std::deque<Damaged> damaged_;  ///< oldest first
};

}  // namespace sluice

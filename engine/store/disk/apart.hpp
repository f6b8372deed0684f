#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sluice {

/// What work in a child process may take. Its time in which others have the cores counts only
/// towards `patience`.
struct ApartLimits {
  double core_seconds = 2.0;
  double patience = 60.0;               ///< s until it is killed, whatever it did
  std::uint64_t memory = 256ULL << 20;  ///< bytes beyond what the process has already
  std::uint64_t output = 1ULL << 30;    ///< bytes
  int nice = 0;  ///< added to the priority of whoever asks: above 0 it gives way to others
  /// For reading and working up files of ours of so many bytes together: many times what it takes.
  [[nodiscard]] static ApartLimits for_bytes(std::uint64_t bytes);
};

/// How a child process ended, and what it wrote.
struct ApartEnd {
  std::string output;
  std::string errors;  ///< its stderr, where that was asked for
  std::string
      death;  ///< what stopped it, such as "signal 11 (Segmentation fault)"; empty: it ended
  int exit_code = 0;
  /// SIGKILL of somebody else's, the kernel's for want of memory too: says nothing of the work.
  bool killed_by_others = false;
};

/// The work was stopped by a signal or by its limits.
class ApartFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Does `work` in a forked child and gives what it returned. Nothing that it does to memory
/// reaches this process; it has no open files but stdin and stdout, can write none, and
/// dies with the thread that asked. A StorageError that it throws is thrown here. Throws
/// ApartFailure when it died or had to be stopped, killed by others twice, and std::runtime_error
/// for any other exception.
///
/// The child of a process with threads has only the calling one: `work` must take no lock that
/// another thread may hold. That is why a process with threads that reads HDF5 this way reads it in
/// no other.
[[nodiscard]] std::string work_apart(const ApartLimits& limits,
                                     const std::function<std::string()>& work);

/// Runs a program the same way, in `folder`; what it writes to stdout and stderr comes back. Throws
/// std::runtime_error when no child can be made.
[[nodiscard]] ApartEnd program_apart(const ApartLimits& limits,
                                     const std::filesystem::path& program,
                                     const std::filesystem::path& folder,
                                     const std::vector<std::string>& arguments);

/// What to say of a file whose reading apart failed.
[[nodiscard]] std::string damage_message(const std::filesystem::path& path,
                                         const ApartFailure& failure);

/// Tries out in a child whether `read` of the file survives, whatever it throws. The trailer's sum
/// is no signature: who writes a file can sum it too, and HDF5 1.10 may crash or spin on an image
/// that was made to hurt. Throws what `verify` throws, and StorageError(corrupt) when it does not
/// survive.
void require_harmless(const std::filesystem::path& path, const std::function<void()>& read);

/// What `read` of this file returns, after a child has survived the same. For processes with one
/// thread: the child then did exactly what is done here.
template <class Read>
[[nodiscard]] auto read_harmless(const std::filesystem::path& path, const Read& read) {
  require_harmless(path, [&] { (void)read(); });
  return read();
}

}  // namespace sluice

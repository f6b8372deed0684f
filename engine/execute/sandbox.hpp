#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/store/disk/file_system.hpp"

namespace sluice {

/// Keeps a process to its job, as far as the kernel can: it writes in the job's folder only and
/// reads there and what the program itself consists of (Landlock); it opens no socket, starts no
/// program, traces, signals or mounts nothing (seccomp); it gains no privileges. What the kernel
/// lacks is left out; `missing` says what.
///
/// Made before a fork, entered by the child just before its exec.
class Sandbox {
 public:
  /// `program`: a descriptor of the program to be started. Throws ProcessStartError when the folder
  /// cannot be opened or the kernel refuses.
  Sandbox(const std::filesystem::path& folder, int program);

  /// The number that the program's own descriptor has in the child. The one exec that the filter
  /// lets pass names this number. The process must get a limit of descriptors that is no higher:
  /// the exec closes it, and then it cannot have such a descriptor again.
  [[nodiscard]] int program_descriptor() const { return program_descriptor_; }
  /// The descriptor that `enter` needs; below 0 for none.
  [[nodiscard]] int rules_descriptor() const { return rules_.get(); }

  /// Irrevocable. Async-signal-safe. Zero, or the errno of what failed.
  [[nodiscard]] int enter();

  /// What this kernel lacks, for a person: "Landlock", "seccomp", both or nothing.
  [[nodiscard]] static std::string missing();

 private:
  int program_descriptor_;
  FileDescriptor rules_;             ///< of Landlock; below 0 without it
  std::vector<sock_filter> filter_;  ///< of seccomp; empty without it
  std::vector<std::size_t> own_id_;  ///< instructions that compare with the process's own id
};

}  // namespace sluice

#pragma once

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace sluice {

/// What a process makes of signals until its program says otherwise.
struct ProcessSignals {
  enum class Actions {
    kept,   ///< what this process ignores is ignored
    usual,  ///< every signal has its default action
  };
  Actions actions = Actions::kept;
  std::vector<int> ignored;  ///< also
  sigset_t blocked{};        ///< by default none
  int at_parents_end = 0;    ///< sent when the thread that started it ends, even killed; 0: none
};

/// What a process may take. A limit that is left out is this process's; one beyond what the system
/// lets this process have is cut to that.
struct ProcessLimits {
  static constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  std::optional<std::uint64_t> address_space;  ///< bytes
  std::optional<std::uint64_t> largest_file;   ///< bytes
  std::optional<std::uint64_t> core_dump;      ///< bytes
  std::optional<std::uint64_t> descriptors;    ///< open files
};

/// Whom a process goes before. What is left out is as in this process. Wishes: a system that
/// refuses them still runs it.
struct ProcessPriority {
  std::optional<int> niceness;
  std::optional<int> oom_score;  ///< -1000 to 1000: short of memory, the highest goes first
  std::optional<std::uint64_t> slices_ns;  ///< ask_for_slices()
};

/// Whether a process is kept to its folder (Sandbox).
enum class Confinement { full, none };

/// What a process is started with. As it stands it makes this program a child with this process's
/// environment, signals, limits and priority.
struct ProcessCommand {
  std::filesystem::path program;                        ///< empty: this program
  std::vector<std::string> arguments;                   ///< after the program's name, "sluice"
  std::optional<std::vector<std::string>> environment;  ///< "NAME=value"; left out: this process's
  std::filesystem::path folder;  ///< its working directory; empty: this process's

  std::optional<int> input;   ///< a descriptor that it reads from; left out: empty
  std::optional<int> output;  ///< a descriptor that it writes to; left out: a pipe
  std::optional<int> errors;  ///< likewise
  /// Other descriptors of this process that are not marked to be closed at an exec.
  enum class Others { kept, closed };
  Others others = Others::kept;

  ProcessSignals signals;
  ProcessLimits limits;
  ProcessPriority priority;
  Confinement confinement = Confinement::none;  ///< to `folder`, which then may not be empty
};

}  // namespace sluice

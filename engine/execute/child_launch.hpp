#pragma once

#include <sys/types.h>

#include "engine/execute/process_command.hpp"
#include "engine/execute/sandbox.hpp"

namespace sluice {

/// What a forked child needs to become a process. All of it is made before the fork: until its exec
/// the child of a program with threads may only call what is async-signal-safe.
struct ChildLaunch {
  const ProcessCommand& command;
  pid_t parent = 0;
  // Descriptors; all are above the numbers that the child puts them at.
  int input = -1;
  int output = -1;
  int errors = -1;
  int report = -1;  ///< where a LaunchFailure goes; closed by the exec
  int program = -1;
  const char* path = nullptr;  ///< of the program, for the exec without a sandbox
  char* const* arguments = nullptr;
  char* const* environment = nullptr;
  const char* oom_score = nullptr;  ///< as text; may be null
  Sandbox* sandbox = nullptr;       ///< may be null
};

/// What the child says when it cannot become that process.
struct LaunchFailure {
  const char* action = nullptr;  ///< a literal; the child has the same address space
  int error = 0;
};

/// Lowest number of the descriptors in a ChildLaunch.
inline constexpr int kFirstFreeDescriptor = 16;

/// In the child, all signals blocked.
[[noreturn]] void become_process(const ChildLaunch& launch);

}  // namespace sluice

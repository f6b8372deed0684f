#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include "service/worker/sandbox.hpp"

namespace sluice {

/// What a forked child needs to become a worker. All of it is made before the fork: until its exec
/// the child of a program with threads may only call what is async-signal-safe.
struct ChildLaunch {
  pid_t parent = 0;
  // Descriptors; all are above the numbers that the child puts them at.
  int input = -1;
  int output = -1;
  int errors = -1;
  int report = -1;  ///< where a LaunchFailure goes; closed by the exec
  int program = -1;
  const char* folder = nullptr;
  const char* path = nullptr;  ///< of the program, for the exec without a sandbox
  char* const* arguments = nullptr;
  char* const* environment = nullptr;
  rlim_t address_space = RLIM_INFINITY;
  rlim_t largest_file = RLIM_INFINITY;
  Sandbox* sandbox = nullptr;  ///< may be null
};

/// What the child says when it cannot become a worker.
struct LaunchFailure {
  const char* action = nullptr;  ///< a literal; the child has the same address space
  int error = 0;
};

/// Lowest number of the descriptors in a ChildLaunch.
inline constexpr int kFirstFreeDescriptor = 16;

/// In the child, all signals blocked.
[[noreturn]] void become_worker(const ChildLaunch& launch);

}  // namespace sluice

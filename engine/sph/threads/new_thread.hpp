#pragma once

#include <system_error>
#include <thread>
#include <utility>

namespace sluice {

/// A thread that does `work`. Where the system refuses one it throws std::system_error with what to
/// do. Whoever starts several must end those that run already before that error leaves: a thread
/// that nobody joins ends the program.
template <class Work>
[[nodiscard]] std::thread new_thread(Work work) {
  try {
    return std::thread(std::move(work));
  } catch (const std::system_error& error) {
    throw std::system_error(error.code(),
                            "the system refuses another thread: raise the limits on processes "
                            "(ulimit -u, or a container's) and on memory (ulimit -v)");
  }
}

}  // namespace sluice

#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace sluice::test {

// Sanitizers reserve more addresses than may be left.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kThreadsCanBeRefused = false;
#else
inline constexpr bool kThreadsCanBeRefused = true;
#endif

/// While it lives the process may take so few more addresses that some threads start and then one
/// does not: each wants those of a whole stack.
class FewThreads {
 public:
  FewThreads() {
    ::getrlimit(RLIMIT_AS, &before_);
    std::ifstream file("/proc/self/statm");
    rlim_t pages = 0;
    file >> pages;
    const rlim_t wanted = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (80U << 20U);
    const rlimit limit{std::min(wanted, before_.rlim_max), before_.rlim_max};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  FewThreads(const FewThreads&) = delete;
  FewThreads& operator=(const FewThreads&) = delete;
  ~FewThreads() { ::setrlimit(RLIMIT_AS, &before_); }

 private:
  rlimit before_{};
};

}  // namespace sluice::test

#include "service/worker/core_use.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

namespace sluice {
namespace {

namespace fs = std::filesystem;

/// Adds one thread: proc(5), fields 3 (state), 14 and 15 (user and system time in ticks).
void add_thread(const fs::path& path, CoreUse& use) {
  std::ifstream file(path / "stat");
  std::string line;
  if (!std::getline(file, line)) return;
  // The name, field 2, may hold blanks and parentheses.
  std::istringstream rest(line.substr(line.rfind(')') + 1));
  char state = 0;
  rest >> state;
  std::string skipped;
  for (int field = 4; field < 14; ++field) rest >> skipped;
  double user = 0.0;
  double system = 0.0;
  if (!(rest >> user >> system)) return;
  static const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  use.core_seconds += (user + system) / ticks;
  use.runnable = use.runnable || state == 'R';
}

}  // namespace

CoreUse core_use(pid_t process) {
  CoreUse use;
  std::error_code error;
  for (fs::directory_iterator thread(fmt::format("/proc/{}/task", process), error), end;
       !error && thread != end; thread.increment(error)) {
    add_thread(thread->path(), use);
  }
  return use;
}

double StallClock::look(double now, const CoreUse& use) {
  const double passed = now - std::exchange(looked_, now);
  const double had = use.core_seconds - std::exchange(core_seconds_, use.core_seconds);
  seconds_ += use.runnable ? std::clamp(had, 0.0, passed) : passed;
  return seconds_;
}

}  // namespace sluice

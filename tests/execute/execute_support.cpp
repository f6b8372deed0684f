#include "tests/execute/execute_support.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <thread>

#include "engine/execute/local_executor.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kLongestWait{10};

}  // namespace

void wait_until(std::string_view what, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kLongestWait;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      throw std::runtime_error("waited in vain for " + std::string(what));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& path, std::string_view text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + path.string());
}

ProcessCommand script(const fs::path& folder, std::string_view lines) {
  ProcessCommand command;
  command.program = folder / "program.sh";
  write_file(command.program, "#!/bin/bash\n" + std::string(lines) + "\n");
  fs::permissions(command.program, fs::perms::owner_all);
  command.folder = folder;
  return command;
}

std::unique_ptr<RunningProcess> start(const ProcessCommand& command) {
  return local_executor().start(command);
}

ProcessEnd end_of(RunningProcess& process) {
  std::optional<ProcessEnd> end;
  wait_until("the end of the process", [&] { return (end = process.reap()).has_value(); });
  return *end;
}

std::string output_of(RunningProcess& process) {
  static_cast<void>(end_of(process));
  std::array<char, 65536> buffer{};
  const ssize_t count = ::read(process.output(), buffer.data(), buffer.size());
  return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
}

}  // namespace sluice::test

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "engine/execute/executor.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {

/// Waits until `condition` holds. The bound is there only so that a hang ends as a failure.
void wait_until(std::string_view what, const std::function<bool()>& condition);

[[nodiscard]] std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::string_view text);

/// A command that runs these lines of bash in `folder`, where it leaves them as program.sh.
[[nodiscard]] ProcessCommand script(const std::filesystem::path& folder, std::string_view lines);
[[nodiscard]] std::unique_ptr<RunningProcess> start(const ProcessCommand& command);
/// Waits for it.
[[nodiscard]] ProcessEnd end_of(RunningProcess& process);
/// What it writes to its pipe until its end; little enough for the pipe.
[[nodiscard]] std::string output_of(RunningProcess& process);

}  // namespace sluice::test

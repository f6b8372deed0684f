#pragma once

#include <filesystem>
#include <string>

namespace sluice {

/// The text as one word of a POSIX shell: as it is where that is plain, else quoted. For commands
/// that are printed to be pasted.
[[nodiscard]] std::string shell_word(const std::string& text);
/// The same for a path, which no program takes for an option then.
[[nodiscard]] std::string shell_path(const std::filesystem::path& path);

}  // namespace sluice

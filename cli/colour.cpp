#include "cli/colour.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

namespace sluice {
namespace {

using StateColour = std::pair<std::string_view, int>;

// Of the terminal's own sixteen colours, which fit its ground. A queued job is as plain as the
// rest.
constexpr std::array kStateColours{StateColour{"running", 36}, StateColour{"paused", 33},
                                   StateColour{"completed", 32}, StateColour{"failed", 31},
                                   StateColour{"cancelled", 90}};

bool shows_colours() {
  const auto set = [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  const char* const terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
  return !set("NO_COLOR") && !dumb && ::isatty(STDOUT_FILENO) == 1;
}

}  // namespace

std::string in_colour_of(std::string_view state, std::string_view text) {
  static const bool shown = shows_colours();
  for (const auto& [name, number] : kStateColours) {
    if (shown && name == state) return fmt::format("\x1b[{}m{}\x1b[0m", number, text);
  }
  return std::string(text);
}

}  // namespace sluice

#pragma once

#include <string>
#include <string_view>

namespace sluice {

/// `text` in the colour of a job's state, such as green for "completed", where standard output is a
/// terminal that shows colours: NO_COLOR (no-color.org) is not set and TERM is not dumb. Otherwise
/// `text` as it is.
[[nodiscard]] std::string in_colour_of(std::string_view state, std::string_view text);

}  // namespace sluice

#include "service/http/line_reader.hpp"

#include <algorithm>
#include <utility>

namespace sluice {

std::vector<LineReader::Line> LineReader::feed(std::string_view bytes) {
  std::vector<Line> lines;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const bool ends_here = end < bytes.size();
    if (!dropping_) {
      const std::size_t room = longest_ - rest_.size();
      rest_.append(bytes.substr(0, std::min(end, room)));
      const bool too_long = end > room;
      if (ends_here || too_long) lines.push_back({std::exchange(rest_, {}), too_long});
      dropping_ = too_long;
    }
    if (ends_here) dropping_ = false;
    bytes.remove_prefix(ends_here ? end + 1 : end);
  }
  return lines;
}

std::string LineReader::take_rest() { return std::exchange(rest_, {}); }

}  // namespace sluice

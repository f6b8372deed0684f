#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sluice {

/// Cuts a stream of bytes into lines of bounded length, whatever comes in.
class LineReader {
 public:
  explicit LineReader(std::size_t longest) : longest_(longest) {}

  struct Line {
    std::string text;  ///< without its end
    bool cut = false;  ///< longer than `longest`; the rest of it was dropped
  };
  /// The lines that `bytes` completes. A line above the limit comes out once, cut, as soon as the
  /// limit is passed.
  [[nodiscard]] std::vector<Line> feed(std::string_view bytes);
  /// What stood after the last line end, at the end of the stream; empty when nothing did.
  [[nodiscard]] std::string take_rest();

 private:
  std::size_t longest_;
  std::string rest_;
  bool dropping_ = false;  ///< until the end of a line that was cut
};

}  // namespace sluice

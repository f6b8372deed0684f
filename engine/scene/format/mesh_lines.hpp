#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace sluice {

/// Reads the words of a mesh file in text, line by line. Whatever does not fit throws
/// MeshFileError with the number of the line.
class MeshLines {
 public:
  explicit MeshLines(std::string_view bytes) : rest_(bytes) {}

  /// Whether a text begins with a word, after blanks, in letters of either case.
  [[nodiscard]] static bool begins_with(std::string_view bytes, std::string_view word);

  /// Goes to the next line that has words; false where there is none. What is left of the present
  /// one is passed over.
  bool next();
  /// Whether the line has no more words.
  [[nodiscard]] bool at_end() const { return line_.empty(); }
  /// The next word of the line in small letters.
  [[nodiscard]] std::string word();
  [[nodiscard]] double number();
  /// A corner of a face, "7", "7/1", "-1//2": the number of its point, of those so far.
  [[nodiscard]] std::uint32_t corner(std::size_t points);
  /// Goes to the next line and over these words of it.
  void require(std::initializer_list<std::string_view> words);
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view take();

  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;  ///< of the line
};

}  // namespace sluice

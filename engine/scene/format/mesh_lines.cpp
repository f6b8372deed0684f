#include "engine/scene/format/mesh_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/scene/format/mesh_file.hpp"

namespace sluice {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::size_t kShown = 40;  // bytes of a word, in messages

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == text.npos ? std::string_view{} : text.substr(begin);
}

std::string in_small_letters(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

/// In quotation marks, without what is no plain character.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, kShown));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("\"{}{}\"", text, word.size() > kShown ? "..." : "");
}

}  // namespace

bool MeshLines::begins_with(std::string_view bytes, std::string_view word) {
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n\v\f");
  return begin != bytes.npos && in_small_letters(bytes.substr(begin, word.size())) == word;
}

bool MeshLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = without_blanks(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    line_ = line_.substr(0, line_.find('#'));
    if (!line_.empty()) return true;
  }
  line_ = {};
  return false;
}

std::string_view MeshLines::take() {
  const std::size_t end = std::min(line_.find_first_of(kBlanks), line_.size());
  const std::string_view word = line_.substr(0, end);
  line_ = without_blanks(line_.substr(end));
  return word;
}

std::string MeshLines::word() { return in_small_letters(take()); }

double MeshLines::number() {
  const std::string_view word = take();
  std::string_view digits = word;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size() && !digits.empty();
  if (error != std::errc{} || !whole || !std::isfinite(value)) {
    fail(word.empty() ? "a number too few"
                      : fmt::format("{}, where a number must be", shown(word)));
  }
  return value + 0.0;  // -0 and 0 are one place
}

std::uint32_t MeshLines::corner(std::size_t points) {
  const std::string_view word = take();
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool whole = end == word.data() + word.size() || *end == '/';
  const auto count = static_cast<std::int64_t>(points);
  if (error != std::errc{} || !whole || index == 0 || index > count || index < -count) {
    fail(fmt::format("{}, where one of the {} corners so far must be", shown(word), points));
  }
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
}

void MeshLines::require(std::initializer_list<std::string_view> words) {
  if (!next()) fail(fmt::format("no more, where {} must be: it was cut off", *words.begin()));
  for (const std::string_view expected : words) {
    const std::string found = word();
    if (found != expected) {
      fail(fmt::format("{}, where {} must be", shown(found), expected));
    }
  }
}

void MeshLines::fail(const std::string& what) const {
  throw MeshFileError(fmt::format("has {} in line {}", what, number_));
}

}  // namespace sluice

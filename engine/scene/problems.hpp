#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/parse.hpp"

namespace sluice {

/// Collects problems up to kMaxProblems and counts the rest.
class Problems {
 public:
  void add(std::string pointer, std::string message);

  /// Whether nothing at or below these pointers was found wrong: what compares two keys asks first,
  /// so that one mistake is not reported twice.
  [[nodiscard]] bool clean(std::initializer_list<std::string_view> pointers) const;
  [[nodiscard]] bool empty() const { return problems_.empty(); }

  /// All of them, with a last one that says how many more there were.
  [[nodiscard]] std::vector<Problem> take();

 private:
  std::vector<Problem> problems_;
  std::size_t unnamed_ = 0;
};

/// `pointer` with one more reference token, escaped as RFC 6901 says.
[[nodiscard]] std::string at(std::string_view pointer, std::string_view key);
[[nodiscard]] std::string at(std::string_view pointer, std::size_t index);

/// The word nearest to `word` in edits (insert, delete, replace, swap neighbours), "" when none is
/// near enough to have been meant.
[[nodiscard]] std::string_view nearest(std::string_view word, std::span<const std::string_view> in);

/// `did you mean "spacing"? ` or nothing, then `allowed here: a, b, c`.
[[nodiscard]] std::string hint(std::string_view word, std::span<const std::string_view> in);

/// A double as the shortest text that reads back to it.
[[nodiscard]] std::string shortest(double value);

}  // namespace sluice

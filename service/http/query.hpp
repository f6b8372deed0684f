#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "service/http/message.hpp"
#include "service/http/problem.hpp"

namespace sluice {

/// Reads a request's query parameters and collects everything wrong with them, so that one answer
/// names all. Take each parameter that the route knows, then call finish().
class QueryReader {
 public:
  explicit QueryReader(const Request& request) : request_(&request) {}

  /// At most `longest` bytes of UTF-8 without control characters.
  std::optional<std::string> text(std::string_view name, std::size_t longest);
  /// A finite number in [lowest, highest].
  std::optional<double> number(std::string_view name, double lowest, double highest);
  std::optional<int> integer(std::string_view name, int lowest, int highest);
  /// One of `words`.
  std::optional<std::string> word(std::string_view name, std::span<const std::string_view> words);
  /// 1 or true, 0 or false, or nothing at all, which is true.
  bool flag(std::string_view name);

  /// Adds an error that only the route can see.
  void reject(std::string_view name, std::string_view detail);
  /// Throws ApiError(invalid_parameter) when anything was wrong or a parameter is unknown or given
  /// twice.
  void finish();

 private:
  const std::string* take(std::string_view name);

  const Request* request_;
  std::set<std::string, std::less<>> known_;
  ProblemFields errors_ = ProblemFields::array();
};

/// Whether the bytes are valid UTF-8 without control characters.
[[nodiscard]] bool is_plain_text(std::string_view text);

}  // namespace sluice

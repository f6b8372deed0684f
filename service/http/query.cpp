#include "service/http/query.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "engine/scene/format/code_points.hpp"
#include "engine/scene/model/problems.hpp"

namespace sluice {
namespace {

template <class Number>
std::optional<Number> read_number(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

/// Length of the UTF-8 sequence at the start of `text`, 0 when there is none (RFC 3629).
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  const auto tail = [&](std::size_t n) { return n < text.size() && (byte(n) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first < 0xE0U) return tail(1) ? 2 : 0;
  if (first >= 0xE0U && first < 0xF0U) {
    if (!tail(1) || !tail(2)) return 0;
    const bool overlong = first == 0xE0U && byte(1) < 0xA0U;
    const bool surrogate = first == 0xEDU && byte(1) >= 0xA0U;
    return overlong || surrogate ? 0 : 3;
  }
  if (first < 0xF0U || first > 0xF4U || !tail(1) || !tail(2) || !tail(3)) return 0;
  const bool overlong = first == 0xF0U && byte(1) < 0x90U;
  const bool beyond = first == 0xF4U && byte(1) >= 0x90U;
  return overlong || beyond ? 0 : 4;
}

}  // namespace

bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text.front());
    if (first < 0x20U || first == 0x7FU) return false;
    const std::size_t length = sequence_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

const std::string* QueryReader::take(std::string_view name) {
  known_.emplace(name);
  const std::string* found = nullptr;
  for (const auto& [key, value] : request_->query) {
    if (key != name) continue;
    if (found != nullptr) {
      reject(name, "is given more than once");
      return nullptr;
    }
    found = &value;
  }
  return found;
}

std::optional<std::string> QueryReader::text(std::string_view name, std::size_t longest) {
  const std::string* value = take(name);
  if (value == nullptr) return std::nullopt;
  const std::size_t length = count_code_points(*value);
  if (length <= longest && is_plain_text(*value)) return *value;
  reject(name, fmt::format("must be at most {} characters of UTF-8, none of them a control "
                           "character, but has {}",
                           longest, length));
  return std::nullopt;
}

std::optional<double> QueryReader::number(std::string_view name, double lowest, double highest) {
  const std::string* value = take(name);
  if (value == nullptr) return std::nullopt;
  const auto number = read_number<double>(*value);
  if (number && std::isfinite(*number) && *number >= lowest && *number <= highest) return number;
  reject(name, fmt::format("must be a number from {} to {}", lowest, highest));
  return std::nullopt;
}

std::optional<int> QueryReader::integer(std::string_view name, int lowest, int highest) {
  const std::string* value = take(name);
  if (value == nullptr) return std::nullopt;
  const auto number = read_number<int>(*value);
  if (number && *number >= lowest && *number <= highest) return number;
  reject(name, fmt::format("must be a whole number from {} to {}", lowest, highest));
  return std::nullopt;
}

std::optional<std::string> QueryReader::word(std::string_view name,
                                             std::span<const std::string_view> words) {
  const std::string* value = take(name);
  if (value == nullptr) return std::nullopt;
  if (std::ranges::find(words, *value) != words.end()) return *value;
  reject(name, hint(*value, words));
  return std::nullopt;
}

bool QueryReader::flag(std::string_view name) {
  const std::string* value = take(name);
  if (value == nullptr || *value == "0" || *value == "false") return false;
  if (value->empty() || *value == "1" || *value == "true") return true;
  reject(name, "must be 1 or 0");
  return false;
}

void QueryReader::reject(std::string_view name, std::string_view detail) {
  errors_.push_back({{"parameter", name}, {"detail", detail}});
}

void QueryReader::finish() {
  const std::vector<std::string_view> words(known_.begin(), known_.end());
  for (const auto& [key, value] : request_->query) {
    if (known_.contains(key)) continue;
    const std::string allowed = words.empty() ? "no parameter is allowed here" : hint(key, words);
    reject(key, fmt::format("is unknown: {}", allowed));
    if (errors_.size() >= 20) break;
  }
  if (errors_.empty()) return;
  const auto& first = errors_.front();
  throw ApiError(ProblemType::invalid_parameter,
                 fmt::format("{}: {}", first["parameter"].get<std::string>(),
                             first["detail"].get<std::string>()),
                 {{"errors", errors_}});
}

}  // namespace sluice

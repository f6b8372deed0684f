#include "service/http/http_range.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

namespace sluice {
namespace {

/// A number of digits only; the largest one when it does not fit.
std::optional<std::uint64_t> read_digits(std::string_view text) {
  const bool digits =
      !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  if (!digits) return std::nullopt;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? value : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

std::variant<WholeFile, ByteRange, NoSuchRange> read_range(std::string_view header,
                                                           std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!header.starts_with(kUnit)) return WholeFile{};
  header.remove_prefix(kUnit.size());
  if (header.find(',') != header.npos) return NoSuchRange{};
  const std::size_t dash = header.find('-');
  if (dash == header.npos) return WholeFile{};
  const auto first = read_digits(header.substr(0, dash));
  const auto last = read_digits(header.substr(dash + 1));
  if (dash == 0) {
    if (!last) return WholeFile{};
    const std::uint64_t count = std::min(*last, size);
    if (count == 0) return NoSuchRange{};
    return ByteRange{size - count, count};
  }
  const bool open = dash + 1 == header.size();
  if (!first || (!last && !open) || (last && *last < *first)) return WholeFile{};
  if (*first >= size) return NoSuchRange{};
  const std::uint64_t end = last ? std::min(*last, size - 1) : size - 1;
  return ByteRange{*first, end - *first + 1};
}

}  // namespace sluice

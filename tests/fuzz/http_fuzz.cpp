#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "service/http/http_head.hpp"
#include "service/http/http_range.hpp"
#include "service/http/multipart.hpp"
#include "service/http/problem.hpp"
#include "service/http/query.hpp"
#include "tests/fuzz/require.hpp"

// Any bytes as the head of a request, its query and its Range: refused with words, or understood
// within the limits, and never understood otherwise when they arrive in pieces.

namespace sluice::fuzz {
namespace {

constexpr std::uint64_t kFileSize = 1000;
constexpr std::string_view kFilters[] = {"none", "gaussian"};

/// As the routes of jobs and sensors ask.
void try_query(const Request& request) {
  QueryReader query(request);
  const auto from = query.number("from", 0.0, 1e9);
  require(!from || (*from >= 0.0 && *from <= 1e9), "a number is in its range");
  const auto points = query.integer("max_points", 1, 1000);
  require(!points || (*points >= 1 && *points <= 1000), "a whole number is in its range");
  const auto label = query.text("label", 64);
  require(!label || (label->size() <= 64 && is_plain_text(*label)), "a text is short and plain");
  const auto filter = query.word("filter", kFilters);
  require(!filter || std::ranges::find(kFilters, *filter) != std::end(kFilters), "a known word");
  (void)query.flag("dry_run");
  try {
    query.finish();
  } catch (const ApiError&) {
  }
}

void try_range(const Request& request) {
  const auto range = read_range(request.header("range"), kFileSize);
  if (const auto* part = std::get_if<ByteRange>(&range)) {
    require(part->count > 0 && part->count <= kFileSize, "a range is a part of the file");
    require(part->first <= kFileSize - part->count, "a range ends within the file");
  }
}

void try_form(Request request, std::string_view body) {
  if (!is_form(request)) return;
  request.body = body;
  try {
    for (const FormPart& part : read_form(request)) {
      require(part.bytes.size() <= body.size(), "a part is no longer than the form");
    }
  } catch (const ApiError&) {
  }
}

void require_sound(const RequestHead& head, const HttpLimits& limits) {
  const Request& request = head.request;
  require(head.body_bytes <= limits.upload_bytes, "the body is bounded");
  require(request.path.starts_with('/'), "a path begins with /");
  require(request.path.find('\0') == std::string::npos, "a path holds no zero byte");
  require(request.headers.size() <= limits.header_lines, "the headers are bounded");
  for (const auto& [name, value] : request.headers) {
    require(value.find_first_of("\r\n") == std::string::npos, "a header is one line");
    require(std::ranges::none_of(name, [](char c) { return c >= 'A' && c <= 'Z'; }),
            "names are lower case");
  }
}

/// A head that is found at once is not found, and not refused, before its last byte.
void require_same_in_pieces(std::string_view received, std::size_t end, const HttpLimits& limits) {
  for (const std::size_t cut : {std::size_t{0}, end / 2, end - 3, end - 2, end - 1}) {
    const auto early = find_head_end(received.substr(0, cut), limits);
    require(std::holds_alternative<std::monostate>(early), "more is waited for");
  }
}

void try_head(std::string_view received) {
  const HttpLimits limits;
  const auto found = find_head_end(received, limits);
  if (const auto* refusal = std::get_if<Refusal>(&found)) {
    return require(!refusal->detail.empty(), "a refusal says why");
  }
  const auto* end = std::get_if<HeadEnd>(&found);
  if (end == nullptr) return;
  require(end->bytes <= received.size() && end->bytes <= limits.head_bytes, "a head is bounded");
  require_same_in_pieces(received, end->bytes, limits);
  const auto parsed = parse_head(received.substr(0, end->bytes), limits);
  if (const auto* refusal = std::get_if<Refusal>(&parsed)) {
    return require(!refusal->detail.empty(), "a refusal says why");
  }
  const auto& head = std::get<RequestHead>(parsed);
  require_sound(head, limits);
  try_query(head.request);
  try_range(head.request);
  try_form(head.request, received.substr(end->bytes));
}

}  // namespace
}  // namespace sluice::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sluice::fuzz::try_head({reinterpret_cast<const char*>(data), size});
  return 0;
}

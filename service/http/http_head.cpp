#include "service/http/http_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "service/http/multipart.hpp"

namespace sluice {
namespace {

constexpr std::size_t kMostParameters = 50;

/// Headers that mean one thing: a second one is refused rather than joined.
constexpr std::array<std::string_view, 11> kSingle{"host",
                                                   "content-length",
                                                   "content-type",
                                                   "content-encoding",
                                                   "transfer-encoding",
                                                   "authorization",
                                                   "origin",
                                                   "idempotency-key",
                                                   "range",
                                                   "if-range",
                                                   "last-event-id"};

/// Leaves parse_head(), which returns it.
struct Refused {
  Refusal refusal;
};

[[noreturn]] void refuse(ProblemType type, std::string detail) {
  throw Refused{{type, std::move(detail)}};
}
[[noreturn]] void refuse(std::string detail) {
  refuse(ProblemType::bad_request, std::move(detail));
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// RFC 9110, 5.6.2.
bool is_token(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return is_letter(c) || is_digit(c) ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
  });
}

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

int hex_digit(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string_view take_line(std::string_view& head) {
  const std::size_t end = head.find("\r\n");
  const std::string_view line = head.substr(0, end);
  head.remove_prefix(std::min(head.size(), end == head.npos ? head.size() : end + 2));
  return line;
}

std::string decoded(std::string_view text, PlusSign plus) {
  auto result = decode_percent(text, plus);
  if (!result) refuse("the target holds a broken percent code or a zero byte");
  return *std::move(result);
}

void read_query(std::string_view text, Request& request) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view pair = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (pair.empty()) continue;
    const std::size_t equals = std::min(pair.find('='), pair.size());
    request.query.emplace_back(
        decoded(pair.substr(0, equals), PlusSign::space),
        decoded(pair.substr(std::min(equals + 1, pair.size())), PlusSign::space));
    if (request.query.size() > kMostParameters) {
      refuse(fmt::format("there are more than {} query parameters", kMostParameters));
    }
  }
}

/// RFC 9112, 3.2.2: the path and query of http://AUTHORITY/path?query, and the authority; any other
/// target as it is.
std::string_view without_authority(std::string_view target, std::string& authority) {
  const std::string scheme = lower(target.substr(0, target.find("://")));
  if (scheme != "http" && scheme != "https") return target;
  target.remove_prefix(scheme.size() + 3);
  const std::size_t end = std::min(target.find_first_of("/?#"), target.size());
  authority = target.substr(0, end);
  if (authority.empty() || authority.find('@') != authority.npos) {
    refuse("the request target has no host, or a user's name before it");
  }
  target.remove_prefix(end);
  if (target.empty()) return "/";
  if (target.front() != '/') refuse("the request target must have a path after its host");
  return target;
}

void read_target(std::string_view target, const HttpLimits& limits, Request& request,
                 std::string& authority) {
  if (target.size() > limits.target_bytes) {
    refuse(ProblemType::uri_too_long, fmt::format("the target has {} bytes, at most {} are read",
                                                  target.size(), limits.target_bytes));
  }
  const bool plain = std::ranges::all_of(target, [](char c) { return c > 0x20 && c < 0x7F; });
  if (plain && target == "*" && request.method == "OPTIONS") {
    request.path = target;
    return;
  }
  if (plain) target = without_authority(target, authority);
  if (!plain || !target.starts_with('/')) {
    refuse("the request target must be a path of printable ASCII that begins with /");
  }
  if (target.find('#') != target.npos) refuse("the request target holds a #: leave it out");
  const std::size_t mark = std::min(target.find('?'), target.size());
  request.path = decoded(target.substr(0, mark), PlusSign::literal);
  read_query(target.substr(std::min(mark + 1, target.size())), request);
}

/// The request line; returns whether it is HTTP/1.1, not 1.0.
bool read_request_line(std::string_view line, const HttpLimits& limits, Request& request,
                       std::string& authority) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == line.npos || first == last) refuse("the request line is not METHOD TARGET HTTP/1.1");
  request.method = line.substr(0, first);
  if (!is_token(request.method) || request.method.size() > 20) {
    refuse("the request line does not begin with a method");
  }
  const std::string_view version = line.substr(last + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0") refuse("the version must be HTTP/1.1");
  read_target(line.substr(first + 1, last - first - 1), limits, request, authority);
  return version == "HTTP/1.1";
}

void read_header(std::string_view line, Request& request) {
  const std::size_t colon = line.find(':');
  if (colon == line.npos || !is_token(line.substr(0, colon))) {
    refuse("a header line is not NAME: VALUE");
  }
  const std::string name = lower(line.substr(0, colon));
  const std::string_view value = trim(line.substr(colon + 1));
  const auto control = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t') || byte == 0x7F;
  };
  if (std::ranges::any_of(value, control)) {
    refuse(fmt::format("header {} holds a control character", name));
  }
  const auto [place, fresh] = request.headers.emplace(name, value);
  if (fresh) return;
  if (std::ranges::find(kSingle, name) != kSingle.end()) {
    refuse(fmt::format("header {} is given more than once", name));
  }
  place->second += fmt::format(", {}", value);
}

void read_headers(std::string_view lines, const HttpLimits& limits, Request& request) {
  std::size_t count = 0;
  while (!lines.empty()) {
    const std::string_view line = take_line(lines);
    if (line.empty()) return;
    if (++count > limits.header_lines) {
      refuse(ProblemType::headers_too_large,
             fmt::format("there are more than {} header lines", limits.header_lines));
    }
    read_header(line, request);
  }
}

std::size_t read_body_size(const Request& request, const HttpLimits& limits) {
  if (request.headers.contains("transfer-encoding")) {
    refuse(ProblemType::not_implemented,
           "Transfer-Encoding is not read: send the body with Content-Length");
  }
  const std::string_view encoding = request.header("content-encoding");
  if (!encoding.empty() && lower(encoding) != "identity") {
    refuse(ProblemType::unsupported_media_type, "an encoded body is not read: send it plain");
  }
  const auto length = request.headers.find("content-length");
  if (length == request.headers.end()) return 0;
  const std::string& text = length->second;
  if (text.empty() || !std::ranges::all_of(text, is_digit)) {
    refuse("Content-Length is not a number");
  }
  const bool upload =
      request.method == "POST" && request.path == limits.upload_path && is_form(request);
  const std::size_t most = upload ? limits.upload_bytes : limits.body_bytes;
  std::size_t bytes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bytes);
  if (error != std::errc{} || bytes > most) {
    refuse(ProblemType::body_too_large,
           fmt::format("the body has {} bytes, at most {} are read", text.substr(0, 30), most));
  }
  return bytes;
}

RequestHead read_head(std::string_view head, const HttpLimits& limits) {
  RequestHead result;
  Request& request = result.request;
  std::string authority;
  const bool newer = read_request_line(take_line(head), limits, request, authority);
  read_headers(head, limits, request);
  if (newer && !request.headers.contains("host")) refuse("the Host header is missing");
  // RFC 9112, 3.2.2: the target's host counts, whatever the header says.
  if (!authority.empty()) request.headers["host"] = authority;
  result.body_bytes = read_body_size(request, limits);
  const std::string connection = lower(request.header("connection"));
  result.keep_alive = newer && connection.find("close") == std::string::npos;
  const std::string expect = lower(request.header("expect"));
  if (!expect.empty() && expect != "100-continue") refuse("only Expect: 100-continue is known");
  result.expects_continue = !expect.empty();
  return result;
}

}  // namespace

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::optional<std::string> decode_percent(std::string_view text, PlusSign plus) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t n = 0; n < text.size(); ++n) {
    char c = text[n];
    if (c == '+' && plus == PlusSign::space) c = ' ';
    if (text[n] == '%') {
      if (n + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[n + 1]);
      const int low = hex_digit(text[n + 2]);
      if (high < 0 || low < 0 || high + low == 0) return std::nullopt;
      c = static_cast<char>(high * 16 + low);
      n += 2;
    }
    result.push_back(c);
  }
  return result;
}

std::variant<std::monostate, HeadEnd, Refusal> find_head_end(std::string_view received,
                                                             const HttpLimits& limits) {
  const std::size_t end = received.find("\r\n\r\n");
  const std::string_view head = received.substr(0, end == received.npos ? end : end + 4);
  for (std::size_t n = head.find('\n'); n != head.npos; n = head.find('\n', n + 1)) {
    if (n == 0 || head[n - 1] != '\r') {
      return Refusal{ProblemType::bad_request, "a line does not end with CR LF"};
    }
  }
  if (head.size() > limits.head_bytes) {
    // A target that alone is too long has an answer of its own.
    const bool target = head.find("\r\n") > limits.target_bytes + 64;
    return Refusal{
        target ? ProblemType::uri_too_long : ProblemType::headers_too_large,
        fmt::format("request line and headers have more than {} bytes", limits.head_bytes)};
  }
  if (end == received.npos) return std::monostate{};
  return HeadEnd{end + 4};
}

std::variant<RequestHead, Refusal> parse_head(std::string_view head, const HttpLimits& limits) {
  try {
    return read_head(head, limits);
  } catch (Refused& refused) {
    return std::move(refused.refusal);
  }
}

}  // namespace sluice

#include "service/http/multipart.hpp"

#include <fmt/format.h>

#include <optional>

#include "service/http/http_head.hpp"
#include "service/http/problem.hpp"

namespace sluice {
namespace {

constexpr std::string_view kForm = "multipart/form-data";
constexpr std::size_t kLongestBoundary = 70;  // RFC 2046
constexpr std::size_t kLongestPartHead = 2048;

[[noreturn]] void refuse_form(std::string_view why) {
  throw ApiError(ProblemType::bad_request,
                 fmt::format("the form cannot be read: {}; send it as curl -F does", why));
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// The value of `; name=value` or `; name="value"` in a header; nothing where it is not there. A
/// backslash stands for itself, as browsers and curl write it, unless a quotation mark follows.
std::optional<std::string> parameter(std::string_view header, std::string_view name) {
  std::size_t at = header.find(';');
  while (at != header.npos) {
    header = trimmed(header.substr(at + 1));
    const std::size_t equals = header.find('=');
    if (equals == header.npos) return std::nullopt;
    const bool wanted = lower(trimmed(header.substr(0, equals))) == name;
    header = header.substr(equals + 1);
    std::string value;
    std::size_t end = 0;
    if (header.starts_with('"')) {
      for (end = 1; end < header.size() && header[end] != '"'; ++end) {
        if (header[end] == '\\' && end + 1 < header.size() && header[end + 1] == '"') ++end;
        value += header[end];
      }
      if (end == header.size()) return std::nullopt;
      ++end;
    } else {
      end = std::min(header.find_first_of("; \t"), header.size());
      value = header.substr(0, end);
    }
    if (wanted) return value;
    header = header.substr(end);
    at = header.find(';');
  }
  return std::nullopt;
}

std::string boundary_of(const Request& request) {
  const auto found = parameter(request.header("content-type"), "boundary");
  if (!found || found->empty() || found->size() > kLongestBoundary) {
    refuse_form("its Content-Type names no boundary of 1 to 70 characters");
  }
  return "--" + *found;
}

/// The names in the head of a part.
FormPart read_part_head(std::string_view head) {
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const std::size_t colon = std::min(line.find(':'), line.size());
    if (lower(trimmed(line.substr(0, colon))) != "content-disposition") continue;
    const auto name = parameter(line, "name");
    if (!name) break;
    return {*name, parameter(line, "filename").value_or(""), {}};
  }
  refuse_form("a part has no Content-Disposition with a name");
}

}  // namespace

bool is_form(const Request& request) {
  const std::string_view type = request.header("content-type");
  return lower(trimmed(type.substr(0, type.find(';')))) == kForm;
}

std::vector<FormPart> read_form(const Request& request) {
  const std::string boundary = boundary_of(request);
  std::string_view rest = request.body;
  // What stands before the first boundary is not part of the form, and rarely there.
  const bool first_line = rest.starts_with(boundary);
  const std::size_t first = first_line ? 0 : rest.find("\r\n" + boundary);
  if (first == rest.npos) refuse_form("its boundary is nowhere in it");
  rest.remove_prefix(first + (first_line ? 0 : 2) + boundary.size());
  std::vector<FormPart> parts;
  while (!rest.starts_with("--")) {
    const std::size_t line_end = rest.find("\r\n");
    if (line_end == rest.npos || !trimmed(rest.substr(0, line_end)).empty()) {
      refuse_form("a boundary is not alone in its line");
    }
    if (parts.size() == kMostFormParts) {
      refuse_form(fmt::format("it has more than {} parts", kMostFormParts));
    }
    // From the line's end, so that a part without a head has an empty one.
    rest.remove_prefix(line_end);
    const std::size_t head_end = rest.find("\r\n\r\n");
    if (head_end == rest.npos || head_end > kLongestPartHead) {
      refuse_form("the head of a part does not end");
    }
    FormPart part = read_part_head(rest.substr(0, head_end).substr(head_end > 0 ? 2 : 0));
    rest.remove_prefix(head_end + 4);
    const std::size_t end = rest.find("\r\n" + boundary);
    if (end == rest.npos) refuse_form("it is cut off: a part has no end");
    part.bytes = rest.substr(0, end);
    rest.remove_prefix(end + 2 + boundary.size());
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace sluice

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "service/http/message.hpp"
#include "service/http/problem.hpp"

namespace sluice {

/// What is read at most, whatever arrives.
struct HttpLimits {
  std::size_t head_bytes = 16 * 1024;
  std::size_t header_lines = 100;
  std::size_t target_bytes = 4 * 1024;
  std::size_t body_bytes = 256 * 1024;
  std::string upload_path = "/v1/jobs";              ///< where a form with files may be longer
  std::size_t upload_bytes = 32 * 1024 * 1024;       ///< such a form
  std::size_t all_uploads_bytes = 96 * 1024 * 1024;  ///< of those that arrive at once
};

/// Why a request is not taken.
struct Refusal {
  ProblemType type = ProblemType::bad_request;
  std::string detail;
};

/// A request's head, checked, and what it says about the connection.
struct RequestHead {
  Request request;  ///< without its body
  std::size_t body_bytes = 0;
  bool keep_alive = true;
  bool expects_continue = false;
};

/// Where the head ends in what has arrived: behind its empty line.
struct HeadEnd {
  std::size_t bytes = 0;
};
/// Looks for the end of the head; nothing while more must arrive. Refuses lines that end without
/// CR, and heads beyond the limits, as soon as they can be seen.
[[nodiscard]] std::variant<std::monostate, HeadEnd, Refusal> find_head_end(
    std::string_view received, const HttpLimits& limits);

/// Reads a whole head (RFC 9112), empty line included: strictly, because what two readers could
/// understand differently is how requests are smuggled. Refused: Transfer-Encoding and
/// Content-Encoding, a second Host or Content-Length, folded lines, any control character.
[[nodiscard]] std::variant<RequestHead, Refusal> parse_head(std::string_view head,
                                                            const HttpLimits& limits);

/// Decodes %XX, and + as a space where asked; nothing for a broken code or %00.
enum class PlusSign { literal, space };
[[nodiscard]] std::optional<std::string> decode_percent(std::string_view text, PlusSign plus);

/// ASCII letters made small.
[[nodiscard]] std::string lower(std::string_view text);

}  // namespace sluice

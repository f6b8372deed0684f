#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "service/http/message.hpp"

namespace sluice {

/// A part of a form with files: its field's name, the file's name if it is one, and its bytes,
/// which are the request's.
struct FormPart {
  std::string name;
  std::string filename;
  std::string_view bytes;
};

/// Parts of a form at most; a form of more is refused.
inline constexpr std::size_t kMostFormParts = 65;

/// Whether a request says that its body is a form with files.
[[nodiscard]] bool is_form(const Request& request);

/// The parts of a form with files (RFC 7578), in their order. Throws ApiError(bad_request) for what
/// is none: without a boundary, cut off, with more parts than kMostFormParts or with heads that
/// do not name them. Nothing is copied but names.
[[nodiscard]] std::vector<FormPart> read_form(const Request& request);

}  // namespace sluice

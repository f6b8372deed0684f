#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "service/http/message.hpp"

namespace sluice {

/// Who may ask.
struct GuardOptions {
  std::string token;                    ///< empty: none is asked for
  std::vector<std::string> host_names;  ///< allowed in Host beside localhost and addresses
};

/// The answer to a request that may not be handled; nothing for one that may. In this order: Host
/// must be an address, localhost or a name that was allowed (a page of another site can bind its
/// own name to our address, but not an address); a changing request's Origin must be this very
/// host; the token must be right, but for /livez and /readyz.
[[nodiscard]] std::optional<Response> guard(const Request& request, const GuardOptions& options);

/// Whether two texts are equal, in a time that does not tell where they differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view given, std::string_view secret);

/// Reads a token of 16 to 512 printable characters from a file that only its owner can read. Throws
/// std::runtime_error that says what to do.
[[nodiscard]] std::string read_token_file(const std::filesystem::path& path);

}  // namespace sluice

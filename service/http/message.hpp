#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sluice {

/// A request without its socket. Header names are lower case; the path is decoded and has no query.
struct Request {
  std::string method;
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
  std::map<std::string, std::string> headers;
  std::string body;

  /// The header's value, empty when it is absent.
  [[nodiscard]] std::string_view header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string_view{} : std::string_view(found->second);
  }
};

/// A response without its socket: a body, a file, or a stream of events.
struct Response {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string content_type = "application/json";
  std::string body;
  std::optional<std::filesystem::path> file;  ///< sent as it is, with Range and a strong ETag
  /// Server-sent events: called until it returns false; gives what to send next, waiting a bounded
  /// time.
  std::function<bool(std::string& chunk)> stream;
};

}  // namespace sluice

#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/job_store.hpp"
#include "service/scheduler.hpp"

namespace sluice {

/// A request without its socket. Header names are lower case; the path is decoded and has no query.
struct Request {
  std::string method;
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
  std::map<std::string, std::string> headers;
  std::string body;
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

/// All routes of design section 8. Knows no sockets; every error is problem+json (RFC 9457) and
/// none leaves as an exception. May be called from any thread.
class Api {
 public:
  Api(JobStore& store, Scheduler& scheduler, std::filesystem::path data);
  [[nodiscard]] Response handle(const Request& request);
  /// While draining, changing requests are answered 503 and /readyz says so.
  void set_draining();

 private:
  JobStore& store_;
  Scheduler& scheduler_;
  std::filesystem::path data_;
};

}  // namespace sluice

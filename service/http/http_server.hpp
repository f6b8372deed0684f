#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "service/http/http_guard.hpp"
#include "service/http/http_head.hpp"
#include "service/http/message.hpp"

namespace sluice {

struct HttpOptions {
  std::string host = "127.0.0.1";
  int port = 8080;  ///< 0: any free one
  int threads = 160;
  int connections = 512;                 ///< beyond it the one that has waited longest is closed
  int large_answers = 24;                ///< that are sent at once: files and long bodies
  std::int64_t unsent_bytes = 32 << 20;  ///< of other answers that clients have yet to take
  std::vector<std::string> apart{"/livez", "/readyz"};  ///< paths with a thread of their own
  std::int64_t large_bytes = 32 << 20;                  ///< of the bodies of those together
  double arrival_seconds = 10;  ///< for a whole request, from its first byte
  double upload_seconds = 60;   ///< the same for a form with files
  double idle_seconds = 30;     ///< between requests
  double stall_seconds = 10;    ///< without a byte taken by the client
  HttpLimits limits;
  GuardOptions guard;
};

/// One answered request, for a log and for counting.
struct AccessRecord {
  std::string method;
  std::string path;  ///< as the client wrote it, decoded: to be escaped
  std::string peer;
  int status = 0;
  double seconds = 0.0;  ///< from the request's last byte to the answer's
  bool whole = true;     ///< the client took all of it
  bool stream = false;   ///< events: `seconds` is how long it listened
};

/// Whether an address can only be reached from this machine. Throws std::runtime_error for what is
/// no address or name.
[[nodiscard]] bool is_loopback(const std::string& host);

/// The HTTP server. One thread accepts and gathers requests in memory, bounded in bytes, lines and
/// time, so that slow or silent clients cost no thread; whole requests go to a pool of threads,
/// which guard them and ask the handler. What a client does not take of a short answer goes back to
/// the first thread, so that clients that do not read cost no thread either; long answers have
/// places, of which one that stalls makes room for another. Keep-alive; no TLS: put a proxy in
/// front.
class HttpServer {
 public:
  using Handler = std::function<Response(const Request&)>;
  /// Called from any thread.
  using Observer = std::function<void(const AccessRecord&)>;

  /// Listens from here on. Throws std::runtime_error: the address is no address or is taken, or it
  /// can be reached from other machines and there is no token. Also when the system refuses one of
  /// its threads (std::system_error): with fewer, what may hold them for long would take them all.
  HttpServer(HttpOptions options, Handler handler, Observer observer);
  /// Stops.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] int port() const;
  /// Closes the listening socket and idle connections, lets answers be finished for up to two
  /// seconds, then cuts them. Idempotent.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sluice

#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sluice {

/// Where a service answers.
struct ServerAddress {
  enum class Scheme { http, https };
  Scheme scheme = Scheme::http;
  std::string host;  ///< a name or an address, IPv6 without brackets
  int port = 0;
};

/// Reads "http://HOST[:PORT]" or "https://HOST[:PORT]"; an IPv6 address stands in brackets. Throws
/// std::invalid_argument that says what is wrong.
[[nodiscard]] ServerAddress parse_address(std::string_view text);

/// A path part or a query value with every byte but A-Z a-z 0-9 - . _ ~ as %XX.
[[nodiscard]] std::string percent_encoded(std::string_view text);

struct HttpRequest {
  std::string method = "GET";
  std::string target;  ///< path and query, encoded
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;
  int timeout = 60;  ///< s without a byte from the server
};

struct HttpReply {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;

  /// Empty when it is absent.
  [[nodiscard]] std::string_view header(const std::string& name) const;
};

/// There is no whole answer.
class NoReply : public std::runtime_error {
 public:
  enum class Fault {
    not_connected,  ///< the request did not leave
    cut_short,      ///< it may have arrived; the answer did not
    untrusted,      ///< a certificate that this machine does not trust
    too_large,      ///< an answer that no service of ours gives
  };
  NoReply(Fault fault, const std::string& what) : std::runtime_error(what), fault_(fault) {}
  [[nodiscard]] Fault fault() const { return fault_; }

 private:
  Fault fault_;
};

/// Asks one server, with a connection for each request; follows no redirections, so that a token
/// goes nowhere else. One thread at a time.
class HttpClient {
 public:
  /// `token` goes along as a bearer token unless it is empty.
  HttpClient(const ServerAddress& address, const std::string& token);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// Returns an answer of any status. Throws NoReply.
  [[nodiscard]] HttpReply ask(const HttpRequest& request);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sluice

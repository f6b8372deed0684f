#include "cli/client/http_client.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <charconv>
#include <csignal>

namespace sluice {
namespace {

constexpr int kConnectTimeout = 10;                             // s
constexpr std::size_t kLargestReply = std::size_t{256} << 20U;  // bytes

bool is_one_of(char c, std::string_view more) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         more.find(c) != std::string_view::npos;
}

[[noreturn]] void refuse(std::string_view text, std::string_view why) {
  throw std::invalid_argument(
      fmt::format("\"{}\" is no address of a service: {}; an address is like "
                  "http://127.0.0.1:8080",
                  text, why));
}

bool take(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// Takes the host from the front: a name, an address, or an IPv6 address in brackets.
std::string take_host(std::string_view& rest, std::string_view whole) {
  const bool v6 = take(rest, "[");
  const std::size_t end = std::min(rest.find(v6 ? ']' : ':'), rest.size());
  const std::string_view host = rest.substr(0, end);
  rest.remove_prefix(end);
  if (v6 && !take(rest, "]")) refuse(whole, "the bracket is not closed");
  const auto belongs = [v6](char c) { return is_one_of(c, v6 ? ":." : "-._"); };
  if (host.empty()) refuse(whole, "it names no host");
  if (!std::ranges::all_of(host, belongs)) {
    refuse(whole, "after the scheme stand only a host and a port");
  }
  return std::string(host);
}

int read_port(std::string_view rest, std::string_view whole) {
  int port = 0;
  const char* const end = rest.data() + rest.size();
  const auto [stop, error] = std::from_chars(rest.data(), end, port);
  const bool whole_number = error == std::errc{} && stop == end;
  if (stop != rest.data() && stop != end) {
    refuse(whole, "after the scheme stand only a host and a port");
  }
  if (!whole_number || port < 1 || port > 65535) {
    refuse(whole, "the port must be a number from 1 to 65535");
  }
  return port;
}

std::unique_ptr<httplib::ClientImpl> make_client(const ServerAddress& address) {
  if (address.scheme == ServerAddress::Scheme::https) {
    return std::make_unique<httplib::SSLClient>(address.host, address.port);
  }
  return std::make_unique<httplib::ClientImpl>(address.host, address.port);
}

[[noreturn]] void fail(httplib::Error error) {
  switch (error) {
    case httplib::Error::Connection:
      throw NoReply(NoReply::Fault::not_connected, "nothing answers there");
    case httplib::Error::ConnectionTimeout:
      throw NoReply(NoReply::Fault::not_connected,
                    fmt::format("no connection within {} s", kConnectTimeout));
    case httplib::Error::SSLConnection:
      throw NoReply(NoReply::Fault::not_connected, "it does not speak TLS");
    case httplib::Error::SSLLoadingCerts:
    case httplib::Error::SSLServerVerification:
      throw NoReply(NoReply::Fault::untrusted,
                    "this machine does not trust its certificate; a file with the one to trust "
                    "can be named in SSL_CERT_FILE");
    case httplib::Error::Canceled:
      throw NoReply(NoReply::Fault::too_large,
                    fmt::format("its answer is larger than {} MiB", kLargestReply >> 20U));
    default:
      throw NoReply(NoReply::Fault::cut_short, "the connection broke before the whole answer came");
  }
}

httplib::Request native_request(const HttpRequest& request, const std::string& token) {
  httplib::Request native;
  native.method = request.method;
  native.path = request.target;
  native.body = request.body;
  for (const auto& [name, value] : request.headers) native.headers.emplace(name, value);
  if (!token.empty()) native.headers.emplace("Authorization", "Bearer " + token);
  native.headers.emplace("Accept-Encoding", "identity");
  native.headers.emplace("User-Agent", "sluice");
  return native;
}

HttpReply plain_reply(const httplib::Response& native, std::string body) {
  HttpReply reply;
  reply.status = native.status;
  reply.body = std::move(body);
  for (const auto& [name, value] : native.headers) {
    std::string lower = name;
    for (char& c : lower) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    reply.headers.emplace(std::move(lower), value);
  }
  return reply;
}

}  // namespace

ServerAddress parse_address(std::string_view text) {
  std::string_view rest = text;
  ServerAddress address;
  if (take(rest, "https://")) {
    address.scheme = ServerAddress::Scheme::https;
  } else if (!take(rest, "http://")) {
    refuse(text, "it must begin with http:// or https://");
  }
  if (rest.ends_with('/')) rest.remove_suffix(1);
  address.host = take_host(rest, text);
  address.port = address.scheme == ServerAddress::Scheme::https ? 443 : 80;
  if (take(rest, ":")) {
    address.port = read_port(rest, text);
  } else if (!rest.empty()) {
    refuse(text, "after the scheme stand only a host and a port");
  }
  return address;
}

std::string percent_encoded(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (is_one_of(c, "-._~")) {
      result += c;
    } else {
      result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return result;
}

std::string_view HttpReply::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string_view{} : std::string_view(found->second);
}

class HttpClient::Impl {
 public:
  Impl(const ServerAddress& address, const std::string& token)
      : client_(make_client(address)), token_(token) {
    // The library writes to sockets whose other end may be gone.
    std::signal(SIGPIPE, SIG_IGN);
    client_->set_connection_timeout(kConnectTimeout);
    client_->set_tcp_nodelay(true);
    client_->set_url_encode(false);
    client_->set_decompress(false);
  }

  HttpReply ask(const HttpRequest& request) {
    httplib::Request native = native_request(request, token_);
    std::string body;
    native.content_receiver = [&body](const char* data, std::size_t length, std::uint64_t,
                                      std::uint64_t) {
      if (body.size() + length > kLargestReply) return false;
      body.append(data, length);
      return true;
    };
    client_->set_read_timeout(request.timeout);
    client_->set_write_timeout(request.timeout);
    httplib::Response response;
    httplib::Error error = httplib::Error::Success;
    if (!client_->send(native, response, error)) fail(error);
    return plain_reply(response, std::move(body));
  }

 private:
  std::unique_ptr<httplib::ClientImpl> client_;
  std::string token_;
};

HttpClient::HttpClient(const ServerAddress& address, const std::string& token)
    : impl_(std::make_unique<Impl>(address, token)) {}

HttpClient::~HttpClient() = default;

HttpReply HttpClient::ask(const HttpRequest& request) { return impl_->ask(request); }

}  // namespace sluice

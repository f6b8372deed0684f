#include "tests/service/http/http_client.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace sluice::test {

RawClient::RawClient(int port, const char* from)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in own{};
  own.sin_family = AF_INET;
  if (::inet_pton(AF_INET, from, &own.sin_addr) != 1 ||
      ::bind(socket_.get(), reinterpret_cast<sockaddr*>(&own), sizeof own) != 0) {
    throw std::runtime_error("cannot take the address");
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot connect");
  }
}

bool RawClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool RawClient::read_more() {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
  if (count <= 0) return false;
  received_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

std::string RawClient::answer() {
  std::size_t end = received_.find("\r\n\r\n");
  while (end == received_.npos) {
    if (!read_more()) return {};
    end = received_.find("\r\n\r\n");
  }
  std::size_t length = 0;
  const std::string mark = "\r\nContent-Length: ";
  const std::size_t at = received_.find(mark);
  if (at < end) {
    const char* const first = received_.data() + at + mark.size();
    std::from_chars(first, received_.data() + end, length);
  }
  while (received_.size() < end + 4 + length && read_more()) {
  }
  std::string whole = received_.substr(0, end + 4 + length);
  received_.erase(0, whole.size());
  return whole;
}

std::string RawClient::rest() {
  while (read_more()) {
  }
  return std::move(received_);
}

std::string RawClient::until(std::string_view text) {
  while (received_.find(text) == received_.npos && read_more()) {
  }
  return received_;
}

void RawClient::take_little() {
  const int bytes = 4096;
  ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
}

std::string exchange(int port, std::string_view request) {
  RawClient client(port);
  client.send(request);
  return client.answer();
}

int status_of(std::string_view answer) {
  int status = 0;
  if (answer.size() > 12) std::from_chars(answer.data() + 9, answer.data() + 12, status);
  return status;
}

std::string text_of(std::string_view answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return std::string(answer.substr(std::min(answer.size(), end + 4)));
}

bool has_line(std::string_view answer, std::string_view line) {
  const std::string_view head = answer.substr(0, answer.find("\r\n\r\n") + 2);
  return head.find("\r\n" + std::string(line) + "\r\n") != head.npos;
}

}  // namespace sluice::test

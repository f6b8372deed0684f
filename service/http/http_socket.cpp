#include "service/http/http_socket.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "service/http/http_server.hpp"

namespace sluice {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

constexpr int kBacklog = 511;
/// So much of an answer the system takes at once, whatever the client does, bytes.
constexpr int kSendBuffer = 256 * 1024;

Addresses resolve(const std::string& host, int port) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
  if (error != 0 || found == nullptr) {
    throw std::runtime_error(
        fmt::format("cannot listen on {}: {}; give an address of this machine with --host", host,
                    gai_strerror(error)));
  }
  return {found, &freeaddrinfo};
}

void set(int socket, int level, int option, int value) {
  ::setsockopt(socket, level, option, &value, sizeof value);
}

int port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  std::array<char, NI_MAXSERV> service{};
  getnameinfo(reinterpret_cast<sockaddr*>(&address), size, nullptr, 0, service.data(),
              service.size(), NI_NUMERICSERV);
  return std::atoi(service.data());
}

bool is_loopback(const addrinfo& address) {
  if (address.ai_family == AF_INET) {
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(address.ai_addr);
    return (ntohl(v4->sin_addr.s_addr) >> 24U) == 127U;
  }
  if (address.ai_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(address.ai_addr);
    return IN6_IS_ADDR_LOOPBACK(&v6->sin6_addr);
  }
  return false;
}

}  // namespace

bool is_loopback(const std::string& host) {
  const Addresses addresses = resolve(host, 0);
  for (const addrinfo* one = addresses.get(); one != nullptr; one = one->ai_next) {
    if (!is_loopback(*one)) return false;
  }
  return true;
}

Listener listen_on(const std::string& host, int port) {
  const Addresses addresses = resolve(host, port);
  const addrinfo& address = *addresses;
  FileDescriptor socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.get() >= 0) set(socket.get(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (socket.get() < 0 || ::bind(socket.get(), address.ai_addr, address.ai_addrlen) != 0 ||
      ::listen(socket.get(), kBacklog) != 0) {
    const int error = errno;
    throw std::runtime_error(fmt::format("cannot listen on {}:{}: {}; choose another with --port",
                                         host, port, std::strerror(error)));
  }
  const int bound = port_of(socket.get());
  return {std::move(socket), bound};
}

FileDescriptor accept_from(const FileDescriptor& listener) {
  FileDescriptor socket(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (socket.get() >= 0) {
    // Without it an answer waits for the client's delayed acknowledgement: 43 ms.
    set(socket.get(), IPPROTO_TCP, TCP_NODELAY, 1);
    set(socket.get(), SOL_SOCKET, SO_SNDBUF, kSendBuffer);
  }
  return socket;
}

std::string peer_name(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
      getnameinfo(reinterpret_cast<sockaddr*>(&address), size, host.data(), host.size(),
                  service.data(), service.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return {};
  }
  return fmt::format("{}:{}", host.data(), service.data());
}

SocketSink::SocketSink(int socket, double stall_seconds)
    : socket_(socket), stall_seconds_(stall_seconds) {}

bool SocketSink::wait_for_room() {
  const auto start = Clock::now();
  stalled_since_ = start.time_since_epoch().count();
  pollfd room{socket_, POLLOUT, 0};
  int ready = 0;
  do {
    ready = ::poll(&room, 1, static_cast<int>(stall_seconds_ * 1000.0));
  } while (ready < 0 && errno == EINTR);
  stalled_since_ = 0;
  waited_ += std::chrono::duration<double>(Clock::now() - start).count();
  const bool crawls =
      waited_ > stall_seconds_ && static_cast<double>(written_) < kSlowestClient * waited_;
  return ready > 0 && (room.revents & POLLOUT) != 0 && !crawls;
}

double SocketSink::stalled_for() const {
  const Clock::rep since = stalled_since_;
  if (since == 0) return 0.0;
  return std::chrono::duration<double>(Clock::now().time_since_epoch() - Clock::duration(since))
      .count();
}

bool SocketSink::write(const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(socket_, bytes, count, MSG_NOSIGNAL);
    if (sent > 0) {
      bytes += sent;
      count -= static_cast<std::size_t>(sent);
      written_ += static_cast<std::size_t>(sent);
    } else if (sent < 0 && errno == EINTR) {
      continue;
    } else if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      if (!wait_for_room()) return false;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace sluice

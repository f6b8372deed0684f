#pragma once

#include <atomic>
#include <chrono>
#include <string>

#include "engine/store/disk/file_system.hpp"
#include "service/http/http_response.hpp"

namespace sluice {

/// A listening socket and where it listens.
struct Listener {
  FileDescriptor socket;
  int port = 0;
};

/// Binds and listens, not blocking. SO_REUSEADDR, so that a restart need not wait, but not
/// SO_REUSEPORT: two servers must not share a port. Throws std::runtime_error.
[[nodiscard]] Listener listen_on(const std::string& host, int port);

/// A connection that came in, not blocking and without delay; negative with errno when there is
/// none.
[[nodiscard]] FileDescriptor accept_from(const FileDescriptor& listener);

/// "127.0.0.1:54321" of the other end.
[[nodiscard]] std::string peer_name(int socket);

/// Below that, a client that takes its answer slowly is cut off, bytes/s.
inline constexpr double kSlowestClient = 16 * 1024.0;

/// Writes to a socket that does not block. Gives up when the client takes nothing for
/// `stall_seconds`, or is slower than 16 KiB/s over more than that time.
class SocketSink final : public ByteSink {
 public:
  SocketSink(int socket, double stall_seconds);
  bool write(const char* bytes, std::size_t count) override;
  /// For how long the client has taken nothing, s; from any thread.
  [[nodiscard]] double stalled_for() const;

 private:
  using Clock = std::chrono::steady_clock;
  bool wait_for_room();

  int socket_;
  double stall_seconds_;
  double waited_ = 0.0;                        ///< s
  std::atomic<Clock::rep> stalled_since_ = 0;  ///< 0: it does not
  std::size_t written_ = 0;
};

/// Collects in memory, for answers from a thread that must not wait.
class StringSink final : public ByteSink {
 public:
  bool write(const char* bytes, std::size_t count) override {
    text.append(bytes, count);
    return true;
  }
  std::string text;
};

}  // namespace sluice

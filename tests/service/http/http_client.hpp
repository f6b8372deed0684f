#pragma once

#include <string>
#include <string_view>

#include "engine/store/disk/file_system.hpp"

namespace sluice::test {

/// A client that says exactly what it is told to.
class RawClient {
 public:
  /// Connects to 127.0.0.1, from `address`.
  explicit RawClient(int port, const char* address = "127.0.0.1");

  /// Sends all; false when the server took no more.
  bool send(std::string_view bytes);
  /// Reads one answer: its head, and as much body as Content-Length says. Empty when the server
  /// closed without one.
  [[nodiscard]] std::string answer();
  /// Reads until the server closes.
  [[nodiscard]] std::string rest();
  /// Reads until `text` has come.
  [[nodiscard]] std::string until(std::string_view text);
  /// A small window, so that the server soon waits for this client.
  void take_little();

 private:
  /// False at the end.
  bool read_more();

  FileDescriptor socket_;
  std::string received_;
};

/// One request on a connection of its own; the whole answer.
[[nodiscard]] std::string exchange(int port, std::string_view request);
/// The status of an answer, 0 for none.
[[nodiscard]] int status_of(std::string_view answer);
/// The body of an answer.
[[nodiscard]] std::string text_of(std::string_view answer);
/// Whether the head has this line.
[[nodiscard]] bool has_line(std::string_view answer, std::string_view line);

}  // namespace sluice::test

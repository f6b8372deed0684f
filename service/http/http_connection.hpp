#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <variant>

#include "engine/store/disk/file_system.hpp"
#include "service/http/http_head.hpp"
#include "service/http/http_server.hpp"

namespace sluice {

/// The gathering end of one connection: takes what has arrived until it is a whole request. Not
/// thread-safe; owned by whoever works on it.
class HttpConnection {
 public:
  using Clock = std::chrono::steady_clock;

  HttpConnection(FileDescriptor socket, std::string peer, Clock::time_point now);

  struct More {};    ///< wait for more
  struct Closed {};  ///< the client went away
  struct Whole {
    Request request;
    bool keep_alive = true;
  };
  using Step = std::variant<More, Closed, Whole, Refusal>;

  /// Reads what there is, without waiting, and looks for a whole request.
  [[nodiscard]] Step receive(const HttpLimits& limits, Clock::time_point now);
  /// Looks at what came with the request before.
  [[nodiscard]] Step advance(const HttpLimits& limits, Clock::time_point now);

  /// Takes leave: sends no more, and reads and drops what still comes, so that the client gets to
  /// read the answer rather than a reset. Over when `drop` says so.
  void linger(Clock::time_point now);
  /// Whether the client has closed or sent too much.
  [[nodiscard]] bool drop();

  /// An answer that was written into memory: sent as far as the client takes it.
  struct Answer {
    std::string text;
    std::size_t sent = 0;
    Clock::time_point until;  ///< the client must have taken it by then
    AccessRecord record;
    bool keep = true;  ///< whether another request may follow
  };
  enum class Flushed { whole, part, gone };
  void put(Answer answer) { answer_ = std::move(answer); }
  /// Sends what the client takes now, without waiting.
  [[nodiscard]] Flushed flush();
  /// What it has yet to take.
  [[nodiscard]] const std::optional<Answer>& answer() const { return answer_; }
  /// Takes the answer away, sent or not.
  [[nodiscard]] Answer take_answer();

  [[nodiscard]] int socket() const { return socket_.get(); }
  [[nodiscard]] const std::string& peer() const { return peer_; }
  [[nodiscard]] bool lingers() const { return lingers_; }
  /// Whether part of a request has arrived.
  [[nodiscard]] bool in_request() const { return !received_.empty(); }
  /// The bytes of the body that is arriving, where it is a long one; else 0.
  [[nodiscard]] std::size_t upload_bytes(const HttpLimits& limits) const;
  /// Since when it has waited for the whole request, or for its first byte.
  [[nodiscard]] Clock::time_point since() const { return since_; }

 private:
  void say_continue();

  FileDescriptor socket_;
  std::string peer_;
  std::string received_;
  std::optional<RequestHead> head_;
  std::optional<Answer> answer_;
  std::size_t head_bytes_ = 0;
  std::size_t dropped_ = 0;
  Clock::time_point since_;
  bool lingers_ = false;
};

}  // namespace sluice

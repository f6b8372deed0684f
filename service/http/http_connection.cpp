#include "service/http/http_connection.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <utility>

namespace sluice {
namespace {

constexpr std::size_t kReadBytes = 16 * 1024;
/// So much is read and dropped after the last answer, bytes.
constexpr std::size_t kMostDropped = 1 << 20;

}  // namespace

HttpConnection::HttpConnection(FileDescriptor socket, std::string peer, Clock::time_point now)
    : socket_(std::move(socket)), peer_(std::move(peer)), since_(now) {}

HttpConnection::Step HttpConnection::receive(const HttpLimits& limits, Clock::time_point now) {
  std::array<char, kReadBytes> bytes;  // NOLINT(*-member-init): filled by recv
  const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return More{};
  if (count <= 0) return Closed{};
  if (received_.empty()) since_ = now;
  received_.append(bytes.data(), static_cast<std::size_t>(count));
  return advance(limits, now);
}

HttpConnection::Step HttpConnection::advance(const HttpLimits& limits, Clock::time_point now) {
  // RFC 9112, 2.2: an empty line before a request is passed over.
  while (!head_ && received_.starts_with("\r\n")) received_.erase(0, 2);
  if (received_.empty()) return More{};
  if (!head_) {
    const auto found = find_head_end(received_, limits);
    if (const auto* refusal = std::get_if<Refusal>(&found)) return *refusal;
    const auto* end = std::get_if<HeadEnd>(&found);
    if (end == nullptr) return More{};
    auto parsed = parse_head(std::string_view(received_).substr(0, end->bytes), limits);
    if (auto* refusal = std::get_if<Refusal>(&parsed)) return std::move(*refusal);
    head_ = std::get<RequestHead>(std::move(parsed));
    head_bytes_ = end->bytes;
    if (head_->expects_continue && received_.size() < head_bytes_ + head_->body_bytes) {
      say_continue();
    }
  }
  const std::size_t total = head_bytes_ + head_->body_bytes;
  if (received_.size() < total) return More{};
  Whole whole{std::move(head_->request), head_->keep_alive};
  if (received_.size() == total) {
    received_.erase(0, head_bytes_);
    whole.request.body = std::exchange(received_, {});
  } else {
    whole.request.body = received_.substr(head_bytes_, head_->body_bytes);
    received_.erase(0, total);
  }
  received_.shrink_to_fit();
  head_.reset();
  since_ = now;
  return whole;
}

std::size_t HttpConnection::upload_bytes(const HttpLimits& limits) const {
  return head_ && head_->body_bytes > limits.body_bytes ? head_->body_bytes : 0;
}

void HttpConnection::say_continue() {
  constexpr std::string_view kLine = "HTTP/1.1 100 Continue\r\n\r\n";
  // A client that cannot take 25 bytes sends its body anyway after a while.
  [[maybe_unused]] const auto sent =
      ::send(socket_.get(), kLine.data(), kLine.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void HttpConnection::linger(Clock::time_point now) {
  ::shutdown(socket_.get(), SHUT_WR);
  received_.clear();
  received_.shrink_to_fit();
  since_ = now;
  lingers_ = true;
}

HttpConnection::Flushed HttpConnection::flush() {
  std::string_view left = std::string_view(answer_->text).substr(answer_->sent);
  while (!left.empty()) {
    const ssize_t count =
        ::send(socket_.get(), left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return Flushed::part;
    if (count <= 0) return Flushed::gone;
    answer_->sent += static_cast<std::size_t>(count);
    left.remove_prefix(static_cast<std::size_t>(count));
  }
  return Flushed::whole;
}

HttpConnection::Answer HttpConnection::take_answer() {
  Answer answer = *std::move(answer_);
  answer_.reset();
  return answer;
}

bool HttpConnection::drop() {
  std::array<char, kReadBytes> bytes;  // NOLINT(*-member-init): filled by recv
  const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
  if (count < 0) return errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR;
  dropped_ += static_cast<std::size_t>(count);
  return count == 0 || dropped_ > kMostDropped;
}

}  // namespace sluice

#include "service/http/http_gatherer.hpp"

#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <tuple>

#include "engine/sph/threads/new_thread.hpp"
#include "service/http/http_response.hpp"
#include "service/http/problem.hpp"

namespace sluice {
namespace {

constexpr double kLingerSeconds = 2.0;
constexpr int kTickMs = 250;  // between looks at who is late

double seconds_between(HttpConnection::Clock::time_point from,
                       HttpConnection::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

std::runtime_error system_failure(std::string_view what) {
  return std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

/// Without the port. Views the connection's own text.
std::string_view address_of(const HttpConnection& connection) {
  const std::string_view peer = connection.peer();
  return peer.substr(0, peer.rfind(':'));
}

}  // namespace

HttpGatherer::HttpGatherer(const HttpOptions& options, Taker taker, HttpServer::Observer observer)
    : options_(options),
      taker_(std::move(taker)),
      observer_(std::move(observer)),
      listener_(listen_on(options_.host, options_.port)),
      poll_(::epoll_create1(EPOLL_CLOEXEC)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (poll_.get() < 0 || wake_.get() < 0) throw system_failure("cannot wait for connections");
  watch(listener_.socket.get());
  watch(wake_.get());
  thread_ = new_thread([this] { gather(); });
}

HttpGatherer::~HttpGatherer() { stop(); }

void HttpGatherer::give_back(Connection connection) {
  {
    const std::scoped_lock lock(mutex_);
    returned_.push_back(std::move(connection));
  }
  wake();
}

void HttpGatherer::stop() {
  if (!thread_.joinable()) return;
  stopping_ = true;
  wake();
  thread_.join();
}

void HttpGatherer::watch(int descriptor, Wanted wanted) const {
  epoll_event event{};
  event.events = wanted == Wanted::room ? EPOLLOUT : EPOLLIN;
  event.data.fd = descriptor;
  if (::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, descriptor, &event) != 0) {
    throw system_failure("cannot watch a connection");
  }
}

void HttpGatherer::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_.get(), &one, sizeof one);
}

void HttpGatherer::gather() {
  std::array<epoll_event, 64> events{};
  while (!stopping_) {
    const int count = ::epoll_wait(poll_.get(), events.data(), events.size(), kTickMs);
    for (int n = 0; n < count; ++n) handle_event(events[static_cast<std::size_t>(n)].data.fd);
    close_late(Clock::now());
  }
  listener_.socket = FileDescriptor(-1);
  waiting_.clear();
}

void HttpGatherer::handle_event(int descriptor) {
  if (descriptor == listener_.socket.get()) return accept_all();
  if (descriptor == wake_.get()) return take_back();
  const auto place = waiting_.find(descriptor);
  if (place == waiting_.end()) return;
  HttpConnection& connection = *place->second;
  if (connection.answer()) {
    send_on(place);
  } else if (!connection.lingers()) {
    receive(place);
  } else if (connection.drop()) {
    waiting_.erase(place);
  }
}

/// Long bodies are taken for as long as there is room for all of them that arrive.
void HttpGatherer::receive(Place place) {
  HttpConnection& connection = *place->second;
  const HttpLimits& limits = options_.limits;
  const bool known = connection.upload_bytes(limits) > 0;
  HttpConnection::Step step = connection.receive(limits, Clock::now());
  if (!known && connection.upload_bytes(limits) > 0) {
    std::size_t total = 0;
    for (const auto& entry : waiting_) total += entry.second->upload_bytes(limits);
    if (total > limits.all_uploads_bytes) {
      return refuse(place, {ProblemType::overloaded,
                            "too many files are being sent: try again in some seconds"});
    }
  }
  follow(place, std::move(step));
}

void HttpGatherer::accept_all() {
  for (;;) {
    FileDescriptor socket = accept_from(listener_.socket);
    if (socket.get() < 0) {
      if (errno == EINTR || errno == ECONNABORTED) continue;
      // Without descriptors left, one that waits makes room.
      if (errno == EMFILE || errno == ENFILE) make_room();
      return;
    }
    if (open_connections() >= options_.connections) make_room();
    if (open_connections() >= options_.connections) continue;
    std::string peer = peer_name(socket.get());
    admit(std::make_unique<HttpConnection>(std::move(socket), std::move(peer), Clock::now()));
  }
}

void HttpGatherer::admit(Connection connection) {
  const int descriptor = connection->socket();
  try {
    watch(descriptor, connection->answer() ? Wanted::room : Wanted::bytes);
  } catch (const std::runtime_error&) {
    return;  // closed with the connection
  }
  waiting_[descriptor] = std::move(connection);
}

int HttpGatherer::open_connections() const {
  return static_cast<int>(waiting_.size()) + handed_out_;
}

/// Those first that do not take their answer.
HttpGatherer::Place HttpGatherer::longest_waiting() {
  return std::ranges::min_element(waiting_, {}, [](const auto& entry) {
    return std::pair(!entry.second->answer(), entry.second->since());
  });
}

void HttpGatherer::make_room() {
  std::map<std::string_view, int> shares;
  for (const auto& [socket, connection] : waiting_) ++shares[address_of(*connection)];
  const auto place = std::ranges::min_element(waiting_, {}, [&](const auto& entry) {
    const HttpConnection& one = *entry.second;
    return std::tuple(-shares[address_of(one)], !one.answer(), one.since());
  });
  if (place != waiting_.end()) cut(place);
}

void HttpGatherer::take_back() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = ::read(wake_.get(), &count, sizeof count);
  std::vector<Connection> returned;
  {
    const std::scoped_lock lock(mutex_);
    returned.swap(returned_);
  }
  handed_out_ -= static_cast<int>(returned.size());
  for (Connection& connection : returned) {
    const int descriptor = connection->socket();
    admit(std::move(connection));
    const auto place = waiting_.find(descriptor);
    if (place == waiting_.end() || place->second->lingers() || place->second->answer()) continue;
    follow(place, place->second->advance(options_.limits, Clock::now()));
  }
  cut_beyond_memory();
}

void HttpGatherer::send_on(Place place) {
  switch (place->second->flush()) {
    case HttpConnection::Flushed::part:
      return;
    case HttpConnection::Flushed::gone:
      return cut(place);
    case HttpConnection::Flushed::whole:
      break;
  }
  HttpConnection::Answer answer = place->second->take_answer();
  answer.record.whole = true;
  observer_(answer.record);
  Connection connection = std::move(place->second);
  waiting_.erase(place);
  ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, connection->socket(), nullptr);
  if (!answer.keep) connection->linger(Clock::now());
  // As if it had come back with all of it sent.
  ++handed_out_;
  give_back(std::move(connection));
}

/// Closes it; one whose answer is not all sent is told of.
void HttpGatherer::cut(Place place) {
  if (place->second->answer()) observer_(place->second->take_answer().record);
  waiting_.erase(place);
}

void HttpGatherer::cut_beyond_memory() {
  const auto unsent = [](const auto& entry) -> std::int64_t {
    const auto& answer = entry.second->answer();
    return answer ? static_cast<std::int64_t>(answer->text.size()) : 0;
  };
  std::int64_t total = 0;
  for (const auto& entry : waiting_) total += unsent(entry);
  while (total > options_.unsent_bytes) {
    const Place place = longest_waiting();
    total -= unsent(*place);
    cut(place);
  }
}

void HttpGatherer::follow(Place place, HttpConnection::Step step) {
  if (std::holds_alternative<HttpConnection::Closed>(step)) {
    waiting_.erase(place);
  } else if (const auto* refusal = std::get_if<Refusal>(&step)) {
    refuse(place, *refusal);
  } else if (auto* whole = std::get_if<HttpConnection::Whole>(&step)) {
    Connection connection = std::move(place->second);
    waiting_.erase(place);
    ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, connection->socket(), nullptr);
    ++handed_out_;
    taker_(std::move(connection), std::move(*whole));
  }
}

/// Answers from this thread: a refusal is short, and a client that cannot take it is left.
void HttpGatherer::refuse(Place place, const Refusal& refusal) {
  HttpConnection& connection = *place->second;
  StringSink answer;
  const Request unread{"GET", "", {}, {}, ""};
  write_response(answer, unread, problem_response(refusal.type, refusal.detail), Afterwards::close);
  [[maybe_unused]] const auto sent = ::send(connection.socket(), answer.text.data(),
                                            answer.text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  AccessRecord record;
  record.peer = connection.peer();
  record.status = problem_entry(refusal.type).status;
  observer_(record);
  connection.linger(Clock::now());
}

void HttpGatherer::close_late(Clock::time_point now) {
  for (auto next = waiting_.begin(); next != waiting_.end();) {
    const auto place = next++;
    const HttpConnection& connection = *place->second;
    if (connection.answer()) {
      if (now > connection.answer()->until) cut(place);
      continue;
    }
    const double waited = seconds_between(connection.since(), now);
    if (connection.in_request() && !connection.lingers()) {
      const bool upload = connection.upload_bytes(options_.limits) > 0;
      const double most = upload ? options_.upload_seconds : options_.arrival_seconds;
      if (waited <= most) continue;
      refuse(place, {ProblemType::request_timeout,
                     fmt::format("the request was not whole after {} s", most)});
    } else if (waited > (connection.lingers() ? kLingerSeconds : options_.idle_seconds)) {
      waiting_.erase(place);
    }
  }
}

}  // namespace sluice

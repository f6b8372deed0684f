#include "service/http_server.hpp"

#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "service/http_connection.hpp"
#include "service/http_response.hpp"
#include "service/http_socket.hpp"
#include "service/problem.hpp"
#include "service/slots.hpp"

namespace sluice {
namespace {

using Clock = HttpConnection::Clock;
using Connection = std::unique_ptr<HttpConnection>;

constexpr double kLingerSeconds = 2.0;
constexpr double kGraceSeconds = 2.0;
/// An answer of this size fits into the socket's buffer, so that it never waits for the client.
constexpr std::size_t kSmallAnswer = 128 * 1024;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// A whole request on its way to a thread.
struct Work {
  Connection connection;
  HttpConnection::Whole whole;
};

std::runtime_error system_failure(std::string_view what) {
  return std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

void require_protection(const HttpOptions& options) {
  if (is_loopback(options.host) || !options.guard.token.empty()) return;
  throw std::runtime_error(
      fmt::format("{} can be reached from other machines, so a token is needed: give --token-file, "
                  "or listen on 127.0.0.1",
                  options.host));
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(HttpOptions options, Handler handler, Observer observer)
      : options_(std::move(options)),
        handler_(std::move(handler)),
        observer_(std::move(observer)),
        listener_(open()),
        poll_(::epoll_create1(EPOLL_CLOEXEC)),
        wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        large_(options_.large_answers) {
    if (poll_.get() < 0 || wake_.get() < 0) throw system_failure("cannot wait for connections");
    watch(listener_.socket.get());
    watch(wake_.get());
    for (int n = 0; n < options_.threads; ++n) threads_.emplace_back([this] { work(); });
    gatherer_ = std::thread([this] { gather(); });
  }

  ~Impl() { stop(); }

  [[nodiscard]] int port() const { return listener_.port; }

  void stop() {
    const std::scoped_lock once(stop_mutex_);
    if (!gatherer_.joinable()) return;
    stopping_ = true;
    wake();
    gatherer_.join();
    finish_work();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  Listener open() const {
    require_protection(options_);
    return listen_on(options_.host, options_.port);
  }

  // The gathering thread's own: poll_ watches the listener, the eventfd and every connection in
  // waiting_. A connection with a whole request moves to queue_, and comes back through returned_.

  void watch(int descriptor) const {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = descriptor;
    if (::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, descriptor, &event) != 0) {
      throw system_failure("cannot watch a connection");
    }
  }

  void gather() {
    std::array<epoll_event, 64> events{};
    while (!stopping_) {
      const int count = ::epoll_wait(poll_.get(), events.data(), events.size(), 250);
      for (int n = 0; n < count; ++n) handle_event(events[static_cast<std::size_t>(n)].data.fd);
      close_late(Clock::now());
    }
    listener_.socket = FileDescriptor(-1);
    waiting_.clear();
  }

  void handle_event(int descriptor) {
    if (descriptor == listener_.socket.get()) return accept_all();
    if (descriptor == wake_.get()) return take_back();
    const auto found = waiting_.find(descriptor);
    if (found == waiting_.end()) return;
    HttpConnection& connection = *found->second;
    if (connection.lingers()) {
      if (connection.drop()) waiting_.erase(found);
      return;
    }
    follow(found, connection.receive(options_.limits, Clock::now()));
  }

  using Place = std::map<int, Connection>::iterator;

  void follow(Place place, HttpConnection::Step step) {
    if (std::holds_alternative<HttpConnection::Closed>(step)) {
      waiting_.erase(place);
    } else if (auto* refusal = std::get_if<Refusal>(&step)) {
      refuse(place, *refusal);
    } else if (auto* whole = std::get_if<HttpConnection::Whole>(&step)) {
      Connection connection = std::move(place->second);
      waiting_.erase(place);
      ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, connection->socket(), nullptr);
      {
        const std::scoped_lock lock(mutex_);
        queue_.push_back({std::move(connection), std::move(*whole)});
      }
      work_there_.notify_one();
    }
  }

  /// Answers from this thread: a refusal is short, and a client that cannot take it is left.
  void refuse(Place place, const Refusal& refusal) {
    HttpConnection& connection = *place->second;
    StringSink answer;
    const Request unread{"GET", "", {}, {}, ""};
    write_response(answer, unread, problem_response(refusal.type, refusal.detail),
                   Afterwards::close);
    [[maybe_unused]] const auto sent = ::send(connection.socket(), answer.text.data(),
                                              answer.text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    AccessRecord record;
    record.peer = connection.peer();
    record.status = problem_entry(refusal.type).status;
    observer_(record);
    connection.linger(Clock::now());
  }

  void accept_all() {
    for (;;) {
      FileDescriptor socket = accept_from(listener_.socket);
      if (socket.get() < 0) {
        // Without descriptors left, the one that has waited longest makes room.
        if (errno == EMFILE || errno == ENFILE) close_longest_waiting();
        if (errno == EINTR || errno == ECONNABORTED) continue;
        return;
      }
      if (open_connections() >= options_.connections) close_longest_waiting();
      if (open_connections() >= options_.connections) continue;
      const int descriptor = socket.get();
      std::string peer = peer_name(descriptor);
      auto connection =
          std::make_unique<HttpConnection>(std::move(socket), std::move(peer), Clock::now());
      admit(std::move(connection));
    }
  }

  void admit(Connection connection) {
    const int descriptor = connection->socket();
    try {
      watch(descriptor);
    } catch (const std::runtime_error&) {
      return;  // closed with the connection
    }
    waiting_[descriptor] = std::move(connection);
  }

  [[nodiscard]] int open_connections() {
    const std::scoped_lock lock(mutex_);
    return static_cast<int>(waiting_.size() + queue_.size() + returned_.size() + busy_.size());
  }

  void close_longest_waiting() {
    const auto oldest = std::ranges::min_element(
        waiting_, {}, [](const auto& entry) { return entry.second->since(); });
    if (oldest != waiting_.end()) waiting_.erase(oldest);
  }

  void take_back() {
    std::uint64_t count = 0;
    [[maybe_unused]] const auto got = ::read(wake_.get(), &count, sizeof count);
    std::vector<Connection> returned;
    {
      const std::scoped_lock lock(mutex_);
      returned.swap(returned_);
    }
    for (Connection& connection : returned) {
      const int descriptor = connection->socket();
      admit(std::move(connection));
      const auto place = waiting_.find(descriptor);
      if (place == waiting_.end() || place->second->lingers()) continue;
      follow(place, place->second->advance(options_.limits, Clock::now()));
    }
  }

  void close_late(Clock::time_point now) {
    for (auto place = waiting_.begin(); place != waiting_.end();) {
      const auto current = place++;
      HttpConnection& connection = *current->second;
      const double waited = seconds_between(connection.since(), now);
      if (connection.lingers()) {
        if (waited > kLingerSeconds) waiting_.erase(current);
      } else if (connection.in_request()) {
        if (waited > options_.arrival_seconds) {
          refuse(current,
                 {ProblemType::request_timeout,
                  fmt::format("the request was not whole after {} s", options_.arrival_seconds)});
        }
      } else if (waited > options_.idle_seconds) {
        waiting_.erase(current);
      }
    }
  }

  void wake() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake_.get(), &one, sizeof one);
  }

  // The pool's.

  void work() {
    while (auto work = next_work()) {
      const int socket = work->connection->socket();
      const bool kept = answer(*work);
      {
        const std::scoped_lock lock(mutex_);
        busy_.erase(socket);
        if (!kept) work->connection->linger(Clock::now());
        returned_.push_back(std::move(work->connection));
      }
      work_done_.notify_all();
      wake();
    }
  }

  std::optional<Work> next_work() {
    std::unique_lock lock(mutex_);
    work_there_.wait(lock, [this] { return !queue_.empty() || quit_; });
    if (queue_.empty()) return std::nullopt;
    Work work = std::move(queue_.front());
    queue_.pop_front();
    busy_.insert(work.connection->socket());
    return work;
  }

  /// Whether the connection can be kept.
  bool answer(const Work& work) {
    const auto start = Clock::now();
    const Request& request = work.whole.request;
    Response response = respond(request);
    const bool streams = static_cast<bool>(response.stream);
    const bool is_large = response.file || response.body.size() > kSmallAnswer;
    const auto place = is_large ? large_.try_take() : nullptr;
    if (is_large && !place) {
      response = problem_response(ProblemType::overloaded,
                                  "too many large answers are being sent: try again in a second");
    }
    const bool keep = work.whole.keep_alive && !stopping_;
    SocketSink sink(work.connection->socket(), options_.stall_seconds);
    const Written written = write_response(sink, request, std::move(response),
                                           keep ? Afterwards::keep : Afterwards::close);
    observer_({request.method, request.path, work.connection->peer(), written.status,
               seconds_between(start, Clock::now()), written.whole, streams});
    return keep && written.whole;
  }

  Response respond(const Request& request) {
    try {
      if (auto refused = guard(request, options_.guard)) return *std::move(refused);
      return handler_(request);
    } catch (const std::exception& error) {
      return problem_response(ProblemType::internal, error.what());
    }
  }

  void finish_work() {
    std::unique_lock lock(mutex_);
    const auto idle = [this] { return queue_.empty() && busy_.empty(); };
    work_done_.wait_for(lock, std::chrono::duration<double>(kGraceSeconds), idle);
    queue_.clear();
    for (const int socket : busy_) ::shutdown(socket, SHUT_RDWR);
    quit_ = true;
    work_there_.notify_all();
    work_done_.wait(lock, idle);
    returned_.clear();
  }

  const HttpOptions options_;
  const Handler handler_;
  const Observer observer_;
  Listener listener_;
  const FileDescriptor poll_;
  const FileDescriptor wake_;
  Slots large_;
  std::map<int, Connection> waiting_;  ///< the gathering thread's
  std::atomic<bool> stopping_ = false;

  std::mutex mutex_;  ///< of the members below
  std::condition_variable work_there_;
  std::condition_variable work_done_;
  std::deque<Work> queue_;
  std::vector<Connection> returned_;
  std::set<int> busy_;
  bool quit_ = false;

  std::mutex stop_mutex_;
  std::vector<std::thread> threads_;
  std::thread gatherer_;
};

HttpServer::HttpServer(HttpOptions options, Handler handler, Observer observer)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(handler), std::move(observer))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port(); }

void HttpServer::stop() { impl_->stop(); }

}  // namespace sluice

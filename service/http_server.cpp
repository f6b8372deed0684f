#include "service/http_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "service/http_gatherer.hpp"
#include "service/http_response.hpp"
#include "service/problem.hpp"
#include "service/slots.hpp"

namespace sluice {
namespace {

using Clock = std::chrono::steady_clock;
using Connection = HttpGatherer::Connection;

/// s that answers get to be finished when the server stops.
constexpr double kGraceSeconds = 2.0;
/// An answer of this size fits into the socket's buffer, so that it never waits for the client.
constexpr std::size_t kSmallAnswer = 128 * 1024;

/// A whole request on its way to a thread.
struct Work {
  Connection connection;
  HttpConnection::Whole whole;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

const HttpOptions& require_protection(const HttpOptions& options) {
  if (is_loopback(options.host) || !options.guard.token.empty()) return options;
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
        large_(options_.large_bytes),
        gatherer_(
            require_protection(options_),
            [this](Connection connection, HttpConnection::Whole whole) {
              enqueue({std::move(connection), std::move(whole)});
            },
            observer_) {
    for (int n = 0; n < options_.threads; ++n) threads_.emplace_back([this] { work(); });
  }

  ~Impl() { stop(); }

  [[nodiscard]] int port() const { return gatherer_.port(); }

  void stop() {
    const std::scoped_lock once(stop_mutex_);
    stopping_ = true;
    gatherer_.stop();
    finish_work();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  void enqueue(Work work) {
    {
      const std::scoped_lock lock(mutex_);
      queue_.push_back(std::move(work));
    }
    work_there_.notify_one();
  }

  void work() {
    while (auto work = next_work()) {
      const bool kept = answer(*work);
      // Before it is given back: its number may then belong to another connection.
      forget(work->connection->socket());
      if (!kept) work->connection->linger(Clock::now());
      gatherer_.give_back(std::move(work->connection));
    }
  }

  std::optional<Work> next_work() {
    std::unique_lock lock(mutex_);
    work_there_.wait(lock, [this] { return !queue_.empty() || quit_; });
    if (queue_.empty()) return std::nullopt;
    Work work = std::move(queue_.front());
    queue_.pop_front();
    busy_.push_back(work.connection->socket());
    return work;
  }

  void forget(int socket) {
    {
      const std::scoped_lock lock(mutex_);
      std::erase(busy_, socket);
    }
    work_done_.notify_all();
  }

  /// Whether the connection can be kept.
  bool answer(const Work& work) {
    const auto start = Clock::now();
    const Request& request = work.whole.request;
    Response response = respond(request);
    const bool streams = static_cast<bool>(response.stream);
    const auto place = take_place(response);
    const bool keep = work.whole.keep_alive && !stopping_;
    SocketSink sink(work.connection->socket(), options_.stall_seconds);
    const Written written = write_response(sink, request, std::move(response),
                                           keep ? Afterwards::keep : Afterwards::close);
    observer_({request.method, request.path, work.connection->peer(), written.status,
               seconds_since(start), written.whole, streams});
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

  /// A share of the memory and the threads for large answers, or none for a small one. Without one
  /// left the answer becomes a refusal.
  std::shared_ptr<void> take_place(Response& response) {
    std::error_code missing;
    const std::uintmax_t bytes =
        response.file ? std::filesystem::file_size(*response.file, missing) : response.body.size();
    if (bytes <= kSmallAnswer || missing) return nullptr;
    const auto least = options_.large_bytes / options_.large_answers;
    auto place = large_.try_take(std::max(least, static_cast<std::int64_t>(response.body.size())));
    if (!place) {
      response = problem_response(ProblemType::overloaded,
                                  "too many large answers are being sent: try again in a second");
      response.headers.emplace_back("Retry-After", "1");
    }
    return place;
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
  }

  const HttpOptions options_;
  const Handler handler_;
  const Observer observer_;
  Slots large_;
  std::atomic<bool> stopping_ = false;

  std::mutex mutex_;
  std::condition_variable work_there_;
  std::condition_variable work_done_;
  std::deque<Work> queue_;
  std::vector<int> busy_;  ///< sockets that are being answered
  bool quit_ = false;

  // The gatherer hands out work as soon as it lives.
  HttpGatherer gatherer_;
  std::mutex stop_mutex_;
  std::vector<std::thread> threads_;
};

HttpServer::HttpServer(HttpOptions options, Handler handler, Observer observer)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(handler), std::move(observer))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port(); }

void HttpServer::stop() { impl_->stop(); }

}  // namespace sluice

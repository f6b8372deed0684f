#include "service/http/http_server.hpp"

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

#include "engine/sph/threads/new_thread.hpp"
#include "service/http/http_gatherer.hpp"
#include "service/http/http_response.hpp"
#include "service/http/http_socket.hpp"
#include "service/http/problem.hpp"
#include "service/http/slots.hpp"

namespace sluice {
namespace {

using Clock = std::chrono::steady_clock;
using Connection = HttpGatherer::Connection;

/// s that answers get to be finished when the server stops.
constexpr double kGraceSeconds = 2.0;
/// An answer up to this size is written into memory, so that no thread waits for the client.
constexpr std::size_t kSmallAnswer = 128 * 1024;
/// s without a byte after which a long answer loses its place to another.
constexpr double kMayStall = 1.0;

/// An answer that a thread is sending.
struct LongAnswer {
  int socket = -1;
  const SocketSink* sink = nullptr;
};

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
    try {
      for (int n = 0; n < options_.threads; ++n) add_thread(common_);
      add_thread(apart_);
    } catch (...) {
      stop();
      throw;
    }
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
  /// Requests that wait for one of the lane's threads.
  struct Lane {
    std::deque<Work> queue;
    std::condition_variable work_there;
  };

  void add_thread(Lane& lane) {
    threads_.push_back(new_thread([this, &lane] { work(lane); }));
  }

  void enqueue(Work work) {
    const auto& apart = options_.apart;
    const bool is_apart = std::ranges::find(apart, work.whole.request.path) != apart.end();
    Lane& lane = is_apart ? apart_ : common_;
    {
      const std::scoped_lock lock(mutex_);
      lane.queue.push_back(std::move(work));
    }
    lane.work_there.notify_one();
  }

  void work(Lane& lane) {
    while (auto work = next_work(lane)) {
      const bool kept = answer(*work);
      // Before it is given back: its number may then belong to another connection.
      forget(work->connection->socket());
      if (!kept) work->connection->linger(Clock::now());
      gatherer_.give_back(std::move(work->connection));
    }
  }

  std::optional<Work> next_work(Lane& lane) {
    std::unique_lock lock(mutex_);
    lane.work_there.wait(lock, [&] { return !lane.queue.empty() || quit_; });
    if (lane.queue.empty()) return std::nullopt;
    Work work = std::move(lane.queue.front());
    lane.queue.pop_front();
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

  /// Whether the connection can be kept. An answer that is not all sent then goes with it.
  bool answer(const Work& work) {
    const auto start = Clock::now();
    const Request& request = work.whole.request;
    Response response = respond(request);
    const bool streams = static_cast<bool>(response.stream);
    const bool is_long = long_bytes(response) > 0;
    SocketSink sink(work.connection->socket(), options_.stall_seconds);
    const auto place = is_long ? take_place(response, work.connection->socket(), sink) : nullptr;
    const bool keep = work.whole.keep_alive && !stopping_;
    const Afterwards afterwards = keep ? Afterwards::keep : Afterwards::close;
    AccessRecord record{request.method, request.path, work.connection->peer(), 0, 0.0,
                        false,          streams};
    if (!streams && !place) {
      StringSink text;
      record.status = write_response(text, request, std::move(response), afterwards).status;
      record.seconds = seconds_since(start);
      return send(*work.connection, std::move(text.text), std::move(record), keep);
    }
    const Written written = write_response(sink, request, std::move(response), afterwards);
    if (place) forget_long(sink);
    record.status = written.status;
    record.seconds = seconds_since(start);
    record.whole = written.whole;
    observer_(record);
    return keep && written.whole;
  }

  bool send(HttpConnection& connection, std::string text, AccessRecord record, bool keep) {
    const std::chrono::duration<double> time(options_.stall_seconds +
                                             static_cast<double>(text.size()) / kSlowestClient);
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
    connection.put({std::move(text), 0, until, std::move(record), keep});
    const auto flushed = connection.flush();
    if (flushed == HttpConnection::Flushed::part && !stopping_) return true;
    AccessRecord done = connection.take_answer().record;
    done.whole = flushed == HttpConnection::Flushed::whole;
    observer_(done);
    return keep && done.whole;
  }

  Response respond(const Request& request) {
    try {
      if (auto refused = guard(request, options_.guard)) return *std::move(refused);
      return handler_(request);
    } catch (const std::exception& error) {
      return problem_response(ProblemType::internal, error.what());
    }
  }

  /// Size of a body or file that is sent from a thread of its own; 0 for one that is not.
  static std::uintmax_t long_bytes(const Response& response) {
    std::error_code missing;
    const std::uintmax_t bytes =
        response.file ? std::filesystem::file_size(*response.file, missing) : response.body.size();
    return bytes <= kSmallAnswer || missing ? 0 : bytes;
  }

  /// A share of the memory and the threads for long answers. Without one left, the client that has
  /// taken nothing for longest makes room; where none stalls, the answer becomes a refusal.
  std::shared_ptr<void> take_place(Response& response, int socket, const SocketSink& sink) {
    const auto least = options_.large_bytes / options_.large_answers;
    const auto share = std::max(least, static_cast<std::int64_t>(response.body.size()));
    auto place = large_.try_take(share);
    while (!place && cut_longest_stalled()) place = large_.try_take(share, kMayStall);
    if (place) {
      const std::scoped_lock lock(mutex_);
      long_.push_back({socket, &sink});
    } else {
      response = problem_response(ProblemType::overloaded,
                                  "too many large answers are being sent: try again in a second");
      response.headers.emplace_back("Retry-After", "1");
    }
    return place;
  }

  bool cut_longest_stalled() {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::max_element(
        long_, {}, [](const LongAnswer& one) { return one.sink->stalled_for(); });
    if (found == long_.end() || found->sink->stalled_for() < kMayStall) return false;
    ::shutdown(found->socket, SHUT_RDWR);
    long_.erase(found);
    return true;
  }

  void forget_long(const SocketSink& sink) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(long_, [&](const LongAnswer& one) { return one.sink == &sink; });
  }

  void finish_work() {
    std::unique_lock lock(mutex_);
    const auto idle = [this] {
      return common_.queue.empty() && apart_.queue.empty() && busy_.empty();
    };
    work_done_.wait_for(lock, std::chrono::duration<double>(kGraceSeconds), idle);
    common_.queue.clear();
    apart_.queue.clear();
    for (const int socket : busy_) ::shutdown(socket, SHUT_RDWR);
    quit_ = true;
    common_.work_there.notify_all();
    apart_.work_there.notify_all();
    work_done_.wait(lock, idle);
  }

  const HttpOptions options_;
  const Handler handler_;
  const Observer observer_;
  Slots large_;
  std::atomic<bool> stopping_ = false;

  std::mutex mutex_;
  std::condition_variable work_done_;
  Lane common_;
  Lane apart_;
  std::vector<LongAnswer> long_;  ///< that are being sent
  std::vector<int> busy_;         ///< sockets that are being answered
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

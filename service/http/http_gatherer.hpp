#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "service/http/http_connection.hpp"
#include "service/http/http_server.hpp"
#include "service/http/http_socket.hpp"

namespace sluice {

/// Accepts connections and gathers their requests in one thread, so that slow and silent clients
/// cost no other. A connection whose request is whole is handed out with it, and comes back when it
/// is answered, or with an answer in memory that its client has yet to take: that is sent from here
/// too, so a client that does not read costs no other thread either.
class HttpGatherer {
 public:
  using Connection = std::unique_ptr<HttpConnection>;
  /// Takes a whole request; called from the gathering thread, so it must not wait.
  using Taker = std::function<void(Connection, HttpConnection::Whole)>;

  /// Listens and gathers from here on. `observer` is told of requests that are answered here
  /// because they never become whole, and of answers whose sending ended here. Throws
  /// std::runtime_error.
  HttpGatherer(const HttpOptions& options, Taker taker, HttpServer::Observer observer);
  ~HttpGatherer();
  HttpGatherer(const HttpGatherer&) = delete;
  HttpGatherer& operator=(const HttpGatherer&) = delete;

  [[nodiscard]] int port() const { return listener_.port; }
  /// Takes an answered connection back, from any thread. One that lingers is closed soon.
  void give_back(Connection connection);
  /// Closes the listening socket and all connections that wait. Idempotent; not for two threads at
  /// once.
  void stop();

 private:
  using Clock = HttpConnection::Clock;
  using Place = std::map<int, Connection>::iterator;

  /// Waits for what the client sends, or for room for what it is sent.
  enum class Wanted { bytes, room };
  void watch(int descriptor, Wanted wanted = Wanted::bytes) const;
  void wake() const;
  void gather();
  void handle_event(int descriptor);
  void accept_all();
  void admit(Connection connection);
  void take_back();
  void follow(Place place, HttpConnection::Step step);
  void receive(Place place);
  void refuse(Place place, const Refusal& refusal);
  void send_on(Place place);
  void cut(Place place);
  void close_late(Clock::time_point now);
  void cut_beyond_memory();
  [[nodiscard]] Place longest_waiting();
  /// That of the address with the most connections, so that one who opens many closes his own.
  void make_room();
  [[nodiscard]] int open_connections() const;

  const HttpOptions options_;
  const Taker taker_;
  const HttpServer::Observer observer_;
  Listener listener_;
  const FileDescriptor poll_;
  const FileDescriptor wake_;
  std::map<int, Connection> waiting_;  ///< by socket; the gathering thread's
  int handed_out_ = 0;                 ///< the gathering thread's
  std::atomic<bool> stopping_ = false;

  std::mutex mutex_;
  std::vector<Connection> returned_;

  std::thread thread_;
};

}  // namespace sluice

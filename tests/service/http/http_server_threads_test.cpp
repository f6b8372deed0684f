#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <vector>

#include "service/http/http_server.hpp"
#include "service/http/problem.hpp"
#include "tests/service/api/api_support.hpp"
#include "tests/service/http/http_client.hpp"
#include "tests/sph/threads/few_threads.hpp"

namespace sluice::test {
namespace {

/// Says what it was asked: the path, or a long text, or a file, or a failure.
Response echo(const Request& request) {
  if (request.path == "/fail") throw std::runtime_error("on purpose");
  Response response;
  response.content_type = "text/plain";
  response.body = request.method + " " + request.path + " " + request.body;
  if (request.path == "/medium") response.body.assign(5'000, 'x');
  if (request.path == "/long") response.body.assign(100'000, 'x');
  if (request.path == "/huge") response.body.assign(12U << 20U, 'x');
  if (request.path == "/gone") response.file = "/nonexistent/file";
  return response;
}

HttpOptions quick_options() {
  HttpOptions options;
  options.port = 0;
  options.threads = 4;
  options.arrival_seconds = 0.3;
  options.idle_seconds = 30;
  options.stall_seconds = 0.3;
  return options;
}

struct Server {
  explicit Server(const HttpOptions& options = quick_options(), HttpServer::Handler handler = &echo)
      : http(options, std::move(handler), [this](const AccessRecord& record) {
          const std::scoped_lock lock(mutex);
          records.push_back(record);
        }) {}
  [[nodiscard]] std::string ask(std::string_view text) const { return exchange(http.port(), text); }
  std::vector<AccessRecord> seen() {
    const std::scoped_lock lock(mutex);
    return records;
  }

  std::mutex mutex;
  std::vector<AccessRecord> records;
  HttpServer http;
};

std::string get(std::string_view path, std::string_view headers = "") {
  return "GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n" + std::string(headers) +
         "\r\n";
}

std::string post(std::string_view body, std::string_view headers = "") {
  return "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\n" + std::string(headers) + "\r\n" + std::string(body);
}

void expect_refused(const std::string& answer, int status, std::string_view slug) {
  EXPECT_EQ(status_of(answer), status) << answer;
  EXPECT_TRUE(has_line(answer, "Content-Type: application/problem+json")) << answer;
  EXPECT_NE(answer.find("/problems/" + std::string(slug)), answer.npos) << answer;
  EXPECT_TRUE(has_line(answer, "Connection: close")) << answer;
}

TEST(HttpServerThreads, AnswersManyRequestsOnOneConnection) {
  Server server;
  RawClient client(server.http.port());
  for (int n = 0; n < 100; ++n) {
    const std::string body = std::to_string(n);
    client.send(post(body));
    const std::string answer = client.answer();
    ASSERT_EQ(status_of(answer), 200);
    ASSERT_EQ(text_of(answer), "POST / " + body);
  }
}

TEST(HttpServerThreads, SaysWhenItAnswered) {
  Server server;
  const std::string answer = server.ask(get("/"));
  const std::size_t at = answer.find("\r\nDate: ");
  ASSERT_NE(at, answer.npos) << answer;
  std::tm utc{};
  std::istringstream(answer.substr(at + 8, 29)) >> std::get_time(&utc, "%a, %d %b %Y %H:%M:%S GMT");
  EXPECT_NEAR(static_cast<double>(::timegm(&utc)), static_cast<double>(std::time(nullptr)), 60.0);
}

TEST(HttpServerThreads, AnswersPipelinedRequestsInOrder) {
  Server server;
  RawClient client(server.http.port());
  client.send(get("/a") + post("body") + get("/b", "Connection: close\r\n"));
  EXPECT_EQ(text_of(client.answer()), "GET /a ");
  EXPECT_EQ(text_of(client.answer()), "POST / body");
  EXPECT_EQ(text_of(client.answer()), "GET /b ");
  EXPECT_EQ(client.rest(), "");
}

TEST(HttpServerThreads, TakesARequestByteByByte) {
  HttpOptions options = quick_options();
  options.arrival_seconds = 60;
  Server server(options);
  RawClient client(server.http.port());
  for (const char byte : post("hello")) ASSERT_TRUE(client.send({&byte, 1}));
  EXPECT_EQ(text_of(client.answer()), "POST / hello");
}

TEST(HttpServerThreads, AnswersAPostWithoutABody) {
  Server server;
  // The library alone waits for five seconds and answers 400.
  EXPECT_EQ(text_of(server.ask("POST / HTTP/1.1\r\nHost: localhost\r\n\r\n")), "POST / ");
}

TEST(HttpServerThreads, AsksForABodyThatTheClientHoldsBack) {
  Server server;
  RawClient client(server.http.port());
  client.send(
      "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n"
      "Expect: 100-continue\r\n\r\n");
  EXPECT_EQ(client.until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  client.send("hi");
  EXPECT_NE(client.until("POST / hi").find("200 OK"), std::string::npos);
}

TEST(HttpServerThreads, RefusesChunkedAndEncodedBodies) {
  Server server;
  expect_refused(server.ask("POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n"
                            "\r\nffffffff\r\n"),
                 501, "not-implemented");
  expect_refused(server.ask(post("x", "Content-Encoding: gzip\r\n")), 415,
                 "unsupported-media-type");
}

TEST(HttpServerThreads, RefusesEndlessHeadersWhileTheyArrive) {
  Server server;
  RawClient many(server.http.port());
  many.send("GET / HTTP/1.1\r\nHost: localhost\r\n");
  for (int n = 0; n < 200'000 && many.send("X-Header: 1\r\n"); ++n) {
  }
  expect_refused(many.answer(), 431, "headers-too-large");
  RawClient line(server.http.port());
  line.send("GET / HTTP/1.1\r\nHost: localhost\r\nX: ");
  const std::string part(10'000, 'x');
  for (int n = 0; n < 1000 && line.send(part); ++n) {
  }
  expect_refused(line.answer(), 431, "headers-too-large");
  RawClient target(server.http.port());
  target.send("GET /");
  for (int n = 0; n < 1000 && target.send(part); ++n) {
  }
  expect_refused(target.answer(), 414, "uri-too-long");
}

TEST(HttpServerThreads, RefusesLongBodiesBeforeTheyCome) {
  Server server;
  expect_refused(server.ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 262145\r\n\r\n"),
                 413, "body-too-large");
}

TEST(HttpServerThreads, RefusesRequestsThatArriveTooSlowly) {
  Server server;
  expect_refused(server.ask("GET / HTTP/1.1\r\nHost: local"), 408, "request-timeout");
  expect_refused(server.ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nab"),
                 408, "request-timeout");
}

TEST(HttpServerThreads, SilentClientsTakeNoThreads) {
  HttpOptions options = quick_options();
  options.arrival_seconds = 600;
  Server server(options);  // with 4 threads
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int n = 0; n < 64; ++n) {
    silent.push_back(std::make_unique<RawClient>(server.http.port()));
    silent.back()->send("GET / HTTP/1.1\r\nHost: lo");
  }
  EXPECT_EQ(text_of(server.ask(get("/alive"))), "GET /alive ");
}

TEST(HttpServerThreads, ClosesTheOneThatHasWaitedLongestWhenThereAreTooMany) {
  HttpOptions options = quick_options();
  options.arrival_seconds = 600;
  options.connections = 8;
  Server server(options);
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int n = 0; n < 40; ++n) {
    silent.push_back(std::make_unique<RawClient>(server.http.port()));
    silent.back()->send("G");
  }
  EXPECT_EQ(text_of(server.ask(get("/alive"))), "GET /alive ");
  EXPECT_EQ(silent.front()->rest(), "") << "closed";
}

TEST(HttpServerThreads, OneAddressWithManyConnectionsClosesItsOwn) {
  HttpOptions options = quick_options();
  options.arrival_seconds = 600;
  options.connections = 8;
  Server server(options);
  RawClient alone(server.http.port());
  alone.send("GET /alone HTTP/1.1\r\nHost: localhost\r\n");
  std::vector<std::unique_ptr<RawClient>> crowd;
  for (int n = 0; n < 40; ++n) {
    crowd.push_back(std::make_unique<RawClient>(server.http.port(), "127.0.0.2"));
    crowd.back()->send("G");
  }
  EXPECT_EQ(crowd.front()->rest(), "") << "closed";
  alone.send("Connection: close\r\n\r\n");
  EXPECT_EQ(text_of(alone.rest()), "GET /alone ") << "who has waited longest, but alone";
}

TEST(HttpServerThreads, GivesUpOnClientsThatDoNotTakeTheirAnswer) {
  Server server;
  RawClient client(server.http.port());
  client.take_little();
  client.send(get("/huge"));
  wait_until("the server to give up", [&] { return !server.seen().empty(); });
  EXPECT_FALSE(server.seen().front().whole);
}

TEST(HttpServerThreads, ClientsThatNeverReadHoldNobody) {
  HttpOptions options = quick_options();  // 4 threads
  options.stall_seconds = 600;
  Server server(options);
  std::vector<std::unique_ptr<RawClient>> stalled;
  std::string many;
  for (int n = 0; n < 40; ++n) many += get("/long");
  for (int n = 0; n < 40; ++n) {
    stalled.push_back(std::make_unique<RawClient>(server.http.port()));
    stalled.back()->take_little();
    stalled.back()->send(many);
  }
  for (int n = 0; n < 20; ++n) EXPECT_EQ(text_of(server.ask(get("/alive"))), "GET /alive ");
  EXPECT_EQ(text_of(server.ask(get("/long"))).size(), 100'000U);
}

TEST(HttpServerThreads, AnAnswerThatIsTakenLateIsWhole) {
  constexpr int kMany = 120;
  HttpOptions options = quick_options();
  options.stall_seconds = 600;
  Server server(options);
  RawClient client(server.http.port());
  // More than both ends' buffers take.
  for (int n = 0; n < kMany; ++n) client.send(get("/long"));
  client.send(get("/last", "Connection: close\r\n"));
  (void)server.ask(get("/alive"));
  for (int n = 0; n < kMany; ++n) ASSERT_EQ(text_of(client.answer()), std::string(100'000, 'x'));
  EXPECT_EQ(text_of(client.answer()), "GET /last ");
  EXPECT_EQ(client.rest(), "");
  for (const AccessRecord& record : server.seen()) EXPECT_TRUE(record.whole);
}

TEST(HttpServerThreads, WhatClientsDoNotTakeIsBoundedInTimeAndMemory) {
  HttpOptions options = quick_options();
  std::string many;
  for (int n = 0; n < 300; ++n) many += get("/medium");
  const auto cut = [&](Server& server) {
    return std::ranges::any_of(server.seen(), [](const AccessRecord& one) { return !one.whole; });
  };
  {
    Server server(options);
    RawClient client(server.http.port());
    client.take_little();
    client.send(many);
    wait_until("the client to be cut off", [&] { return cut(server); });
  }
  options.stall_seconds = 600;
  options.unsent_bytes = 12'000;  // of two clients
  Server server(options);
  std::vector<std::unique_ptr<RawClient>> stalled;
  for (int n = 0; n < 8; ++n) {
    stalled.push_back(std::make_unique<RawClient>(server.http.port()));
    stalled.back()->take_little();
    stalled.back()->send(many);
  }
  wait_until("one to make room", [&] { return cut(server); });
}

TEST(HttpServerThreads, HealthIsAnsweredWhenAllThreadsAreTaken) {
  std::atomic<bool> release = false;
  std::atomic<int> held = 0;
  Server server(quick_options(), [&](const Request& request) {
    if (request.path == "/hold") {
      ++held;
      while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return echo(request);
  });
  std::vector<std::unique_ptr<RawClient>> holding;
  for (int n = 0; n < 8; ++n) {
    holding.push_back(std::make_unique<RawClient>(server.http.port()));
    holding.back()->send(get("/hold"));
  }
  wait_until("all threads to be taken", [&] { return held == 4; });
  for (const char* const path : {"/livez", "/readyz"}) {
    EXPECT_EQ(status_of(server.ask(get(path))), 200) << path;
  }
  release = true;
}

TEST(HttpServerThreads, ALongAnswerThatStallsMakesRoomForAnother) {
  HttpOptions options = quick_options();
  options.large_answers = 2;
  options.stall_seconds = 600;
  Server server(options);
  std::vector<std::unique_ptr<RawClient>> stalled;
  for (int n = 0; n < 2; ++n) {
    stalled.push_back(std::make_unique<RawClient>(server.http.port()));
    stalled.back()->take_little();
    stalled.back()->send(get("/huge"));
    (void)stalled.back()->until("200 OK");
  }
  wait_until("a place", [&] { return status_of(server.ask(get("/huge"))) == 200; });
}

TEST(HttpServerThreads, LimitsLargeAnswersSoThatShortOnesHaveThreads) {
  HttpOptions options = quick_options();
  options.large_answers = 2;
  options.stall_seconds = 600;
  Server server(options);
  std::vector<std::unique_ptr<RawClient>> stalled;
  for (int n = 0; n < 2; ++n) {
    stalled.push_back(std::make_unique<RawClient>(server.http.port()));
    stalled.back()->take_little();
    stalled.back()->send(get("/huge"));
    (void)stalled.back()->until("200 OK");
  }
  EXPECT_EQ(status_of(server.ask(get("/huge"))), 503);
  EXPECT_EQ(text_of(server.ask(get("/alive"))), "GET /alive ");
}

TEST(HttpServerThreads, CompressesOnlyForThoseWhoTakeIt) {
  Server server;
  const std::string plain = server.ask(get("/long"));
  EXPECT_TRUE(has_line(plain, "Content-Length: 100000"));
  EXPECT_TRUE(has_line(plain, "Vary: Accept-Encoding"));
  const std::string packed = server.ask(get("/long", "Accept-Encoding: br, gzip\r\n"));
  EXPECT_TRUE(has_line(packed, "Content-Encoding: gzip")) << packed.substr(0, 400);
  EXPECT_LT(packed.size(), 10'000U);
  const std::string brotli = server.ask(get("/long", "Accept-Encoding: br\r\n"));
  EXPECT_TRUE(has_line(brotli, "Content-Length: 100000"));
  EXPECT_FALSE(
      has_line(server.ask(get("/short", "Accept-Encoding: gzip\r\n")), "Content-Encoding: gzip"));
}

TEST(HttpServerThreads, SendsFilesWholeInPartAndNotAgain) {
  const DataFolder data;
  std::string content;
  for (int n = 0; n < 30'000; ++n) content += std::to_string(n) + ",";
  write_file(data.path() / "file", content);
  const auto path = data.path() / "file";
  Server server(quick_options(), [path](const Request&) {
    Response response;
    response.content_type = "application/x-hdf5";
    response.file = path;
    return response;
  });
  const std::string whole = server.ask(get("/"));
  EXPECT_EQ(text_of(whole), content);
  EXPECT_TRUE(has_line(whole, "Accept-Ranges: bytes"));
  const std::size_t at = whole.find("ETag: ") + 6;
  const std::string tag = whole.substr(at, whole.find('\r', at) - at);
  EXPECT_EQ(tag.front(), '"') << "a strong one";

  const std::string part = server.ask(get("/", "Range: bytes=1000-1999\r\n"));
  EXPECT_EQ(status_of(part), 206);
  EXPECT_EQ(text_of(part), content.substr(1000, 1000));
  EXPECT_TRUE(has_line(part, "Content-Range: bytes 1000-1999/" + std::to_string(content.size())));

  EXPECT_EQ(status_of(server.ask(get("/", "If-None-Match: " + tag + "\r\n"))), 304);
  EXPECT_EQ(status_of(server.ask(get("/", "Range: bytes=0-1\r\nIf-Range: " + tag + "\r\n"))), 206);
  EXPECT_EQ(status_of(server.ask(get("/", "Range: bytes=0-1\r\nIf-Range: \"old\"\r\n"))), 200);

  const std::string past = server.ask(get("/", "Range: bytes=99999999-\r\n"));
  EXPECT_EQ(status_of(past), 416);
  EXPECT_TRUE(has_line(past, "Content-Range: bytes */" + std::to_string(content.size())));
  std::string ranges = "Range: bytes=0-0";
  for (int n = 0; n < 1300; ++n) ranges += ",0-0";
  EXPECT_EQ(status_of(server.ask(get("/", ranges + "\r\n"))), 416);

  const std::string head = server.ask(
      "HEAD / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
      "\r\n");
  EXPECT_TRUE(has_line(head, "Content-Length: " + std::to_string(content.size())));
  EXPECT_EQ(text_of(head), "");
  std::filesystem::remove(path);
  EXPECT_EQ(status_of(server.ask(get("/"))), 404);
}

TEST(HttpServerThreads, RangeMeansNothingForOtherAnswers) {
  Server server;
  const std::string answer = server.ask(get("/long", "Range: bytes=0-1,2-3,4-5\r\n"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_TRUE(has_line(answer, "Content-Length: 100000"));
}

TEST(HttpServerThreads, StreamsUntilTheClientLeavesOrTheStreamEnds) {
  std::atomic<int> sent = 0;
  std::atomic<bool> end = false;
  Server server(quick_options(), [&](const Request&) {
    Response response;
    response.content_type = "text/event-stream";
    response.stream = [&](std::string& chunk) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      chunk = "data: " + std::to_string(++sent) + "\n\n";
      return !end;
    };
    return response;
  });
  {
    RawClient leaver(server.http.port());
    leaver.send(get("/"));
    EXPECT_NE(leaver.until("data: 3\n\n").find("data: 1\n\n"), std::string::npos);
  }
  wait_until("the server to notice", [&] { return !server.seen().empty(); });
  RawClient stayer(server.http.port());
  stayer.send(get("/", "Connection: close\r\n"));
  (void)stayer.until("data: ");
  end = true;
  EXPECT_TRUE(stayer.rest().ends_with("\r\n0\r\n\r\n"));
}

TEST(HttpServerThreads, AFailingHandlerIsAProblemNotACrash) {
  Server server;
  const std::string answer = server.ask(get("/fail"));
  EXPECT_EQ(status_of(answer), 500);
  EXPECT_NE(answer.find("/problems/internal"), answer.npos);
  EXPECT_EQ(status_of(server.ask(get("/gone"))), 404);
}

TEST(HttpServerThreads, WhatAClientSendsCannotForgeWhereItComesFrom) {
  Server server;
  EXPECT_EQ(status_of(server.ask(get("/", "REMOTE_ADDR: 10.0.0.1\r\nREMOTE_PORT: 1\r\n"))), 200);
  // The server notes it after the answer is sent.
  wait_until("the record", [&] { return !server.seen().empty(); });
  EXPECT_TRUE(server.seen().front().peer.starts_with("127.0.0.1:"));
}

TEST(HttpServerThreads, GuardsBeforeItAsksTheHandler) {
  HttpOptions options = quick_options();
  options.guard.token = "0123456789abcdef";
  std::atomic<int> asked = 0;
  Server server(options, [&](const Request& request) {
    ++asked;
    return echo(request);
  });
  EXPECT_EQ(status_of(server.ask(get("/"))), 401);
  EXPECT_EQ(status_of(server.ask("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n")), 403);
  EXPECT_EQ(status_of(server.ask(post("", "Origin: http://evil.example\r\n"))), 403);
  EXPECT_EQ(asked, 0);
  EXPECT_EQ(status_of(server.ask(get("/", "Authorization: Bearer 0123456789abcdef\r\n"))), 200);
}

TEST(HttpServerThreads, TwoServersDoNotShareAPort) {
  const Server server;
  HttpOptions options = quick_options();
  options.port = server.http.port();
  EXPECT_THROW(Server second(options), std::runtime_error);
}

TEST(HttpServerThreads, ListensForOtherMachinesOnlyWithAToken) {
  HttpOptions options = quick_options();
  options.host = "0.0.0.0";
  EXPECT_THROW(Server open(options), std::runtime_error);
  options.guard.token = "0123456789abcdef";
  EXPECT_NO_THROW(Server guarded(options));
  options.host = "no such host";
  EXPECT_THROW(Server none(options), std::runtime_error);
}

TEST(HttpServerThreads, StopsWhileClientsWaitAndStream) {
  auto server = std::make_unique<Server>(quick_options(), [](const Request& request) {
    Response response = echo(request);
    if (request.path == "/stream") {
      response.stream = [](std::string& chunk) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        chunk = "x";
        return true;
      };
    }
    return response;
  });
  RawClient idle(server->http.port());
  RawClient half(server->http.port());
  half.send("GET / HT");
  RawClient stream(server->http.port());
  stream.send(get("/stream"));
  (void)stream.until("x");
  const int port = server->http.port();
  server->http.stop();
  server->http.stop();
  EXPECT_EQ(idle.rest(), "");
  EXPECT_THROW(RawClient late(port), std::runtime_error);
  server.reset();
}

TEST(HttpServerThreads, SurvivesRandomBytes) {
  Server server;
  std::uint64_t state = 88172645463325252ULL;
  const auto random = [&state] {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    return state;
  };
  for (int round = 0; round < 200; ++round) {
    std::string bytes = round % 2 == 0 ? "" : post("body", "X: y\r\n");
    if (bytes.empty()) bytes.resize(random() % 300);
    for (int n = 0; n < 5 && !bytes.empty(); ++n) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    RawClient client(server.http.port());
    client.send(bytes);
  }
  EXPECT_EQ(text_of(server.ask(get("/alive"))), "GET /alive ");
}

TEST(HttpServerThreads, SaysSoWhenTheSystemRefusesAThreadAndEndsThoseThatRun) {
  if (!kThreadsCanBeRefused) GTEST_SKIP() << "sanitizers need the addresses themselves";
  const FewThreads few;
  HttpOptions options = quick_options();
  options.threads = 200;
  EXPECT_THROW(Server{options}, std::system_error);
}

}  // namespace
}  // namespace sluice::test

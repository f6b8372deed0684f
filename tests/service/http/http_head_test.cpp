#include "service/http/http_head.hpp"

#include <gtest/gtest.h>

#include <string>

#include "service/http/http_range.hpp"

namespace sluice::test {
namespace {

std::string head_with(const std::string& lines) {
  return "GET / HTTP/1.1\r\nHost: h\r\n" + lines + "\r\n";
}

ProblemType refusal_of(const std::string& head) {
  const auto parsed = parse_head(head, {});
  if (const auto* refusal = std::get_if<Refusal>(&parsed)) return refusal->type;
  ADD_FAILURE() << "taken: " << head;
  return ProblemType::internal;
}

RequestHead head_of(const std::string& head) {
  auto parsed = parse_head(head, {});
  if (const auto* refusal = std::get_if<Refusal>(&parsed)) {
    ADD_FAILURE() << refusal->detail;
    return {};
  }
  return std::get<RequestHead>(std::move(parsed));
}

TEST(HttpHead, ReadsMethodPathQueryHeadersAndLength) {
  const RequestHead head = head_of(
      "POST /v1/jobs?label=a%20b+c&x=&y HTTP/1.1\r\nHOST: h:1\r\nX-A:  1 \r\nX-A: 2\r\n"
      "Content-Length: 12\r\n\r\n");
  EXPECT_EQ(head.request.method, "POST");
  EXPECT_EQ(head.request.path, "/v1/jobs");
  const std::vector<std::pair<std::string, std::string>> query{
      {"label", "a b c"}, {"x", ""}, {"y", ""}};
  EXPECT_EQ(head.request.query, query);
  EXPECT_EQ(head.request.header("host"), "h:1");
  EXPECT_EQ(head.request.header("x-a"), "1, 2");
  EXPECT_EQ(head.body_bytes, 12U);
  EXPECT_TRUE(head.keep_alive);
}

TEST(HttpHead, ClosesAfterHttp10AndWhenAsked) {
  EXPECT_FALSE(head_of("GET / HTTP/1.0\r\n\r\n").keep_alive);
  EXPECT_FALSE(head_of(head_with("Connection: Close\r\n")).keep_alive);
}

TEST(HttpHead, RefusesWhatTwoReadersCouldReadDifferently) {
  for (const char* const lines :
       {"Host: other\r\n", "Content-Length: 1\r\nContent-Length: 1\r\n", "Content-Length: +1\r\n",
        "Content-Length: 1, 1\r\n", "Content-Length: \r\n", "X-A : 1\r\n", " folded: 1\r\n",
        "X-A: 1\r\n folded\r\n", "no colon\r\n", ": 1\r\n", "X-A: \x01\r\n", "X-A: a\rb\r\n",
        "Expect: 200-ok\r\n"}) {
    EXPECT_EQ(refusal_of(head_with(lines)), ProblemType::bad_request) << lines;
  }
  EXPECT_EQ(refusal_of(head_with(std::string("X-A: a\0b\r\n", 10))), ProblemType::bad_request);
  EXPECT_EQ(refusal_of("GET / HTTP/1.1\r\n\r\n"), ProblemType::bad_request) << "no Host";
}

TEST(HttpHead, ReadsTheFormsOfATargetThatRfc9112Names) {
  const RequestHead whole =
      head_of("GET HTTP://evil.example:81/v1/jobs?limit=2 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(whole.request.path, "/v1/jobs");
  EXPECT_EQ(whole.request.query.size(), 1U);
  EXPECT_EQ(whole.request.header("host"), "evil.example:81") << "the target's counts";
  EXPECT_EQ(head_of("GET https://h HTTP/1.1\r\nHost: h\r\n\r\n").request.path, "/");
  EXPECT_EQ(head_of("OPTIONS * HTTP/1.1\r\nHost: h\r\n\r\n").request.path, "*");
}

TEST(HttpHead, RefusesRequestLinesThatAreNone) {
  for (const char* const line : {"GET /",
                                 "GET",
                                 "",
                                 "GET  HTTP/1.1",
                                 "GET / HTTP/2.0",
                                 "GET / HTTP/1.1 ",
                                 "G@T / HTTP/1.1",
                                 "GET ftp://h/ HTTP/1.1",
                                 "GET http:///a HTTP/1.1",
                                 "GET http://me@h/ HTTP/1.1",
                                 "GET http://h?a=1 HTTP/1.1",
                                 "GET http:/a HTTP/1.1",
                                 "GET * HTTP/1.1",
                                 "OPTIONS *a HTTP/1.1",
                                 "GET /a b HTTP/1.1",
                                 "GET /\x80 HTTP/1.1",
                                 "GET /a#b HTTP/1.1",
                                 "GET http://h/?a=1#b HTTP/1.1",
                                 "GET /%zz HTTP/1.1",
                                 "GET /%2 HTTP/1.1",
                                 "GET /%00 HTTP/1.1",
                                 "GET /?a=%0 HTTP/1.1",
                                 "AVERYLONGMETHODTHATISNONE / HTTP/1.1"}) {
    EXPECT_EQ(refusal_of(std::string(line) + "\r\nHost: h\r\n\r\n"), ProblemType::bad_request)
        << line;
  }
}

TEST(HttpHead, RefusesCodedBodiesLongBodiesAndLongTargets) {
  EXPECT_EQ(refusal_of(head_with("Transfer-Encoding: chunked\r\n")), ProblemType::not_implemented);
  EXPECT_EQ(refusal_of(head_with("Content-Encoding: gzip\r\n")),
            ProblemType::unsupported_media_type);
  EXPECT_EQ(refusal_of(head_with("Content-Length: 262145\r\n")), ProblemType::body_too_large);
  EXPECT_EQ(refusal_of(head_with("Content-Length: 99999999999999999999999\r\n")),
            ProblemType::body_too_large);
  EXPECT_EQ(head_of(head_with("Content-Length: 262144\r\n")).body_bytes, 262144U);
  EXPECT_EQ(refusal_of("GET /" + std::string(8192, 'a') + " HTTP/1.1\r\nHost: h\r\n\r\n"),
            ProblemType::uri_too_long);
}

TEST(HttpHead, TakesALongBodyOnlyForAFormWhereOneIsExpected) {
  const auto with = [](const std::string& line, const std::string& type, std::size_t bytes) {
    return line + " HTTP/1.1\r\nHost: h\r\nContent-Type: " + type +
           "\r\nContent-Length: " + std::to_string(bytes) + "\r\n\r\n";
  };
  const std::string form = "multipart/form-data; boundary=x";
  const HttpLimits limits;
  EXPECT_EQ(head_of(with("POST /v1/jobs?label=a", form, limits.upload_bytes)).body_bytes,
            limits.upload_bytes);
  for (const std::string& head :
       {with("POST /v1/jobs", form, limits.upload_bytes + 1),
        with("POST /v1/jobs", "application/json", 300'000), with("POST /v1/studies", form, 300'000),
        with("PUT /v1/jobs", form, 300'000)}) {
    EXPECT_EQ(refusal_of(head), ProblemType::body_too_large) << head;
  }
}

TEST(HttpHead, CountsHeaderLinesAndParameters) {
  std::string lines;
  for (int n = 0; n < 99; ++n) lines += "X: 1\r\n";
  EXPECT_EQ(head_of(head_with(lines)).request.headers.size(), 2U);
  EXPECT_EQ(refusal_of(head_with(lines + "X: 1\r\n")), ProblemType::headers_too_large);
  std::string query = "/?";
  for (int n = 0; n < 51; ++n) query += "a=1&";
  EXPECT_EQ(refusal_of("GET " + query + " HTTP/1.1\r\nHost: h\r\n\r\n"), ProblemType::bad_request);
}

TEST(HttpHead, FindsTheEndOrSeesAtOnceThatThereIsNone) {
  const std::string head = head_with("");
  for (std::size_t n = 0; n < head.size(); ++n) {
    EXPECT_TRUE(std::holds_alternative<std::monostate>(find_head_end(head.substr(0, n), {}))) << n;
  }
  const auto found = find_head_end(head + "body\n", {});
  ASSERT_TRUE(std::holds_alternative<HeadEnd>(found));
  EXPECT_EQ(std::get<HeadEnd>(found).bytes, head.size());
  const auto type = [](const std::string& text) {
    const auto result = find_head_end(text, {});
    const auto* refusal = std::get_if<Refusal>(&result);
    return refusal == nullptr ? ProblemType::internal : refusal->type;
  };
  EXPECT_EQ(type("GET / HTTP/1.1\n"), ProblemType::bad_request);
  EXPECT_EQ(type("GET /" + std::string(20'000, 'a')), ProblemType::uri_too_long);
  EXPECT_EQ(type(head_with("X: " + std::string(20'000, 'a'))), ProblemType::headers_too_large);
}

struct RangeCase {
  const char* header;
  std::uint64_t first;
  std::uint64_t count;
};

TEST(HttpRange, ReadsOneRangeOfAFileOfTenBytes) {
  for (const RangeCase& one : {RangeCase{"bytes=0-3", 0, 4}, RangeCase{"bytes=8-", 8, 2},
                               RangeCase{"bytes=-3", 7, 3}, RangeCase{"bytes=5-999", 5, 5},
                               RangeCase{"bytes=-999", 0, 10}, RangeCase{"bytes=9-9", 9, 1}}) {
    const auto range = read_range(one.header, 10);
    const auto* part = std::get_if<ByteRange>(&range);
    ASSERT_NE(part, nullptr) << one.header;
    EXPECT_EQ(part->first, one.first) << one.header;
    EXPECT_EQ(part->count, one.count) << one.header;
  }
}

TEST(HttpRange, TellsBrokenHeadersFromRangesThatAreNotThere) {
  for (const char* const header : {"", "lines=0-3", "bytes=", "bytes=a-b", "bytes=5-2", "bytes=--1",
                                   "bytes=-", "bytes=0-3x", "bytes= 0-3"}) {
    EXPECT_TRUE(std::holds_alternative<WholeFile>(read_range(header, 10))) << header;
  }
  for (const char* const header :
       {"bytes=10-", "bytes=99999999999999999999-", "bytes=-0", "bytes=0-1,3-4"}) {
    EXPECT_TRUE(std::holds_alternative<NoSuchRange>(read_range(header, 10))) << header;
  }
  EXPECT_TRUE(std::holds_alternative<NoSuchRange>(read_range("bytes=-5", 0)));
}

}  // namespace
}  // namespace sluice::test

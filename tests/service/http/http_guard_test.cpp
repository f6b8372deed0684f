#include "service/http/http_guard.hpp"

#include <filesystem>
#include <stdexcept>

#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

Response refusal(const Request& request, const GuardOptions& options = {}) {
  const auto response = guard(request, options);
  EXPECT_TRUE(response) << request.path;
  return response.value_or(Response{});
}

Request with(std::string_view method, std::map<std::string, std::string> headers) {
  Request request{std::string(method), "/v1/jobs", {}, std::move(headers), ""};
  return request;
}

TEST(HttpGuard, TakesAddressesLocalhostAndNamesThatWereAllowed) {
  GuardOptions options;
  options.host_names = {"Sluice.example.org"};
  for (const char* const host :
       {"localhost", "localhost:8080", "127.0.0.1:1", "[::1]:8080", "192.168.1.7",
        "sluice.example.org", "sluice.example.org:443", "LocalHost", "SLUICE.Example.ORG:443"}) {
    EXPECT_FALSE(guard(with("POST", {{"host", host}}), options)) << host;
  }
  for (const char* const host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil.example",
                                 "", "[::1", "sluice.example.org.evil"}) {
    expect_problem(refusal(with("GET", {{"host", host}}), options), 403, "forbidden-host");
  }
}

TEST(HttpGuard, TakesChangesFromItsOwnPagesAndFromPrograms) {
  EXPECT_FALSE(
      guard(with("POST", {{"host", "localhost:1"}, {"origin", "http://localhost:1"}}), {}));
  EXPECT_FALSE(
      guard(with("POST", {{"host", "LOCALHOST:1"}, {"origin", "http://localhost:1"}}), {}));
  EXPECT_FALSE(guard(with("POST", {{"host", "localhost:1"}}), {}));
  for (const char* const origin :
       {"http://evil.example", "null", "http://localhost:2", "http://localhost", ""}) {
    const Request request = with("POST", {{"host", "localhost:1"}, {"origin", origin}});
    expect_problem(refusal(request), 403, "forbidden-origin");
  }
  const Request cross = with("DELETE", {{"host", "localhost"}, {"sec-fetch-site", "cross-site"}});
  expect_problem(refusal(cross), 403, "forbidden-origin");
  EXPECT_FALSE(guard(with("GET", {{"host", "localhost"}, {"origin", "http://evil.example"}}), {}));
}

TEST(HttpGuard, AsksForTheTokenEverywhereButForHealth) {
  GuardOptions options;
  options.token = "0123456789abcdef";
  for (const char* const value :
       {"", "0123456789abcdef", "Bearer ", "Bearer 0123456789abcde", "Bearer 0123456789abcdef0",
        "Basic 0123456789abcdef", "Bearer 0123456789abcdef0123456789abcdef"}) {
    const Response response =
        refusal(with("GET", {{"host", "localhost"}, {"authorization", value}}), options);
    expect_problem(response, 401, "unauthorized");
    EXPECT_NE(header_of(response, "WWW-Authenticate"), "");
  }
  EXPECT_FALSE(guard(
      with("GET", {{"host", "localhost"}, {"authorization", "Bearer 0123456789abcdef"}}), options));
  Request health = with("GET", {{"host", "localhost"}});
  health.path = "/readyz";
  EXPECT_FALSE(guard(health, options));
}

TEST(HttpGuard, ComparesWholeTexts) {
  EXPECT_TRUE(equal_in_constant_time("secret", "secret"));
  EXPECT_FALSE(equal_in_constant_time("secre", "secret"));
  EXPECT_FALSE(equal_in_constant_time("secretsecret", "secret"));
  EXPECT_FALSE(equal_in_constant_time("", "secret"));
  EXPECT_FALSE(equal_in_constant_time("Secret", "secret"));
}

TEST(HttpGuard, ReadsACredentialOfSystemdThatAnAccessListOpensToTheService) {
  const DataFolder data;
  const fs::path path = data.path() / "token";
  write_file(path, "0123456789abcdef\n");
  fs::permissions(path, fs::perms::owner_read | fs::perms::group_read);
  ASSERT_EQ(::setenv("CREDENTIALS_DIRECTORY", data.path().c_str(), 1), 0);
  EXPECT_EQ(read_token_file(path), "0123456789abcdef");
  fs::permissions(path, fs::perms::others_read, fs::perm_options::add);
  EXPECT_THROW((void)read_token_file(path), std::runtime_error);
  fs::permissions(path, fs::perms::others_read, fs::perm_options::remove);
  ASSERT_EQ(::setenv("CREDENTIALS_DIRECTORY", "/elsewhere", 1), 0);
  EXPECT_THROW((void)read_token_file(path), std::runtime_error);
  ::unsetenv("CREDENTIALS_DIRECTORY");
}

TEST(HttpGuard, ReadsTokensOnlyFromFilesThatNobodyElseCanRead) {
  const DataFolder data;
  const fs::path path = data.path() / "token";
  write_file(path, "0123456789abcdef\n");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(read_token_file(path), "0123456789abcdef");
  fs::permissions(path, fs::perms::group_read, fs::perm_options::add);
  EXPECT_THROW((void)read_token_file(path), std::runtime_error);
  fs::permissions(path, fs::perms::group_read, fs::perm_options::remove);
  write_file(path, "short\n");
  EXPECT_THROW((void)read_token_file(path), std::runtime_error);
  write_file(path, "two words are no token\n");
  EXPECT_THROW((void)read_token_file(path), std::runtime_error);
  EXPECT_THROW((void)read_token_file(data.path()), std::runtime_error);
  fs::create_symlink(path, data.path() / "link");
  EXPECT_THROW((void)read_token_file(data.path() / "link"), std::runtime_error);
  EXPECT_THROW((void)read_token_file(data.path() / "none"), std::runtime_error);
}

}  // namespace
}  // namespace sluice::test

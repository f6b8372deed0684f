#include "service/http/http_guard.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "engine/store/disk/file_system.hpp"
#include "service/http/http_head.hpp"
#include "service/http/problem.hpp"

namespace sluice {
namespace {

constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestToken = 512;

/// The Host header's value without its port.
std::string_view host_name(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == host.npos ? host : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

bool is_address(const std::string& name) {
  std::array<unsigned char, 16> bytes{};
  return inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

bool is_allowed_host(std::string_view host, const GuardOptions& options) {
  const std::string name = lower(host_name(host));
  return name == "localhost" || is_address(name) ||
         std::ranges::find(options.host_names, name, lower) != options.host_names.end();
}

bool changes(const Request& request) {
  return request.method != "GET" && request.method != "HEAD" && request.method != "OPTIONS";
}

/// A browser sends Origin with every changing request of a page; programs send none.
bool is_foreign_page(const Request& request) {
  const std::string_view site = request.header("sec-fetch-site");
  if (!site.empty() && site != "same-origin" && site != "none") return true;
  const auto origin = request.headers.find("origin");
  if (origin == request.headers.end()) return false;
  // Browsers write both in small letters, but a Host may come from elsewhere.
  const std::string host = lower(request.header("host"));
  const std::string page = lower(origin->second);
  return page != "http://" + host && page != "https://" + host;
}

bool has_token(const Request& request, const std::string& token) {
  constexpr std::string_view kScheme = "Bearer ";
  const std::string_view value = request.header("authorization");
  return value.starts_with(kScheme) && equal_in_constant_time(value.substr(kScheme.size()), token);
}

/// systemd opens the folder of a service's credentials to that service alone, and may let it read
/// them by an access list, which shows as the group's bit.
mode_t forbidden_bits(const std::filesystem::path& path) {
  const char* const credentials = std::getenv("CREDENTIALS_DIRECTORY");
  const bool from_systemd = credentials != nullptr && path.parent_path() == credentials;
  return from_systemd ? 037U : 077U;
}

[[noreturn]] void refuse_token(const std::filesystem::path& path, std::string_view why) {
  throw std::runtime_error(fmt::format("token file {}: {}", path.string(), why));
}

/// Only where nothing is that the command could overwrite.
std::string advice_to_make(const std::filesystem::path& path, int error_number) {
  if (error_number != ENOENT) return {};
  return fmt::format("; make one with: (umask 077; openssl rand -hex 32 > {})", path.string());
}

}  // namespace

bool equal_in_constant_time(std::string_view given, std::string_view secret) {
  std::size_t difference = given.size() ^ secret.size();
  for (std::size_t n = 0; n < given.size(); ++n) {
    const char other = secret.empty() ? '\0' : secret[n % secret.size()];
    const volatile auto bits = static_cast<unsigned char>(given[n] ^ other);
    difference |= bits;
  }
  return difference == 0;
}

std::optional<Response> guard(const Request& request, const GuardOptions& options) {
  const std::string_view host = request.header("host");
  // HTTP/1.0 has no Host; browsers always send one.
  if (request.headers.contains("host") && !is_allowed_host(host, options)) {
    return problem_response(ProblemType::forbidden_host,
                            "the Host header names neither an address nor localhost nor a name "
                            "given with --allow-host");
  }
  if (changes(request) && is_foreign_page(request)) {
    return problem_response(ProblemType::forbidden_origin,
                            "a page of another origin may not change anything here");
  }
  const bool open = request.path == "/livez" || request.path == "/readyz";
  if (options.token.empty() || open || has_token(request, options.token)) return std::nullopt;
  Response response = problem_response(ProblemType::unauthorized, "");
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"sluice\"");
  return response;
}

std::string read_token_file(const std::filesystem::path& path) {
  const FileDescriptor file(
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY));
  if (file.get() < 0) {
    const int reason = errno;
    refuse_token(path, std::strerror(reason) + advice_to_make(path, reason));
  }
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    refuse_token(path, "it is no regular file");
  }
  if ((status.st_mode & forbidden_bits(path)) != 0)
    refuse_token(path, "others may read it: chmod 600, and another token if they have");
  std::array<char, kLongestToken + 2> bytes{};
  const auto count = ::read(file.get(), bytes.data(), bytes.size());
  std::string token(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  const bool plain = std::ranges::all_of(token, [](char c) { return c > 0x20 && c < 0x7F; });
  if (token.size() < kShortestToken || token.size() > kLongestToken || !plain) {
    refuse_token(path, "it must hold one line of 16 to 512 printable characters");
  }
  return token;
}

}  // namespace sluice

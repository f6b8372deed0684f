#include "cli/client/service_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>

#include "cli/json_text.hpp"
#include "cli/problem_text.hpp"
#include "cli/shell_word.hpp"
#include "cli/verbs.hpp"
#include "engine/run/stopwatch.hpp"
#include "service/http/http_guard.hpp"
#include "service/jobs/job_ids.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kServerVariable = "SLUICE_SERVER";
constexpr const char* kTokenVariable = "SLUICE_TOKEN_FILE";
constexpr double kFirstPause = 0.25;  // s
constexpr double kLongestPause = 5.0;

ServerAddress address_of(const ServiceOptions& options) {
  try {
    return parse_address(options.server);
  } catch (const std::invalid_argument& error) {
    throw CommandEnd(ExitCode::usage, error.what());
  }
}

std::string token_of(const ServiceOptions& options) {
  if (options.token_file.empty()) return {};
  try {
    return read_token_file(options.token_file);
  } catch (const std::runtime_error& error) {
    throw CommandEnd(ExitCode::usage, error.what());
  }
}

/// What the environment says, else `otherwise`.
std::string standing(const char* variable, const char* otherwise) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

/// One text for one server.
std::string without_slash(std::string address) {
  if (address.ends_with('/')) address.pop_back();
  return address;
}

/// Why an answer only says that there is no service at the moment; empty for any other.
std::string absence(const HttpReply& reply) {
  const bool absent = reply.status == 502 || reply.status == 504 ||
                      (reply.status == 503 && problem_slug(reply) != "queue-full");
  return absent ? fmt::format("the answer is {}", reply.status) : "";
}

void add_token_option(CLI::App& verb, ServiceOptions& options) {
  verb.add_option("--token-file", options.token_file, "File (mode 600) with the service's token")
      ->envname(kTokenVariable);
}

}  // namespace

void add_service_options(CLI::App& verb, ServiceOptions& options) {
  verb.add_option("--server", options.server, "Address of the service")
      ->envname(kServerVariable)
      ->capture_default_str();
  add_token_option(verb, options);
}

void add_service_switch(CLI::App& verb, ServiceOptions& options, bool& of_service) {
  verb.add_option_function<std::string>(
      "--server",
      [&options, &of_service](const std::string& server) {
        options.server = server;
        of_service = true;
      },
      "Address of the service whose job this is (SLUICE_SERVER, where no such file is here)");
  add_token_option(verb, options);
}

bool is_of_service(ServiceOptions& options, bool of_service, const std::string& word) {
  std::error_code ignored;
  if (of_service) return true;
  if (std::filesystem::exists(word, ignored)) return false;
  options.server = standing(kServerVariable, kDefaultServer);
  return !standing(kServerVariable, "").empty() || is_job_id(word) || is_study_id(word) ||
         word == "last";
}

Patience patience_on_stderr(double seconds, std::string last_words) {
  const auto say = [](const std::string& line) {
    std::fputs(fmt::format("sluice: {}\n", line).c_str(), stderr);
  };
  return {seconds, say, std::move(last_words)};
}

ServiceClient::ServiceClient(const ServiceOptions& options)
    : options_(options), http_(address_of(options), token_of(options)) {
  options_.server = without_slash(options_.server);
}

void ServiceClient::end_unreachable(const std::string& why, const std::string& advice) const {
  throw CommandEnd(ClientExit::unreachable,
                   fmt::format("cannot reach {}: {}; {}", options_.server, why, advice));
}

HttpReply ServiceClient::accept(HttpReply reply, const std::string& subject) const {
  const bool good = (reply.status >= 200 && reply.status < 300) || reply.status == 304;
  if (!good) end_with_problem(reply, {options_.server, subject, !options_.token_file.empty()});
  return reply;
}

HttpReply ServiceClient::ask(const HttpRequest& request, const std::string& subject) {
  try {
    return accept(http_.ask(request), subject);
  } catch (const NoReply& none) {
    end_unreachable(none.what(),
                    "start one with sluice serve --data DIR, or name its address with --server");
  }
}

HttpReply ServiceClient::get(const std::string& target) {
  HttpRequest request;
  request.target = target;
  return ask(request);
}

HttpReply ServiceClient::ask_patiently(const HttpRequest& request, const Patience& patience,
                                       const std::string& subject) {
  const Stopwatch clock;
  double pause = kFirstPause;
  for (bool told = false;; told = true) {
    std::string why;
    try {
      HttpReply reply = http_.ask(request);
      why = absence(reply);
      if (why.empty()) {
        if (told) patience.say(fmt::format("{} answers again", options_.server));
        return accept(std::move(reply), subject);
      }
    } catch (const NoReply& none) {
      why = none.what();
      const bool lasting =
          none.fault() == NoReply::Fault::untrusted || none.fault() == NoReply::Fault::too_large;
      if (lasting) end_unreachable(why, patience.last_words);
    }
    const double left = patience.seconds - clock.seconds();
    if (left <= 0.0) end_unreachable(why, patience.last_words);
    if (!told) {
      patience.say(fmt::format("cannot reach {}: {}; trying again for {:.0f} s", options_.server,
                               why, patience.seconds));
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(pause, left)));
    pause = std::min(2.0 * pause, kLongestPause);
  }
}

Json ServiceClient::object_of(const HttpReply& reply) const {
  Json value = Json::parse(reply.body, nullptr, /*allow_exceptions=*/false);
  if (value.is_object()) return value;
  throw CommandEnd(
      ClientExit::unreachable,
      fmt::format("{} answers, but not as a Sluice service does: see --server", options_.server));
}

std::string ServiceClient::token_words() const {
  const std::string path = options_.token_file.string();
  if (path == standing(kTokenVariable, "")) return {};
  return " --token-file " + shell_word(path);
}

std::string ServiceClient::command(std::string_view words) const {
  const bool standard = options_.server == without_slash(standing(kServerVariable, kDefaultServer));
  return fmt::format("sluice {}{}{}", words,
                     standard ? "" : " --server " + shell_word(options_.server), token_words());
}

std::string job_target(const std::string& id, std::string_view rest) {
  if (is_job_id(id)) return fmt::format("/v1/jobs/{}{}", id, rest);
  throw CommandEnd(ClientExit::not_found,
                   fmt::format("\"{}\" is no job's id, which is the letter j and 20 characters of "
                               "0-9 and a-v, nor the beginning of one, nor last: see sluice list",
                               printable(id)));
}

void print_body(const HttpReply& reply) {
  std::fwrite(reply.body.data(), 1, reply.body.size(), stdout);
  if (!reply.body.ends_with('\n')) std::fputc('\n', stdout);
}

}  // namespace sluice

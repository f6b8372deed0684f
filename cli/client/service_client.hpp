#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/client/http_client.hpp"

namespace sluice {

inline constexpr const char* kDefaultServer = "http://127.0.0.1:8080";

/// Which service, and what it wants to see.
struct ServiceOptions {
  std::string server = kDefaultServer;
  std::filesystem::path token_file;
};

/// Adds --server (SLUICE_SERVER) and --token-file (SLUICE_TOKEN_FILE) to a verb of a service.
void add_service_options(CLI::App& verb, ServiceOptions& options);
/// The same for a verb that also works on files: --server sets `of_service`.
void add_service_switch(CLI::App& verb, ServiceOptions& options, bool& of_service);
/// Whether such a verb speaks to a service: when --server was given; else, when there is no file or
/// folder called `word`, when SLUICE_SERVER is set or `word` is a whole id or "last".
[[nodiscard]] bool is_of_service(ServiceOptions& options, bool of_service, const std::string& word);

/// For how long a request is repeated while no service answers.
struct Patience {
  double seconds = 0.0;
  std::function<void(const std::string&)> say;  ///< hears that it waits, and that it need no longer
  std::string last_words;                       ///< what to do when it was in vain
};

/// Says on stderr that it waits.
[[nodiscard]] Patience patience_on_stderr(double seconds, std::string last_words);

/// A service as the verbs see it: answers that succeed. Everything else becomes CommandEnd, with
/// the problems that the service named on stderr, one per line.
class ServiceClient {
 public:
  /// Throws CommandEnd(usage) for an address or a token file that cannot be used.
  explicit ServiceClient(const ServiceOptions& options);

  /// `subject` is what a problem's pointers point into, such as a scene's file.
  [[nodiscard]] HttpReply ask(const HttpRequest& request, const std::string& subject = "");
  [[nodiscard]] HttpReply get(const std::string& target);
  /// As ask, but goes on trying while nothing answers or the service is starting or stopping. Only
  /// for requests that may arrive twice.
  [[nodiscard]] HttpReply ask_patiently(const HttpRequest& request, const Patience& patience,
                                        const std::string& subject = "");

  /// The answer's JSON object.
  [[nodiscard]] nlohmann::ordered_json object_of(const HttpReply& reply) const;

  [[nodiscard]] const std::string& server() const { return options_.server; }
  /// A command line for this service: "sluice watch j0..." with the options that it needs.
  [[nodiscard]] std::string command(std::string_view words) const;

 private:
  [[noreturn]] void end_unreachable(const std::string& why, const std::string& advice) const;
  [[nodiscard]] HttpReply accept(HttpReply reply, const std::string& subject) const;
  [[nodiscard]] std::string token_words() const;

  ServiceOptions options_;
  HttpClient http_;
};

/// "/v1/jobs/<id>" and what follows it. Throws CommandEnd(not_found) for what is no id.
[[nodiscard]] std::string job_target(const std::string& id, std::string_view rest = "");

/// An answer as it came, on stdout, ended by a new line.
void print_body(const HttpReply& reply);

}  // namespace sluice

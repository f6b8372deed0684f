#include "cli/problem_text.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "cli/json_text.hpp"
#include "cli/verbs.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

Json problem_of(const HttpReply& reply) {
  return Json::parse(reply.body, nullptr, /*allow_exceptions=*/false);
}

std::string slug_of(const Json& problem) {
  const std::string type = text_at(problem, "type");
  const std::string_view prefix = "/problems/";
  return type.starts_with(prefix) ? type.substr(prefix.size()) : "";
}

/// One of a problem's `errors`: a place in the body, a parameter, or a limit.
std::string error_line(const Json& error, const std::string& subject, std::string_view slug) {
  if (member(error, "pointer").is_string()) {
    const std::string pointer = text_at(error, "pointer");
    const std::string_view whole =
        slug == "invalid-study" ? "(the whole study)" : "(the whole scene)";
    return fmt::format("{}: {}: {}", subject.empty() ? "the request" : subject,
                       pointer.empty() ? whole : pointer, text_at(error, "detail"));
  }
  const std::string parameter = text_at(error, "parameter");
  if (!parameter.empty()) return fmt::format("{} {}", parameter, text_at(error, "detail"));
  const std::string which = text_at(error, "detail");  // the run of a study
  return fmt::format("{}: {}{}{} = {}, allowed are at most {}",
                     subject.empty() ? "the request" : subject, which, which.empty() ? "" : ": ",
                     text_at(error, "limit"), count_at(error, "value"), count_at(error, "allowed"));
}

bool names_a_parameter(const Json& problem) {
  const Json& errors = member(problem, "errors");
  return errors.is_array() && !errors.empty() && member(errors.front(), "parameter").is_string();
}

CommandEnd end_for(int status, const Json& problem, const std::string& message) {
  const std::string slug = slug_of(problem);
  const bool scene = slug == "invalid-scene" || slug == "invalid-study" || slug == "over-limit" ||
                     slug == "body-too-large";
  if (scene && !names_a_parameter(problem)) return CommandEnd(ExitCode::invalid_scene, message);
  if (status == 401 || status == 403) return CommandEnd(ClientExit::refused, message);
  if (status == 404) return CommandEnd(ClientExit::not_found, message);
  // As for a folder: another option, not another state, is what it takes.
  if (slug == "not-dimensionless") return CommandEnd(ExitCode::usage, message);
  if (status == 409) return CommandEnd(ClientExit::wrong_state, message);
  if (status >= 500) return CommandEnd(ClientExit::service_failed, message);
  return CommandEnd(ExitCode::usage, message);
}

/// What the service said, in the words of the command line where it has its own.
std::string message_of(const Json& problem, const ProblemContext& context) {
  const std::string slug = slug_of(problem);
  const std::string detail = text_at(problem, "detail");
  if (slug == "unauthorized") {
    return context.has_token
               ? fmt::format("{} does not take this token: see --token-file", context.server)
               : fmt::format("{} wants a token: name its file with --token-file", context.server);
  }
  const bool invalid = slug == "invalid-scene" || slug == "invalid-study";
  if (invalid && !context.subject.empty()) {
    const std::size_t count = member(problem, "errors").size();
    return fmt::format("{} is no valid {}: {} problem{}", context.subject,
                       slug == "invalid-scene" ? "scene" : "study", count, count == 1 ? "" : "s");
  }
  if (slug == "no-such-sensor") return detail;  // its title says the same
  if (slug == "not-dimensionless") return "--dimensionless: " + detail;
  return fmt::format("{}: {}", text_at(problem, "title"), detail);
}

}  // namespace

std::string problem_slug(const HttpReply& reply) { return slug_of(problem_of(reply)); }

void end_with_problem(const HttpReply& reply, const ProblemContext& context) {
  const Json problem = problem_of(reply);
  if (slug_of(problem).empty()) {
    throw CommandEnd(ClientExit::unreachable,
                     fmt::format("{} answers {}, but not as a Sluice service does: see --server",
                                 context.server, reply.status));
  }
  const Json& errors = member(problem, "errors");
  const std::string message = message_of(problem, context);
  for (const Json& error : errors.is_array() ? errors : Json::array()) {
    const std::string detail = text_at(error, "detail");
    if (!detail.empty() && message.find(detail) != std::string::npos) continue;  // told there
    std::fputs((error_line(error, context.subject, slug_of(problem)) + "\n").c_str(), stderr);
  }
  throw end_for(reply.status, problem, message);
}

}  // namespace sluice

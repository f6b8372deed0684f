#pragma once

#include <string>

#include "cli/client/http_client.hpp"

namespace sluice {

/// What a problem is about, for the words that the service cannot know.
struct ProblemContext {
  const std::string& server;
  const std::string& subject;  ///< the file that pointers point into; empty: a request
  bool has_token = false;
};

/// Ends the program for an answer that is no success: prints every problem that it names, one line
/// each on stderr, and throws CommandEnd with the code for its kind.
[[noreturn]] void end_with_problem(const HttpReply& reply, const ProblemContext& context);

/// The last part of a problem's type, such as "queue-full"; empty when the answer is no problem.
[[nodiscard]] std::string problem_slug(const HttpReply& reply);

}  // namespace sluice

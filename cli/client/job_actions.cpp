#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "cli/checks.hpp"
#include "cli/client/job_names.hpp"
#include "cli/client/job_text.hpp"
#include "cli/client/service_client.hpp"
#include "cli/client/service_study.hpp"
#include "cli/json_text.hpp"
#include "cli/verbs.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "service/jobs/job_ids.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct ActionArguments {
  ServiceOptions service;
  std::vector<std::string> ids;
  std::optional<double> end_time;
  bool json = false;
  bool wait = false;
  bool yes = false;
};

/// What a verb asks for, and how it may wait for that.
struct Action {
  HttpRequest (*make_request)(const std::string& id, const ActionArguments& arguments) = nullptr;
  /// Returns the job's answer once it is so. `known` is the newest checkpoint's step before.
  HttpReply (*wait)(ServiceClient& service, const std::string& id, std::uint64_t known) = nullptr;
  const char* wait_help = "";
  bool asks = false;  ///< for a yes, on a terminal
  bool takes_end_time = false;
};

constexpr std::chrono::milliseconds kLookAgain{300};

/// The path of a job or a study.
std::string target_of(const std::string& id, std::string_view rest = "") {
  return is_study_id(id) ? study_target(id, rest) : job_target(id, rest);
}

HttpRequest post(std::string target) {
  HttpRequest request;
  request.method = "POST";
  request.target = std::move(target);
  return request;
}

HttpRequest cancel(const std::string& id, const ActionArguments&) {
  return post(target_of(id, "/cancel"));
}

HttpRequest pause(const std::string& id, const ActionArguments&) {
  return post(job_target(id, "/pause"));
}

HttpRequest checkpoint(const std::string& id, const ActionArguments&) {
  return post(job_target(id, "/checkpoint"));
}

HttpRequest resume(const std::string& id, const ActionArguments& arguments) {
  HttpRequest request = post(job_target(id, "/resume"));
  if (!arguments.end_time) return request;
  request.body = Json{{"end_time", *arguments.end_time}}.dump();
  request.headers = {{"Content-Type", "application/json"}};
  return request;
}

HttpRequest remove(const std::string& id, const ActionArguments&) {
  HttpRequest request;
  request.method = "DELETE";
  request.target = target_of(id);
  return request;
}

/// The step of the job's newest checkpoint; 0 without one.
std::uint64_t newest_checkpoint(ServiceClient& service, const std::string& id) {
  std::uint64_t newest = 0;
  const Json list = service.object_of(service.get(job_target(id, "/files")));
  for (const Json& file : member(list, "files")) {
    newest = std::max(newest, step_of_checkpoint_name(text_at(file, "name")).value_or(0));
  }
  return newest;
}

template <class Reached>
HttpReply until(ServiceClient& service, const std::string& id, const Reached& reached) {
  while (true) {
    HttpReply reply = service.get(job_target(id));
    if (reached(service.object_of(reply))) return reply;
    std::this_thread::sleep_for(kLookAgain);
  }
}

HttpReply until_rest(ServiceClient& service, const std::string& id, std::uint64_t) {
  return until(service, id, [](const Json& job) { return is_at_rest(job); });
}

HttpReply until_checkpoint(ServiceClient& service, const std::string& id, std::uint64_t known) {
  return until(service, id, [&](const Json& job) {
    return text_at(job, "state") != "running" || newest_checkpoint(service, id) > known;
  });
}

/// Shows a question on the terminal whose answer is read, also when stderr goes elsewhere.
void show_question(const std::string& text) {
  if (::isatty(STDERR_FILENO) == 1) {
    std::fputs(text.c_str(), stderr);
    return;
  }
  const char* const name = ::ttyname(STDIN_FILENO);
  std::FILE* const terminal = name == nullptr ? nullptr : std::fopen(name, "we");
  if (terminal == nullptr) {
    throw CommandEnd(ExitCode::usage, "cannot ask on this terminal: --yes goes without");
  }
  std::fputs(text.c_str(), terminal);
  std::fclose(terminal);
}

/// Asks on a terminal; without one, the command itself is the answer. Throws CommandEnd(usage) for
/// a no.
void require_confirmed(ServiceClient& service, const std::string& id) {
  if (::isatty(STDIN_FILENO) != 1) return;
  const Json shown = service.object_of(service.get(target_of(id)));
  show_question(fmt::format("delete {} ({}, {}) with all its files? [y/N] ", id,
                            text_at(shown, "name"), text_at(shown, "state")));
  std::string answer;
  std::getline(std::cin, answer);
  if (answer == "y" || answer == "yes") return;
  throw CommandEnd(ExitCode::usage, fmt::format("{} stays: it was not deleted", id));
}

void print_done(const ServiceClient& service, const HttpReply& reply, const std::string& id,
                const ActionArguments& arguments) {
  if (reply.status == 204) {
    if (!arguments.json) fmt::print("{} deleted\n", id);
  } else if (arguments.json) {
    print_body(reply);
  } else {
    fmt::print("{} {}\n", id, state_text(service.object_of(reply)));
  }
}

/// Does something for each of several words. Every one is tried; the last failure tells how the
/// verb ends, the others are said on the way.
class EachTried {
 public:
  template <class Try>
  void operator()(const std::string& word, const Try& attempt) {
    try {
      attempt(word);
    } catch (const CommandEnd& end) {
      if (failure_) std::fputs(fmt::format("sluice: {}\n", failure_->what()).c_str(), stderr);
      failure_ = end;
    }
  }
  void end() const {
    if (failure_) throw *failure_;
  }

 private:
  std::optional<CommandEnd> failure_;
};

/// All names are looked up before anything is done: `last` is another job once the last is deleted.
void act(const ActionArguments& arguments, const Action& action) {
  ServiceClient service(arguments.service);
  EachTried each;
  std::vector<std::string> ids;
  for (const std::string& word : arguments.ids) {
    each(word, [&](const std::string& name) {
      std::string id = job_or_study_named(service, name);
      if (std::ranges::find(ids, id) == ids.end()) ids.push_back(std::move(id));
    });
  }
  for (const std::string& one : ids) {
    each(one, [&](const std::string& id) {
      if (action.asks && !arguments.yes) require_confirmed(service, id);
      const std::uint64_t known = arguments.wait ? newest_checkpoint(service, id) : 0;
      HttpReply reply = service.ask(action.make_request(id, arguments));
      if (arguments.wait) reply = action.wait(service, id, known);
      print_done(service, reply, id, arguments);
    });
  }
  each.end();
}

void add_action(CLI::App& app, const char* name, const char* help, const Action& action) {
  auto arguments = std::make_shared<ActionArguments>();
  CLI::App* verb = app.add_subcommand(name, help);
  verb->add_option(
          "id", arguments->ids,
          "A job's id, the beginning of one, or last; or several. A study's too for cancel "
          "and delete")
      ->required();
  if (action.wait != nullptr) {
    verb->add_flag("--wait", arguments->wait, action.wait_help);
  }
  if (action.asks) {
    verb->add_flag("--yes", arguments->yes, "Do not ask; without a terminal it never does");
  }
  if (action.takes_end_time) {
    verb->add_option("--end-time", arguments->end_time, "A later end of the model time, s")
        ->check(any_number());
  }
  verb->add_flag("--json", arguments->json, "Print the service's JSON, a line for each job");
  add_service_options(*verb, arguments->service);
  verb->footer(fmt::format("Example: sluice {} j0r2mt1q8kq0f7a3c1d2e", name));
  verb->callback([arguments, action] { act(*arguments, action); });
}

}  // namespace

void add_cancel(CLI::App& app) {
  add_action(app, "cancel", "End a service's job; its files stay, and it can be resumed",
             {&cancel});
}

void add_pause(CLI::App& app) {
  Action action{&pause};
  action.wait = &until_rest;
  action.wait_help = "Return once it rests with its checkpoint, or has ended";
  add_action(app, "pause", "Stop a service's job with a checkpoint until it is resumed", action);
}

void add_resume(CLI::App& app) {
  Action action{&resume};
  action.takes_end_time = true;
  add_action(app, "resume",
             "Resume a paused or cancelled job of a service, or an ended one to a later end",
             action);
}

void add_checkpoint(CLI::App& app) {
  Action action{&checkpoint};
  action.wait = &until_checkpoint;
  action.wait_help = "Return once a new checkpoint is written, or the job runs no longer";
  add_action(app, "checkpoint", "Have a running job of a service write a checkpoint now", action);
}

void add_delete(CLI::App& app) {
  Action action{&remove};
  action.asks = true;
  add_action(app, "delete", "Delete an ended job of a service with all its files", action);
}

}  // namespace sluice

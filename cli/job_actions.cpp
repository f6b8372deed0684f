#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/job_text.hpp"
#include "cli/json_text.hpp"
#include "cli/service_client.hpp"
#include "cli/service_study.hpp"
#include "cli/verbs.hpp"
#include "service/job_ids.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct ActionArguments {
  ServiceOptions service;
  std::vector<std::string> ids;
  std::optional<double> end_time;
  bool json = false;
};

using MakeRequest = HttpRequest (*)(const std::string& id, const ActionArguments& arguments);

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

/// Every job is tried; the last failure tells how the verb ends.
void act(const ActionArguments& arguments, MakeRequest make_request) {
  ServiceClient service(arguments.service);
  std::optional<CommandEnd> failure;
  for (const std::string& id : arguments.ids) {
    try {
      print_done(service, service.ask(make_request(id, arguments)), id, arguments);
    } catch (const CommandEnd& end) {
      if (failure) std::fputs(fmt::format("sluice: {}\n", failure->what()).c_str(), stderr);
      failure = end;
    }
  }
  if (failure) throw *failure;
}

std::shared_ptr<ActionArguments> add_action(CLI::App& app, const char* name, const char* help,
                                            MakeRequest make_request) {
  auto arguments = std::make_shared<ActionArguments>();
  CLI::App* verb = app.add_subcommand(name, help);
  verb->add_option("id", arguments->ids,
                   "The id of a job, or several; a study's too for cancel and delete")
      ->required();
  verb->add_flag("--json", arguments->json, "Print the service's JSON, a line for each job");
  add_service_options(*verb, arguments->service);
  verb->footer(fmt::format("Example: sluice {} j0r2mt1q8kq0f7a3c1d2e", name));
  verb->callback([arguments, make_request] { act(*arguments, make_request); });
  return arguments;
}

}  // namespace

void add_cancel(CLI::App& app) {
  add_action(app, "cancel", "End a service's job for good; its files stay", &cancel);
}

void add_pause(CLI::App& app) {
  add_action(app, "pause", "Stop a service's job with a checkpoint until it is resumed", &pause);
}

void add_resume(CLI::App& app) {
  auto arguments = add_action(
      app, "resume", "Let a paused job of a service go on, or an ended one for longer", &resume);
  app.get_subcommand("resume")->add_option("--end-time", arguments->end_time,
                                           "A later end of the model time, s");
}

void add_checkpoint(CLI::App& app) {
  add_action(app, "checkpoint", "Have a running job of a service write a checkpoint now",
             &checkpoint);
}

void add_delete(CLI::App& app) {
  add_action(app, "delete", "Delete an ended job of a service with all its files", &remove);
}

}  // namespace sluice

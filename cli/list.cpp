#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "cli/job_text.hpp"
#include "cli/json_text.hpp"
#include "cli/service_client.hpp"
#include "cli/verbs.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPage = 1000;  // jobs, the most that a page may have

struct ListArguments {
  ServiceOptions service;
  std::string state;
  std::string label;
  std::string id;
  bool json = false;
};

std::string page_target(const ListArguments& arguments, const std::string& cursor) {
  std::string target = fmt::format("/v1/jobs?limit={}", kPage);
  const auto add = [&target](std::string_view name, const std::string& value) {
    if (!value.empty()) target += fmt::format("&{}={}", name, percent_encoded(value));
  };
  add("state", arguments.state);
  add("label", arguments.label);
  add("cursor", cursor);
  return target;
}

/// All pages as one.
Json all_jobs(ServiceClient& service, const ListArguments& arguments) {
  Json jobs = Json::array();
  std::string cursor;
  do {
    const Json page = service.object_of(service.get(page_target(arguments, cursor)));
    for (const Json& job : member(page, "jobs")) jobs.push_back(job);
    const std::string next = text_at(page, "next_cursor");
    if (next == cursor) break;
    cursor = next;
  } while (!cursor.empty());
  return jobs;
}

void list(const ListArguments& arguments) {
  ServiceClient service(arguments.service);
  const Json jobs = all_jobs(service, arguments);
  if (arguments.json) {
    fmt::print("{}\n", Json{{"jobs", jobs}, {"next_cursor", nullptr}}.dump());
  } else if (jobs.empty()) {
    fmt::print("no jobs{}\n",
               arguments.state.empty() && arguments.label.empty() ? "" : " of this kind");
  } else {
    fmt::print("{}", table_text(jobs));
  }
}

void show(const ListArguments& arguments) {
  ServiceClient service(arguments.service);
  const HttpReply reply = service.get(job_target(arguments.id));
  if (arguments.json) return print_body(reply);
  fmt::print("{}", job_text(service.object_of(reply)));
}

}  // namespace

void add_list(CLI::App& app) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* verb = app.add_subcommand("list", "List a service's jobs, oldest first");
  verb->add_option("--state", arguments->state, "Only jobs in this state")
      ->check(CLI::IsMember({"queued", "running", "paused", "completed", "failed", "cancelled"}));
  verb->add_option("--label", arguments->label, "Only jobs with this label");
  verb->add_flag("--json", arguments->json, "Print JSON, all pages of the service as one");
  add_service_options(*verb, arguments->service);
  verb->footer("Example: sluice list --state running");
  verb->callback([arguments] { list(*arguments); });
}

void add_show(CLI::App& app) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* verb = app.add_subcommand("show", "Show one job of a service");
  verb->add_option("id", arguments->id, "The job's id")->required();
  verb->add_flag("--json", arguments->json, "Print the service's JSON");
  add_service_options(*verb, arguments->service);
  verb->footer("Example: sluice show j0r2mt1q8kq0f7a3c1d2e");
  verb->callback([arguments] { show(*arguments); });
}

}  // namespace sluice

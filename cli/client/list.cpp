#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "cli/checks.hpp"
#include "cli/client/job_names.hpp"
#include "cli/client/job_text.hpp"
#include "cli/client/service_client.hpp"
#include "cli/json_text.hpp"
#include "cli/verbs.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kPage = 1000;  // jobs, the most that a page may have

struct ListArguments {
  ServiceOptions service;
  std::string state;
  std::string label;
  std::string id;
  std::optional<std::size_t> limit;
  bool json = false;
};

std::string page_target(const ListArguments& arguments, const std::string& cursor,
                        std::size_t wanted) {
  std::string target = fmt::format("/v1/jobs?limit={}", std::min(kPage, wanted));
  const auto add = [&target](std::string_view name, const std::string& value) {
    if (!value.empty()) target += fmt::format("&{}={}", name, percent_encoded(value));
  };
  add("state", arguments.state);
  add("label", arguments.label);
  add("cursor", cursor);
  return target;
}

/// All pages as one, or as many jobs as are wanted.
Json all_jobs(ServiceClient& service, const ListArguments& arguments) {
  Json jobs = Json::array();
  std::string cursor;
  const std::size_t wanted = arguments.limit.value_or(std::numeric_limits<std::size_t>::max());
  do {
    const std::size_t left = wanted - jobs.size();
    const Json page = service.object_of(service.get(page_target(arguments, cursor, left)));
    for (const Json& job : member(page, "jobs")) jobs.push_back(job);
    const std::string next = text_at(page, "next_cursor");
    if (next == cursor) break;
    cursor = next;
  } while (!cursor.empty() && jobs.size() < wanted);
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
  const HttpReply reply = service.get(job_target(job_named(service, arguments.id)));
  if (arguments.json) return print_body(reply);
  fmt::print("{}", job_text(service.object_of(reply)));
}

}  // namespace

void add_list(CLI::App& app) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* verb = app.add_subcommand("list", "List a service's jobs, newest first");
  verb->add_option("--state", arguments->state, "Only jobs in this state")
      ->check(one_of(std::vector<std::string>{"queued", "running", "paused", "completed", "failed",
                                              "cancelled"}));
  verb->add_option("--label", arguments->label, "Only jobs with this label");
  verb->add_option("--limit", arguments->limit, "So many at most, the newest; all by default")
      ->check(whole_from(1));
  verb->add_flag("--json", arguments->json, "Print JSON, all pages of the service as one");
  add_service_options(*verb, arguments->service);
  verb->footer("Example: sluice list --state running");
  verb->callback([arguments] { list(*arguments); });
}

void add_show(CLI::App& app) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App* verb = app.add_subcommand("show", "Show one job of a service");
  verb->add_option("id", arguments->id, "The job's id, the beginning of it, or last")->required();
  verb->add_flag("--json", arguments->json, "Print the service's JSON");
  add_service_options(*verb, arguments->service);
  verb->footer("Example: sluice show j0r2mt1q8kq0f7a3c1d2e");
  verb->callback([arguments] { show(*arguments); });
}

}  // namespace sluice

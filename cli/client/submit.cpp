#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "cli/checks.hpp"
#include "cli/client/job_text.hpp"
#include "cli/client/scene_form.hpp"
#include "cli/client/service_client.hpp"
#include "cli/client/service_study.hpp"
#include "cli/client/watch.hpp"
#include "cli/json_text.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct SubmitArguments {
  ServiceOptions service;
  std::string scene;
  std::string label;
  std::optional<int> priority;
  std::optional<int> threads;
  std::string key;
  bool dry_run = false;
  bool json = false;
  bool watch = false;
  WatchOptions watching;
};

constexpr double kSubmitRetry = 30.0;  // s

std::string query_of(const SubmitArguments& arguments) {
  std::string query;
  const auto add = [&query](std::string_view name, std::string_view value) {
    query += fmt::format("{}{}={}", query.empty() ? '?' : '&', name, percent_encoded(value));
  };
  if (arguments.dry_run) add("dry_run", "1");
  if (!arguments.label.empty()) add("label", arguments.label);
  if (arguments.priority) add("priority", std::to_string(*arguments.priority));
  if (arguments.threads) add("threads", std::to_string(*arguments.threads));
  return query;
}

struct Submission {
  std::string scene;
  HttpRequest request;
};

Submission submission_of(const SubmitArguments& arguments, const std::string& key) {
  Submission result{read_scene_bytes(arguments.scene), {}};
  SceneForm form = form_of(result.scene, arguments.scene);
  HttpRequest& request = result.request;
  request.method = "POST";
  request.target = "/v1/jobs" + query_of(arguments);
  request.headers = {{"Content-Type", std::move(form.type)}, {"Idempotency-Key", key}};
  request.body = std::move(form.body);
  return result;
}

void print_names(std::string_view title, const Json& items) {
  std::string names;
  for (const Json& item : items) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", text_at(item, "name"));
  }
  if (!names.empty()) fmt::print("  {}: {}\n", title, names);
}

void print_warnings(const std::string& subject, const Json& answer) {
  for (const Json& warning : member(answer, "warnings")) {
    fmt::print("{}: warning: {}: {}\n", subject, text_at(warning, "pointer"),
               text_at(warning, "detail"));
  }
}

void print_dry_run(const std::string& subject, const Json& answer) {
  fmt::print("{} would be taken\n{}", subject, estimate_text(member(answer, "estimate")));
  const Json& plan = member(answer, "plan");
  print_names("runs", member(plan, "passes"));
  print_names("left out", member(plan, "passes_left_out"));
  print_warnings(subject, answer);
}

/// The first sensor of pressure of the scene, which the service found valid.
std::string sensor_to_show(const std::string& scene) {
  const Json sensors = member(Json::parse(scene, nullptr, /*allow_exceptions=*/false), "sensors");
  for (const Json& sensor : sensors) {
    if (text_at(sensor, "kind") == "pressure") {
      return fmt::format(" {} --filter gaussian --tau 0.002", text_at(sensor, "name"));
    }
  }
  return {};
}

void print_submitted(const ServiceClient& service, const HttpReply& reply, const Json& job,
                     const std::string& subject, const std::string& scene) {
  const std::string id = text_at(job, "id");
  const bool repeated = reply.header("idempotency-replayed") == "true";
  const std::string waiting = text_at(job, "waiting");
  fmt::print("{} {}{}{}\n", id, state_text(job), waiting.empty() ? "" : ": " + waiting,
             repeated ? " (submitted before, with the same key)" : "");
  fmt::print("{}", estimate_text(member(job, "estimate")));
  print_warnings(subject, job);
  fmt::print("  to watch:   {}\n", service.command("watch " + id));
  fmt::print("  to look in: {}\n",
             service.command(fmt::format("sensors {}{}", id, sensor_to_show(scene))));
  fmt::print("  to stop:    {}\n", service.command("cancel " + id));
  std::fflush(stdout);
}

void submit(const SubmitArguments& arguments) {
  ServiceClient service(arguments.service);
  const std::string key = arguments.key.empty() ? new_key() : arguments.key;
  const Submission submission = submission_of(arguments, key);
  const std::string subject = arguments.scene == "-" ? "stdin" : arguments.scene;
  const Patience patience = patience_on_stderr(
      arguments.watching.retry,
      fmt::format("submit it again with --idempotency-key {}, which makes no second job", key));
  const HttpReply reply = service.ask_patiently(submission.request, patience, subject);
  const Json answer = service.object_of(reply);
  if (arguments.json) {
    print_body(reply);
    std::fflush(stdout);
  } else if (arguments.dry_run) {
    print_dry_run(subject, answer);
  } else {
    print_submitted(service, reply, answer, subject, submission.scene);
  }
  if (!arguments.watch) return;
  WatchOptions watching = arguments.watching;
  if (arguments.json) watching.form = WatchForm::json;
  watch_job(service, text_at(answer, "id"), watching);
}

void add_submit_options(CLI::App& verb, SubmitArguments& arguments) {
  verb.add_option("scene", arguments.scene, "A scene (JSON), or - for stdin")
      ->required()
      ->check(file_or_stdin());
  verb.add_option("--label", arguments.label, "A word of yours, to find the job by");
  verb.add_option("--priority", arguments.priority, "Higher runs first; 0 by default")
      ->check(whole_between(-1000, 1000));
  verb.add_option("--threads", arguments.threads, "Threads of the job; 1 by default")
      ->check(whole_between(1, 1024));
  verb.add_option("--idempotency-key", arguments.key,
                  "One key makes one job, however often it is submitted; by default a new one");
  auto* dry = verb.add_flag("--dry-run", arguments.dry_run,
                            "Only check the scene and say what it would take");
  verb.add_flag("--watch", arguments.watch, "Watch the job until it ends")->excludes(dry);
  verb.add_flag("--json", arguments.json, "Print the service's JSON");
}

}  // namespace

void add_submit(CLI::App& app) {
  auto arguments = std::make_shared<SubmitArguments>();
  arguments->watching.retry = kSubmitRetry;
  CLI::App* verb =
      app.add_subcommand("submit", "Give a scene, with its meshes, to a service as a job");
  add_submit_options(*verb, *arguments);
  add_service_options(*verb, arguments->service);
  add_watch_options(*verb, arguments->watching);
  verb->footer("Example: sluice submit dambreak-quick.json --label first-try --watch");
  verb->callback([arguments] { submit(*arguments); });
}

}  // namespace sluice

#include "cli/client/service_study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <random>
#include <thread>

#include "cli/client/job_names.hpp"
#include "cli/json_text.hpp"
#include "cli/verbs.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStudyRetry = 600.0;  // s
constexpr std::chrono::seconds kLook{2};

void print_result(ServiceClient& service, const ServiceStudy& options, const std::string& id) {
  const HttpReply reply = service.get(study_target(id, options.json ? "" : "?format=markdown"));
  print_body(reply);
}

std::string end_text(const Json& run) {
  std::string text = fmt::format("{}: {}", text_at(run, "run"), text_at(run, "state"));
  if (const auto error = number_at(run, "error")) text += fmt::format(", error {:.4f}", *error);
  if (const auto cost = number_at(run, "core_seconds")) {
    text += fmt::format(", {:.4g} core-seconds", *cost);
  }
  const std::string reason = text_at(run, "reason");
  return reason.empty() ? text : fmt::format("{}: {}", text, reason);
}

/// Says how each run ended, until all have.
void watch(ServiceClient& service, const std::string& id) {
  HttpRequest request;
  request.target = study_target(id);
  const Patience patience = patience_on_stderr(
      kStudyRetry, "the study continues where its service is; watch it again with --watch");
  std::map<std::string, std::string> known;
  while (true) {
    const Json study = service.object_of(service.ask_patiently(request, patience));
    for (const Json& run : member(study, "runs")) {
      const std::string state = text_at(run, "state");
      std::string& before = known[text_at(run, "run")];
      if (before != state && state != "waiting" && state != "running") {
        std::fputs(fmt::format("{}\n", end_text(run)).c_str(), stderr);
      }
      before = state;
    }
    if (text_at(study, "state") != "open") return;
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace

std::string new_key() {
  std::random_device source;
  std::string key = "sluice-";
  for (int n = 0; n < 4; ++n) key += fmt::format("{:08x}", source());
  return key;
}

std::string study_target(const std::string& id, std::string_view rest) {
  return fmt::format("/v1/studies/{}{}", percent_encoded(id), rest);
}

void add_service_study_options(CLI::App& verb, ServiceStudy& options) {
  const std::string group = "By a service";
  add_service_switch(verb, options.service, options.of_service);
  verb.add_flag("--watch", options.watch, "Show how each run ends, then the result")->group(group);
  verb.add_option("--idempotency-key", options.key,
                  "One key makes one study, however often it is submitted; by default a new one")
      ->group(group);
}

void submit_study(const ServiceStudy& options, std::string_view document,
                  const std::string& subject) {
  ServiceClient service(options.service);
  const std::string key = options.key.empty() ? new_key() : options.key;
  HttpRequest request;
  request.method = "POST";
  request.target = "/v1/studies";
  request.headers = {{"Content-Type", "application/json"}, {"Idempotency-Key", key}};
  request.body = document;
  const HttpReply reply = service.ask_patiently(
      request,
      patience_on_stderr(
          kStudyRetry,
          fmt::format("submit it again with --idempotency-key {}, which makes no second study",
                      key)),
      subject);
  const Json study = service.object_of(reply);
  const std::string id = text_at(study, "id");
  if (options.json && !options.watch) return print_body(reply);
  if (!options.json) {
    fmt::print("{} {}: {} runs\n", id, text_at(study, "state"), count_at(study, "run_count"));
    fmt::print("  to look in: {}\n", service.command("study " + id));
    fmt::print("  its jobs:   {}\n", service.command("list --label " + id));
    fmt::print("  to stop:    {}\n", service.command("cancel " + id));
    std::fflush(stdout);
  }
  if (!options.watch) return;
  watch(service, id);
  print_result(service, options, id);
}

void show_study(const ServiceStudy& options, const std::string& word) {
  ServiceClient service(options.service);
  const std::string id = study_named(service, word);
  if (options.watch) watch(service, id);
  print_result(service, options, id);
}

}  // namespace sluice

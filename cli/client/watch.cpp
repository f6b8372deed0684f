#include "cli/client/watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <string_view>
#include <thread>

#include "cli/checks.hpp"
#include "cli/client/job_names.hpp"
#include "cli/client/job_text.hpp"
#include "cli/client/watch_view.hpp"
#include "cli/json_text.hpp"
#include "cli/verbs.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWait = 20;           // s that the service may hold a request back
constexpr int kSlack = 15;          // s beyond that, before it counts as gone
constexpr double kShortest = 0.5;   // s between requests, where the service holds none back
constexpr double kFirstTry = 10.0;  // s for a service that never answered yet

/// Ctrl-C leaves the job alone; says so, because it is not what `sluice run` does.
void leave(int signal) {
  constexpr std::string_view kText =
      "\nsluice: no longer watching; the job continues. Watch it again, or stop it with sluice "
      "pause or sluice cancel\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText.data(), kText.size());
  ::_exit(128 + signal);
}

WatchForm chosen_form(WatchForm form) {
  if (form != WatchForm::automatic) return form;
  return isatty(STDOUT_FILENO) == 1 ? WatchForm::bar : WatchForm::lines;
}

std::string next_commands(const ServiceClient& service, const Json& job) {
  const std::string id = text_at(job, "id");
  const std::string state = text_at(job, "state");
  const auto command = [&](std::string_view verb) {
    return service.command(fmt::format("{} {}", verb, id));
  };
  std::string text;
  if (state == "paused") text += fmt::format("  to resume:  {}\n", command("resume"));
  if (state == "failed") text += fmt::format("  diagnosis:  {}\n", command("show"));
  for (const char* const verb : {"sensors", "report"}) {
    const std::string words = fmt::format("{} {}", verb, id);
    text += fmt::format("  to look in: {}\n", service.command(words));
  }
  return text;
}

class Watch {
 public:
  Watch(ServiceClient& service, const std::string& id, const WatchOptions& options)
      : service_(&service),
        options_(options),
        view_(chosen_form(options.form), options.interval, stdout) {
    request_.target = job_target(id, fmt::format("?wait={}&progress=1", kWait));
    request_.timeout = kWait + kSlack;
  }

  /// The job at rest.
  Json until_rest() {
    for (;;) {
      const auto asked = std::chrono::steady_clock::now();
      if (auto job = ask()) {
        if (is_at_rest(*job)) return *std::move(job);
      }
      if (view_.is_unheard()) throw CommandEnd(ExitCode::done);
      std::this_thread::sleep_until(asked + std::chrono::duration<double>(kShortest));
    }
  }

  void close(const Json& job) { view_.close_with(next_commands(*service_, job)); }

 private:
  /// What the job is now; nothing when it is as it was.
  std::optional<Json> ask() {
    Patience patience;
    patience.seconds = reached_ ? options_.retry : std::min(options_.retry, kFirstTry);
    patience.say = [this](const std::string& line) { view_.say(line); };
    patience.last_words = "the job continues where its service is; see --server and --retry";
    const HttpReply reply = service_->ask_patiently(request_, patience);
    reached_ = true;
    if (reply.status == 304) return {};
    Json job = service_->object_of(reply);
    // With the tag of what is known, the service answers at once with news that came meanwhile.
    request_.headers = {{"If-None-Match", std::string(reply.header("etag"))}};
    view_.show(job, reply.body);
    return job;
  }

  ServiceClient* service_;
  WatchOptions options_;
  WatchView view_;
  HttpRequest request_;
  bool reached_ = false;
};

struct WatchArguments {
  ServiceOptions service;
  std::string id;
  WatchOptions watch;
  bool json = false;
};

void watch(const WatchArguments& arguments) {
  ServiceClient service(arguments.service);
  WatchOptions options = arguments.watch;
  if (arguments.json) options.form = WatchForm::json;
  const Patience patience = patience_on_stderr(
      std::min(options.retry, kFirstTry), "the job continues where its service is; see --server");
  watch_job(service, job_named(service, arguments.id, patience), options);
}

}  // namespace

void add_watch_options(CLI::App& verb, WatchOptions& options) {
  const std::map<std::string, WatchForm> forms{
      {"auto", WatchForm::automatic}, {"bar", WatchForm::bar}, {"lines", WatchForm::lines}};
  verb.add_option("--progress", options.form, "auto: a bar on a terminal, else lines")
      ->transform(one_of(forms));
  verb.add_option("--interval", options.interval, "Seconds between lines of progress")
      ->check(number_from_zero())
      ->capture_default_str();
  verb.add_option("--retry", options.retry, "Seconds to keep trying while no service answers")
      ->check(number_between(0.0, 1e9))
      ->capture_default_str();
}

void watch_job(ServiceClient& service, const std::string& id, const WatchOptions& options) {
  std::signal(SIGINT, &leave);
  Watch watched(service, id, options);
  const Json job = watched.until_rest();
  watched.close(job);
  end_as(job);
}

void add_watch(CLI::App& app) {
  auto arguments = std::make_shared<WatchArguments>();
  CLI::App* verb = app.add_subcommand("watch", "Show a service's job until it ends or is paused");
  verb->add_option("id", arguments->id, "The job's id, the beginning of it, or last")->required();
  add_service_options(*verb, arguments->service);
  add_watch_options(*verb, arguments->watch);
  verb->add_flag("--json", arguments->json, "The job's JSON, one line for each change");
  verb->footer(
      "Exit codes: 0 completed, 4 failed, 11 cancelled, 85 paused, 10 unreachable, 8 no such job. "
      "Ctrl-C leaves the job alone.\nExample: sluice watch j0r2mt1q8kq0f7a3c1d2e");
  verb->callback([arguments] { watch(*arguments); });
}

}  // namespace sluice

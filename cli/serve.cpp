#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "cli/notify.hpp"
#include "cli/serve_options.hpp"
#include "cli/stop_signals.hpp"
#include "cli/verbs.hpp"
#include "engine/execute/time_slice.hpp"
#include "engine/store/disk/errors.hpp"
#include "service/api/api.hpp"
#include "service/jobs/descriptor_budget.hpp"
#include "service/jobs/limits.hpp"
#include "service/jobs/rebuild.hpp"
#include "service/jobs/repair.hpp"
#include "service/jobs/service_log.hpp"

namespace sluice {
namespace {

void log_request(const AccessRecord& record, AccessLog wanted) {
  if (wanted == AccessLog::none) return;
  const bool reads = record.method == "GET" || record.method == "HEAD";
  if (wanted == AccessLog::changes && reads && record.status < 400) return;
  log_line({{"event", "request"},
            {"method", record.method},
            {"path", record.path},
            {"status", record.status},
            {"seconds", record.seconds},
            {"whole", record.whole},
            {"peer", record.peer}});
}

HttpServer::Observer observer(Api& api, AccessLog wanted) {
  return [&api, wanted](const AccessRecord& record) {
    if (!record.stream) {
      api.count_request(record.method, record.status,
                        std::chrono::duration<double>(record.seconds));
    }
    log_request(record, wanted);
  };
}

void set_rows_aside(const std::filesystem::path& data) {
  if (const auto aside = set_aside_database(data)) {
    log_line({{"event", "database_set_aside"}, {"file", aside->string()}});
  }
}

/// Jobs whose rows are missing: all after a rebuild, or those whose submission was cut short
/// between its folder and its row.
void adopt_folders(JobStore& store, const std::filesystem::path& data) {
  const auto report = [](const std::filesystem::path& folder, const std::string& why) {
    log_line({{"event", "folder_passed_over"}, {"folder", folder.string()}, {"message", why}});
  };
  repair_folders(store, data, report);
  const std::size_t adopted = rebuild_from_folders(store, data, report);
  if (adopted > 0) log_line({{"event", "folders_adopted"}, {"jobs", adopted}});
}

std::string base_url(const HttpOptions& options, int port) {
  const bool v6 = options.host.find(':') != std::string::npos;
  return fmt::format("http://{}{}{}:{}", v6 ? "[" : "", options.host, v6 ? "]" : "", port);
}

/// On stdout, for people; a program reads the address from the first line.
void print_welcome(const ServeOptions& options, const std::string& url) {
  const bool token = !options.http.guard.token.empty();
  const std::string header =
      token ? fmt::format(" -H \"Authorization: Bearer $(cat {})\"", options.token_file.string())
            : "";
  fmt::print(
      "sluice serves {} at {}\n"
      "  submit: curl{} --data-binary @scene.json {}/v1/jobs\n"
      "  look:   curl{} {}/v1/jobs\n",
      options.data.string(), url, header, url, header, url);
  std::fflush(stdout);
}

/// Has freed memory go back to the system. By default glibc keeps a heap for each of many threads,
/// and keeps in it what large answers took.
void bound_memory() {
  mallopt(M_ARENA_MAX, 2);
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);
  mallopt(M_TRIM_THRESHOLD, 1024 * 1024);
}

/// Fewer connections where the system lets the service open few files.
void fit_to_descriptors(ServeOptions& options) {
  const std::uint64_t limit = raise_descriptor_limit();
  const int workers = thread_limit(options.limits);
  const int connections = connections_within(limit, workers);
  if (connections < 1) {
    throw CommandEnd(
        ExitCode::usage,
        fmt::format("this process may open {} files at once (ulimit -n); a service with "
                    "{} cores needs at least {}: raise the limit",
                    limit, workers, least_descriptor_limit(workers)));
  }
  if (connections >= options.http.connections) return;
  options.http.connections = connections;
  options.http.large_answers = std::min(options.http.large_answers, std::max(1, connections / 2));
  log_line(
      {{"event", "few_descriptors"},
       {"message", fmt::format("this process may open {} files at once (ulimit -n), so at most "
                               "{} clients are served at once",
                               limit, connections)}});
}

void serve(ServeOptions& options) {
  bound_memory();
  fit_to_descriptors(options);
  // Before any thread starts: requests are answered while workers fill all cores.
  ask_for_slices(kShortestSlice);
  // First, so that no thread or child starts before the actions are set.
  const StopSignals signals;
  if (!options.token_file.empty()) options.http.guard.token = read_token_file(options.token_file);
  // Messages name files by their whole paths; the interface takes the folder's off (api.cpp).
  const std::filesystem::path data = std::filesystem::absolute(options.data);
  if (options.rows == Rows::rebuild) set_rows_aside(data);
  JobStore store(data);
  adopt_folders(store, data);
  Scheduler scheduler(store, data, options.limits);
  Api api(store, scheduler, data);
  HttpServer server(
      options.http, [&api](const Request& request) { return api.handle(request); },
      observer(api, options.log));

  print_welcome(options, base_url(options.http, server.port()));
  log_line({{"event", "ready"}, {"port", server.port()}});
  notify_manager("READY=1");
  signals.wait();

  notify_manager("STOPPING=1");
  log_line({{"event", "stopping"}, {"message", "workers write their checkpoints"}});
  api.set_draining();
  scheduler.drain();
  server.stop();
  log_line({{"event", "stopped"}});
}

ExitCode exit_code_of(JobStoreError::Fault fault) {
  return fault == JobStoreError::Fault::in_use ? ExitCode::folder_locked
                                               : ExitCode::storage_failure;
}

void serve_or_end(ServeOptions& options) {
  try {
    serve(options);
  } catch (const JobStoreError& error) {
    throw CommandEnd(exit_code_of(error.fault()), error.what());
  } catch (const StorageError&) {
    throw;
  } catch (const std::system_error&) {
    throw;
  } catch (const std::runtime_error& error) {
    // The address or the token file.
    throw CommandEnd(ExitCode::usage, error.what());
  }
}

}  // namespace

void add_serve(CLI::App& app) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* verb = app.add_subcommand("serve", "Run jobs for others: the HTTP service");
  add_serve_options(*verb, *options);
  verb->footer(
      "SIGTERM or Ctrl-C stops: running jobs write a checkpoint and resume at the next start; "
      "once more after two seconds: at once.\nExample: sluice serve --data jobs --port 8080");
  verb->callback([options] { serve_or_end(*options); });
}

}  // namespace sluice

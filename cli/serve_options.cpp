#include "cli/serve_options.hpp"

#include <map>

#include "cli/checks.hpp"

namespace sluice {
namespace {

void add_http_options(CLI::App& verb, ServeOptions& options) {
  const std::string group = "HTTP";
  verb.add_option("--port", options.http.port, "Port; 0 picks a free one and prints it")
      ->check(whole_between(0, 65535))
      ->capture_default_str()
      ->group(group);
  verb.add_option("--host", options.http.host,
                  "Address to listen on; one that other machines can reach needs --token-file")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--token-file", options.token_file,
                  "File (mode 600) with the token that requests must carry")
      ->group(group);
  verb.add_option("--allow-host", options.http.guard.host_names,
                  "Name that the Host header may have, such as a proxy's; may be repeated")
      ->group(group);
  const std::map<std::string, AccessLog> logs{
      {"none", AccessLog::none}, {"changes", AccessLog::changes}, {"all", AccessLog::all}};
  verb.add_option("--access-log", options.log,
                  "Requests to write a line about: none, changes and errors (default), or all")
      ->transform(one_of(logs))
      ->group(group);
}

void add_limit_options(CLI::App& verb, ServiceLimits& limits) {
  const std::string group = "Limits";
  const auto add = [&](const char* name, auto& member, const char* text) {
    verb.add_option(name, member, text)->check(whole_from(0))->capture_default_str()->group(group);
  };
  const auto add_bytes = [&](const char* name, auto& member, const char* text) {
    verb.add_option(name, member, text)->transform(size_in_bytes())->group(group);
  };
  verb.add_option("--cores", limits.cores, "Threads of all workers together; 0: the machine's")
      ->check(whole_between(0, 1024))
      ->group(group);
  add("--max-queued", limits.queued_jobs, "Jobs that may wait");
  verb.add_option("--max-study-runs", limits.runs_per_study, "Runs of a study")
      ->check(whole_between(1, 1000))
      ->capture_default_str()
      ->group(group);
  add("--max-particles", limits.particles_per_job, "Particles of a job, walls included");
  add_bytes("--max-memory", limits.memory_per_job,
            "Memory of a job, such as 4GB; by default three quarters of the machine's");
  add_bytes("--max-disk", limits.disk_per_job, "Disk space of a job; by default 20GB; 0: no limit");
  add_bytes("--disk-reserve", limits.disk_reserve,
            "Space that stays free: jobs pause before it is used; by default 512MB");
  verb.add_option("--max-wall-seconds", limits.wall_seconds_per_attempt,
                  "Time of an attempt, after which the job is paused; 0: no limit")
      ->check(number_from_zero())
      ->group(group);
  verb.add_option("--stalled-seconds", limits.stalled_seconds,
                  "A worker without progress for so long, not counting waits for a core, is ended "
                  "and its job tried again")
      ->check(number_above_zero())
      ->capture_default_str()
      ->group(group);
  verb.add_option("--stop-seconds", limits.stop_seconds,
                  "A worker that was asked to stop is killed after that")
      ->check(number_above_zero())
      ->capture_default_str()
      ->group(group);
  verb.add_option("--crash-limit", limits.crash_limit,
                  "A job fails after so many lost workers in a row without a new checkpoint")
      ->check(whole_between(1, 1000000))
      ->capture_default_str()
      ->group(group);
  verb.add_flag_callback(
          "--no-sandbox", [&limits] { limits.confinement = Confinement::none; },
          "Run workers without Landlock and seccomp, where these stand in the way")
      ->group(group);
  verb.add_option("--retention-days", limits.retention_days,
                  "Delete jobs that ended so long ago; 0: never")
      ->check(number_from_zero())
      ->group(group);
}

}  // namespace

void add_serve_options(CLI::App& verb, ServeOptions& options) {
  verb.add_option("--data", options.data, "Folder of all jobs; made when it is missing")
      ->required();
  verb.add_flag_callback(
      "--rebuild", [&options] { options.rows = Rows::rebuild; },
      "Set the data base aside and make its rows anew from the jobs' folders");
  add_http_options(verb, options);
  add_limit_options(verb, options.limits);
}

}  // namespace sluice

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "cli/usage_text.hpp"
#include "cli/verbs.hpp"
#include "engine/run/build_id.hpp"
#include "engine/run/run_loop.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/sph/loops/simd_target.hpp"
#include "engine/store/disk/errors.hpp"

namespace sluice {
namespace {

// Verbs in the order of the help.
constexpr std::array kVerbs{
    &add_run,        &add_validate, &add_plan,      &add_inspect,    &add_sensors, &add_export,
    &add_report,     &add_study,    &add_stability, &add_serve,      &add_submit,  &add_list,
    &add_show,       &add_watch,    &add_pause,     &add_resume,     &add_cancel,  &add_delete,
    &add_checkpoint, &add_help,     &add_version,   &add_completion, &add_man};

int fail(int code, std::string_view message) {
  if (!message.empty()) std::fputs(fmt::format("sluice: {}\n", message).c_str(), stderr);
  return code;
}

int fail(ExitCode code, std::string_view message) { return fail(static_cast<int>(code), message); }

/// A reader that has seen enough, such as `head`, or a terminal that was closed, is no failure.
bool reader_went_away() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

/// What was printed must have gone where it was sent, or a cut off file passes for a whole one.
int flushed(int code) {
  const bool whole = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (whole || reader_went_away()) return code;
  return fail(
      ExitCode::storage_failure,
      "what was printed is not whole: standard output takes no more (its disk may be full)");
}

/// SLUICE_SIMD speaks for the whole program and, through its environment, for all that it starts.
/// Who only asks what the program is or can do is answered all the same.
void take_default_simd_target(const CLI::App& app) {
  for (const char* const verb : {"help", "version", "completion", "man"}) {
    if (app.got_subcommand(verb)) return;
  }
  const char* const wanted = std::getenv("SLUICE_SIMD");
  if (wanted == nullptr || *wanted == '\0') return;
  try {
    set_default_simd_target(wanted);
  } catch (const std::invalid_argument& error) {
    throw CommandEnd(ExitCode::usage, fmt::format("SLUICE_SIMD: {}", error.what()));
  }
}

int parse_and_run(CLI::App& app, int argc, char** argv) {
  try {
    if (argc > 1) {
      const std::string message = unknown_verb(app, argv[1]);
      if (!message.empty()) throw CommandEnd(ExitCode::usage, message);
    }
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return fail(ExitCode::usage, usage_text(app, error));
  } catch (const CommandEnd& end) {
    return fail(end.code(), end.what());
  } catch (const SceneError& error) {
    return fail(ExitCode::invalid_scene, error.what());
  } catch (const StorageError& error) {
    return fail(exit_code_of(error.fault()), error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    const StorageError said = system_error(error);
    return fail(exit_code_of(said.fault()), said.what());
  } catch (const std::system_error& error) {
    // No thread, process or pipe: of the system's making, as a full disk is.
    return fail(ExitCode::storage_failure, error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::internal_error, "out of memory: see sluice plan for what a scene needs");
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return 0;  // told by flushed()
    return fail(ExitCode::internal_error, fmt::format("unexpected: {}", error.what()));
  }
}

/// A file that is opened first must not get the number of a closed standard stream: what is printed
/// would go into it.
void open_standard_descriptors() {
  int descriptor = STDIN_FILENO;
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) {
    descriptor = ::open("/dev/null", O_RDWR);
  }
  if (descriptor > STDERR_FILENO) ::close(descriptor);
}

}  // namespace
}  // namespace sluice

int main(int argc, char** argv) {
  sluice::open_standard_descriptors();
  // A file that grows beyond a limit (ulimit -f) is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{
      "Sluice runs long dam-break simulations as jobs that can be stopped and resumed anywhere.\n"
      "Exit codes: 0 done, 2 usage, 3 invalid scene, 4 numerical failure, 5 storage failure,\n"
      "6 no usable checkpoint, 7 folder locked, 85 checkpointed: run the folder again. Of a "
      "service:\n"
      "8 not found, 9 the job's state does not allow it, 10 unreachable, 11 job cancelled, 12 "
      "refused,\n"
      "13 the service cannot do it now.",
      "sluice"};
  app.set_version_flag("--version", "sluice " + sluice::build_id());
  app.require_subcommand(1);
  app.footer("Example: sluice run dambreak-quick.json");
  for (const auto add_verb : sluice::kVerbs) add_verb(app);
  app.parse_complete_callback([&app] { sluice::take_default_simd_target(app); });
  return sluice::flushed(sluice::parse_and_run(app, argc, argv));
}

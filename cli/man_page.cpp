#include "cli/man_page.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "cli/verbs.hpp"
#include "engine/run/exit_code.hpp"
#include "sluice/version.hpp"

namespace sluice {
namespace {

struct Explained {
  std::string_view word;
  std::string_view about;
};

struct ExitStatus {
  int code;
  std::string_view about;
};

template <class Code>
constexpr int code_of(Code code) {
  return static_cast<int>(code);
}

constexpr std::array kExitStatus{
    ExitStatus{code_of(ExitCode::done), "done; of watch: the job has completed"},
    ExitStatus{code_of(ExitCode::internal_error), "a defect of the program"},
    ExitStatus{code_of(ExitCode::usage), "wrong usage, or a file that is not there"},
    ExitStatus{code_of(ExitCode::invalid_scene),
               "the scene or study is not valid: each problem is a line with its place"},
    ExitStatus{code_of(ExitCode::numerical_failure),
               "the simulation went wrong; the last good checkpoint is kept"},
    ExitStatus{code_of(ExitCode::storage_failure),
               "the disk is full or refuses, or a file is damaged"},
    ExitStatus{code_of(ExitCode::no_usable_checkpoint),
               "there are checkpoints, but none can be used"},
    ExitStatus{code_of(ExitCode::folder_locked), "another process runs this folder"},
    ExitStatus{code_of(ClientExit::not_found), "no such job, sensor or file"},
    ExitStatus{code_of(ClientExit::wrong_state), "the job's state does not allow it"},
    ExitStatus{code_of(ClientExit::unreachable),
               "no answer at that address, or not from a Sluice service"},
    ExitStatus{code_of(ClientExit::job_cancelled), "the job that was watched was cancelled"},
    ExitStatus{code_of(ClientExit::refused),
               "the token is missing or wrong, or the host is not allowed"},
    ExitStatus{code_of(ClientExit::service_failed), "the service cannot do it now, or failed"},
    ExitStatus{code_of(ExitCode::checkpointed),
               "stopped as asked, with a checkpoint: run the folder again to resume"}};

constexpr std::array kEnvironment{
    Explained{"SLUICE_SERVER", "address of the service; http://127.0.0.1:8080 without it"},
    Explained{"SLUICE_TOKEN_FILE", "file (mode 600) with the service's token"},
    Explained{"SLUICE_SIMD", "SSE4, AVX2 or AVX3: the instructions that are used, for tests"},
    Explained{"SSL_CERT_FILE", "certificates of servers that are trusted"},
    Explained{"NO_COLOR", "set to anything: no colours on a terminal"}};

/// Text that troff shows as it stands: nothing in it is a request or an escape.
std::string roff(std::string_view text) {
  std::string safe;
  bool line_begins = true;
  for (const char letter : text) {
    if (line_begins && (letter == '.' || letter == '\'')) safe += "\\&";
    line_begins = letter == '\n';
    if (letter == '\\') {
      safe += "\\e";
    } else if (letter == '-') {
      safe += "\\-";
    } else {
      safe += letter;
    }
  }
  return safe;
}

/// A tagged paragraph.
std::string item(std::string_view tag, std::string_view about) {
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(tag), roff(about));
}

std::string option_item(const CLI::Option& option) {
  std::string tag = option.get_name(false, true);
  for (std::size_t at = 0; (at = tag.find(',', at)) != tag.npos; at += 2) tag.insert(at + 1, " ");
  if (option.get_items_expected_max() > 0) tag += " " + option.get_type_name();
  return item(tag, option.get_description());
}

std::string verb_section(const CLI::App& verb) {
  std::string words;
  std::string options;
  for (const CLI::Option* option : verb.get_options({})) {
    if (option->get_group().empty() || option->get_name() == "--help") continue;
    if (option->get_positional()) {
      const std::string name = option->get_name();
      words += option->get_required() ? " " + name : fmt::format(" [{}]", name);
    }
    options += option_item(*option);
  }
  std::string text = fmt::format(".SS sluice {}{}\n{}.\n{}", roff(verb.get_name()), roff(words),
                                 roff(verb.get_description()), options);
  if (!verb.get_footer().empty()) {
    text += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(verb.get_footer()));
  }
  return text;
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH SLUICE 1 \"\" \"Sluice {}\"\n"
      ".SH NAME\nsluice \\- dam breaks by weakly compressible SPH, as jobs that resume exactly\n"
      ".SH SYNOPSIS\n\\fBsluice\\fR \\fIverb\\fR [\\fIoptions\\fR]\n"
      ".SH DESCRIPTION\n{}.\nA scene is a JSON file; \\fBsluice validate\\fR names everything that "
      "is "
      "wrong with it, \\fBsluice plan\\fR what it will take. A run keeps all that it needs in one "
      "folder and resumes there bit by bit.\n.SH VERBS\n",
      roff(kVersion), roff(app.get_description()));
  for (const CLI::App* verb : app.get_subcommands({})) text += verb_section(*verb);
  text += ".SH EXIT STATUS\n";
  for (const ExitStatus& one : kExitStatus) text += item(fmt::format("{}", one.code), one.about);
  text += ".SH ENVIRONMENT\n";
  for (const Explained& one : kEnvironment) text += item(one.word, one.about);
  return text;
}

}  // namespace sluice

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/checks.hpp"
#include "cli/man_page.hpp"
#include "cli/usage_text.hpp"
#include "cli/verbs.hpp"
#include "engine/run/build_id.hpp"

namespace sluice {
namespace {

void help(const CLI::App& app, const std::string& word) {
  const std::string unknown = word.empty() ? "" : unknown_verb(app, word);
  if (!unknown.empty()) throw CommandEnd(ExitCode::usage, unknown);
  // Of the program itself by hand: its own help() is that of the verb that was chosen, help.
  const std::string text = word.empty() ? app.get_formatter()->make_help(&app, app.get_name(),
                                                                         CLI::AppFormatMode::Normal)
                                        : app.get_subcommand(word)->help(app.get_name());
  std::fwrite(text.data(), 1, text.size(), stdout);
}

/// The words that an option takes, of the "{a,b}" with which its check describes them; empty for
/// one that takes others.
std::string words_taken(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin);
  if (begin == type.npos || end == type.npos) return {};
  std::string words = type.substr(begin + 1, end - begin - 1);
  for (char& letter : words) {
    if (letter == ',') letter = ' ';
  }
  return words;
}

/// Branches of a shell's case over the verb and the word before the one to complete.
std::string branches_of(const CLI::App& verb) {
  std::string branches;
  std::vector<std::string> options;
  for (const CLI::Option* option : verb.get_options({})) {
    const bool hidden = option->get_group().empty();
    if (hidden) continue;
    const bool flag = option->get_items_expected_max() == 0;
    for (const std::string& name : option->get_lnames()) {
      options.push_back("--" + name);
      if (flag) continue;
      branches += fmt::format("    '{} --{}') words='{}' ;;\n", verb.get_name(), name,
                              words_taken(*option));
    }
  }
  return branches + fmt::format("    '{} '*) if [[ $word == -* ]]; then words='{}'; fi ;;\n",
                                verb.get_name(), fmt::join(options, " "));
}

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> verbs;
  std::string branches;
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs.push_back(verb->get_name());
    branches += branches_of(*verb);
  }
  return fmt::format(
      "# Completion of sluice's verbs, options and their words; other words are files.\n"
      "_sluice() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} words=\n"
      "  case \"${{COMP_WORDS[1]}} $before\" in\n{}  esac\n"
      "  if ((COMP_CWORD == 1)) || [[ $COMP_CWORD == 2 && $before == help ]]; then words='{}'; fi\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
      "}}\n"
      "complete -o bashdefault -o default -F _sluice sluice\n",
      branches, fmt::join(verbs, " "));
}

}  // namespace

void add_help(CLI::App& app) {
  const auto word = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("help", "Explain a verb, or name them all");
  verb->add_option("verb", *word, "The verb; without one, all are named");
  verb->footer("Example: sluice help run");
  verb->callback([&app, word] { help(app, *word); });
}

void add_version(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("version", "Print the program's version, as --version does");
  verb->footer("Example: sluice version");
  verb->callback([] { fmt::print("sluice {}\n", build_id()); });
}

void add_man(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("man", "Print the manual page");
  verb->footer("Example: sluice man | man -l -");
  verb->callback([&app] {
    const std::string text = man_page(app);
    std::fwrite(text.data(), 1, text.size(), stdout);
  });
}

void add_completion(CLI::App& app) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* verb =
      app.add_subcommand("completion", "Print what completes verbs and options in bash");
  verb->add_option("shell", *shell, "bash")
      ->required()
      ->check(one_of(std::vector<std::string>{"bash"}));
  verb->footer("Example: source <(sluice completion bash)");
  verb->callback([&app] {
    const std::string text = bash_completion(app);
    std::fwrite(text.data(), 1, text.size(), stdout);
  });
}

}  // namespace sluice

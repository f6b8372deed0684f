#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "cli/usage_text.hpp"
#include "cli/verbs.hpp"
#include "engine/run/build_id.hpp"

namespace sluice {
namespace {

void help(const CLI::App& app, const std::string& word) {
  const std::string unknown = unknown_verb(app, word);
  if (!unknown.empty()) throw CommandEnd(ExitCode::usage, unknown);
  // Of the program itself by hand: its own help() is that of the verb that was chosen, help.
  const std::string text = word.empty() ? app.get_formatter()->make_help(&app, app.get_name(),
                                                                         CLI::AppFormatMode::Normal)
                                        : app.get_subcommand(word)->help(app.get_name());
  std::fwrite(text.data(), 1, text.size(), stdout);
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

}  // namespace sluice

#include "cli/usage_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "engine/scene/model/problems.hpp"

namespace sluice {
namespace {

const CLI::App* chosen_verb(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? nullptr : chosen.front();
}

std::string first_word(const std::string& text) {
  std::string word = text.substr(0, text.find(' '));
  if (word.ends_with(':')) word.pop_back();
  return word;
}

std::string last_word(const std::string& text) { return text.substr(text.rfind(' ') + 1); }

const CLI::Option* option_called(const CLI::App* verb, const std::string& name) {
  return verb == nullptr ? nullptr : verb->get_option_no_throw(name);
}

/// What an option or argument is for, as the rest of a sentence.
std::string meaning(const CLI::App* verb, const std::string& name) {
  const CLI::Option* option = option_called(verb, name);
  std::string text = option == nullptr ? "" : option->get_description();
  if (text.size() < 2) return text;
  // "JSON ..." stays as it is.
  if (std::islower(static_cast<unsigned char>(text[1])) != 0 || text[1] == ' ') {
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  }
  return ": " + text;
}

std::vector<std::string> words_left(const CLI::App& app, const CLI::App* verb) {
  return verb == nullptr ? app.remaining() : verb->remaining();
}

/// An option that there is not is the first mistake, whatever is wrong because of it.
bool has_unknown_option(const std::vector<std::string>& left) {
  return std::ranges::any_of(left,
                             [](const auto& word) { return word.size() > 1 && word[0] == '-'; });
}

std::string unexpected(const CLI::App& app, const CLI::App* verb) {
  std::vector<std::string> rest = words_left(app, verb);
  if (rest.empty()) return "there is something more than the verb takes";
  std::ranges::stable_partition(rest, [](const auto& word) { return word.starts_with('-'); });
  const std::string& word = rest.front();
  if (!word.starts_with('-')) return fmt::format("\"{}\" is more than the verb takes", word);
  std::vector<std::string> names;
  for (const CLI::Option* option : (verb == nullptr ? app : *verb).get_options({})) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string name = word.substr(0, word.find('='));
  return fmt::format("there is no option {}: {}", name, hint(name, views));
}

std::string plain_text(const CLI::App& app, const CLI::App* verb, const CLI::ParseError& error) {
  const std::string said = error.what();
  const std::string name = first_word(said);
  const bool more = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (more || has_unknown_option(words_left(app, verb))) return unexpected(app, verb);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (verb == nullptr) return "a verb is missing, such as run";
    return fmt::format("{} is missing{}", name, meaning(verb, name));
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const bool twice = said.find("received") != std::string::npos;
    return twice ? fmt::format("{} is given more than once", name)
                 : fmt::format("{} needs a value{}", name, meaning(verb, name));
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    // "Could not convert: --name = value": values of options are checked before.
    const std::size_t end = said.find(" = ");
    return fmt::format("{} takes no value", last_word(said.substr(0, end)));
  }
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr) {
    return fmt::format("{} and {} cannot go together", name, last_word(said));
  }
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr) {
    return fmt::format("{} goes only with {}", name, last_word(said));
  }
  return said;
}

}  // namespace

std::string unknown_verb(const CLI::App& app, std::string_view word) {
  if (word.starts_with('-')) return {};
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  const std::vector<std::string_view> views(names.begin(), names.end());
  for (const std::string_view name : views) {
    if (name == word) return {};
  }
  return fmt::format("there is no verb {}: {}", word.empty() ? "\"\"" : word, hint(word, views));
}

std::string usage_text(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* verb = chosen_verb(app);
  return fmt::format("{}; see sluice help{}", plain_text(app, verb, error),
                     verb == nullptr ? "" : " " + verb->get_name());
}

}  // namespace sluice

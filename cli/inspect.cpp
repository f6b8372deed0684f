#include "engine/store/inspect.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/checks.hpp"
#include "cli/json_text.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/estimate.hpp"
#include "engine/scene/parse.hpp"
#include "engine/store/errors.hpp"
#include "engine/store/file_system.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct InspectArguments {
  std::string file;
  bool json = false;
};

/// What a text file of a job is; nothing for what is no JSON object.
std::optional<Json> text_facts(const std::string& path) {
  std::string text;
  try {
    text = read_text(path, kMaxSceneBytes);
  } catch (const StorageError&) {
    return {};  // Too long for a text of ours, or the explanation of a file that cannot be read.
  }
  if (text.find('{') != text.find_first_not_of(" \t\r\n")) return {};
  const Json object = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return {};
  Json facts{{"file", path}};
  if (const auto scene = parse_scene(text, StabilityCheck::skip).scene) {
    const Estimate needs = estimate(*scene);
    facts["kind"] = "scene";
    facts["name"] = scene->name;
    facts["end_time"] = scene->end_time;
    facts["fluid_particles"] = needs.fluid_particles;
    facts["wall_particles"] = needs.wall_particles;
    facts["sensors"] = scene->sensors.size();
  } else {
    facts["kind"] = "JSON text, no valid scene";
    facts["keys"] = Json::array();
    for (const auto& [key, value] : object.items()) facts["keys"].push_back(key);
  }
  facts["verdict"] = "whole";
  return facts;
}

void print_facts(const Json& facts, bool json) {
  constexpr auto kReplace = Json::error_handler_t::replace;  // a path need not be UTF-8
  if (json) {
    fmt::print("{}\n", facts.dump(2, ' ', false, kReplace));
    return;
  }
  for (const auto& [name, value] : facts.items()) {
    fmt::print("{:<16} {}\n", name,
               printable(value.is_string() ? value.get<std::string>()
                                           : value.dump(-1, ' ', false, kReplace)));
  }
}

void inspect_verb(const InspectArguments& arguments) {
  if (const auto facts = text_facts(arguments.file)) return print_facts(*facts, arguments.json);
  const Inspection inspection = inspect_file(arguments.file);
  fmt::print("{}{}", arguments.json ? inspection.json : inspection.text,
             arguments.json ? "\n" : "");
  // What is wrong stands in the explanation already.
  if (inspection.verdict != Verdict::whole) throw CommandEnd(ExitCode::storage_failure);
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* verb = app.add_subcommand("inspect", "Explain any file of a job (exit 5: not whole)");
  verb->add_option("file", arguments->file, "A checkpoint, series, frame or scene")
      ->required()
      ->check(existing_file());
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->footer("Example: sluice inspect dambreak-quick/series.h5");
  verb->callback([arguments] { inspect_verb(*arguments); });
}

}  // namespace sluice

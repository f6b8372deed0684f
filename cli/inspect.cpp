#include "engine/store/files/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "cli/checks.hpp"
#include "cli/json_text.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"
#include "engine/store/disk/trailer.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

struct InspectArguments {
  std::string file;
  bool json = false;
};

constexpr std::uint64_t kLargestText = 64 << 20;

/// A file that has no sum of ours, so that nothing but its name says what it is.
struct NamedKind {
  std::string_view first;  ///< how the name begins
  std::string_view last;   ///< and ends
  std::string_view kind;
};
constexpr std::array kNamedKinds{
    NamedKind{"lock", "lock", "lock: empty unless a process holds the folder, whose number it has"},
    NamedKind{"log.jsonl", ".jsonl", "log of the job's events, a JSON object per line"},
    NamedKind{"report", ".md", "report as Markdown"},
    NamedKind{"report", ".html", "report with plots and pictures"},
    NamedKind{"report", ".txt", "report as text"},
    NamedKind{"frame-", ".hdf", "frame for ParaView (VTKHDF), made by sluice export"},
    NamedKind{"frame-", ".csv", "frame as a table, made by sluice export"},
    NamedKind{"worker.log", ".log", "what the worker of a service's job said"},
    NamedKind{"jobs.sqlite", "", "the service's data base (SQLite)"},
    NamedKind{"results", ".csv", "results of a study as a table"},
    NamedKind{"results", ".md", "results of a study as Markdown"},
    NamedKind{"error-cost", ".svg", "chart of a study's errors and costs"}};

std::string name_in(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// What the file is by its name alone.
std::optional<Json> named_facts(const std::string& path) {
  const std::string name = name_in(path);
  const auto known = std::ranges::find_if(kNamedKinds, [&](const NamedKind& each) {
    return name.starts_with(each.first) && name.ends_with(each.last);
  });
  if (known == kNamedKinds.end()) return {};
  std::error_code ignored;
  return Json{{"file", path},
              {"kind", known->kind},
              {"bytes", std::filesystem::file_size(path, ignored)},
              {"verdict", "unchecked"}};
}

/// Whether the file has a trailer of ours, or must have one: a checkpoint that was put aside too.
bool is_sealed(const std::string& path) {
  const std::string name = name_in(path);
  if (name.ends_with(".h5") || name.ends_with(".h5.bad")) return true;
  try {
    static_cast<void>(read_trailer(InputFile(path)));
    return true;
  } catch (const StorageError& error) {
    return error.fault() != StorageFault::corrupt;  // a newer one, or it cannot be read
  }
}

/// What a text file of a job is; nothing for what is no JSON object.
std::optional<Json> text_facts(const std::string& path) {
  std::string text;
  try {
    text = read_text(path, kLargestText);
  } catch (const StorageError&) {
    return {};  // Too long for a text of ours, or the explanation of a file that cannot be read.
  }
  if (text.find('{') != text.find_first_not_of(" \t\r\n")) return {};
  const Json object = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) return {};
  Json facts{{"file", path}};
  if (const auto scene =
          parse_scene(text, StabilityCheck::skip, SceneOrigin::user, parts_beside(path)).scene) {
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
  const std::string& path = arguments.file;
  if (const auto facts = text_facts(path)) return print_facts(*facts, arguments.json);
  const bool sealed = is_sealed(path);
  if (!sealed) {
    if (const auto facts = named_facts(path)) return print_facts(*facts, arguments.json);
  }
  if (!sealed && name_in(path).ends_with(".json")) {
    const Json facts{{"file", path},
                     {"kind", "JSON text"},
                     {"verdict", "damaged"},
                     {"problem", "it is no whole JSON object"}};
    print_facts(facts, arguments.json);
    throw CommandEnd(ExitCode::storage_failure);
  }
  if (!sealed) {
    throw CommandEnd(ExitCode::usage,
                     fmt::format("{} is none of the files that inspect explains: those of a job, a "
                                 "study or a service, under their own names",
                                 printable(path)));
  }
  const Inspection inspection = inspect_file(path);
  fmt::print("{}{}", arguments.json ? inspection.json : inspection.text,
             arguments.json ? "\n" : "");
  // What is wrong stands in the explanation already.
  if (inspection.verdict != Verdict::whole) throw CommandEnd(ExitCode::storage_failure);
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* verb = app.add_subcommand("inspect", "Explain any file of a job (exit 5: not whole)");
  verb->add_option("file", arguments->file,
                   "A checkpoint, series, frame, scene or any other file of a job")
      ->required()
      ->check(existing_file());
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->footer("Example: sluice inspect dambreak-quick/series.h5");
  verb->callback([arguments] { inspect_verb(*arguments); });
}

}  // namespace sluice

#include "engine/store/inspect.hpp"

#include <fmt/format.h>

#include <memory>

#include "cli/verbs.hpp"

namespace sluice {
namespace {

struct InspectArguments {
  std::string file;
  bool json = false;
};

void inspect_verb(const InspectArguments& arguments) {
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
  verb->add_option("file", arguments->file, "A checkpoint, series or frame")
      ->required()
      ->check(CLI::ExistingFile);
  verb->add_flag("--json", arguments->json, "Print JSON");
  verb->footer("Example: sluice inspect dambreak-quick/series.h5");
  verb->callback([arguments] { inspect_verb(*arguments); });
}

}  // namespace sluice

#include "cli/scene_file.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "cli/verbs.hpp"
#include "engine/scene/checks/parse.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/file_system.hpp"

namespace sluice {
namespace {

std::string read_scene_text(const std::filesystem::path& path) {
  try {
    // One byte more than a scene may have, so that the parser finds it too long and says so.
    return read_text(path, kMaxSceneBytes + 1);
  } catch (const StorageError& error) {
    // Too long is a fault of the scene; all else of the word that names it.
    const bool too_long = error.fault() == StorageFault::not_ours;
    throw CommandEnd(too_long ? ExitCode::invalid_scene : ExitCode::usage, error.what());
  }
}

std::string read_stdin(std::size_t limit) {
  std::string text(limit, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stdin));
  return text;
}

void require_scene(const ParseResult& result, const std::filesystem::path& where) {
  if (result.scene) return;
  for (const Problem& problem : result.problems) {
    std::fputs(fmt::format("{}: {}: {}\n", where.string(),
                           problem.pointer.empty() ? "(the whole scene)" : problem.pointer,
                           problem.message)
                   .c_str(),
               stderr);
  }
  const std::size_t count = result.problems.size();
  throw CommandEnd(ExitCode::invalid_scene,
                   fmt::format("{} is no valid scene: {} problem{}", where.string(), count,
                               count == 1 ? "" : "s"));
}

}  // namespace

std::string read_scene_bytes(const std::filesystem::path& path) {
  std::string text = path == "-" ? read_stdin(kMaxSceneBytes + 1) : read_scene_text(path);
  if (text.size() <= kMaxSceneBytes) return text;
  throw CommandEnd(ExitCode::invalid_scene,
                   fmt::format("{} is longer than {} KiB, the most that a scene may have",
                               path == "-" ? "stdin" : path.string(), kMaxSceneBytes >> 10U));
}

SceneParts parts_beside(const std::filesystem::path& scene) {
  return parts_in(scene.parent_path(), Links::follow);
}

Scene job_scene_or_end(std::string_view text, const std::filesystem::path& where) {
  ParseResult result = parse_job_scene(text, parts_in(where.parent_path(), Links::refuse));
  require_scene(result, where);
  return *std::move(result.scene);
}

SceneFile read_scene(const std::filesystem::path& path) {
  const std::string text = read_scene_bytes(path);
  const SceneParts parts = parts_beside(path);
  ParseResult result = parse_scene(text, parts);
  require_scene(result, path == "-" ? "stdin" : path);
  std::vector<NamedPart> named = parts_of(*result.scene, parts);
  return {text_for_folder(text, parts), *std::move(result.scene), std::move(result.warnings),
          std::move(named)};
}

std::string warnings_text(const std::vector<Problem>& warnings, const std::string& where) {
  std::string text;
  for (const Problem& warning : warnings) {
    text += fmt::format("{}: warning: {}: {}\n", where, warning.pointer, warning.message);
  }
  return text;
}

}  // namespace sluice

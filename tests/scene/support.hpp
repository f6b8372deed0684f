#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/scene/checks/parse.hpp"

namespace sluice::testing {

inline std::filesystem::path source_dir() { return SLUICE_SOURCE_DIR; }

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::vector<std::filesystem::path> json_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool study = entry.path().filename().string().starts_with("study-");
    if (entry.path().extension() == ".json" && !study) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  EXPECT_FALSE(files.empty()) << folder;
  return files;
}

/// The files beside a scene. Their SHA-256 is made up.
inline SceneParts parts_beside(const std::filesystem::path& scene) {
  return [folder = scene.parent_path()](const std::string& name) -> ScenePart {
    if (!std::filesystem::exists(folder / name)) return no_parts(name);
    return {read_text(folder / name), std::string(64, 'a'), {}};
  };
}

inline ParseResult parse_file(const std::filesystem::path& path) {
  return parse_scene(read_text(path), parts_beside(path));
}

/// Smallest distance between any two points, O(n^2).
template <class Point>
double smallest_distance(const std::vector<Point>& points) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      smallest = std::min(smallest, (points[i] - points[j]).norm());
    }
  }
  return smallest;
}

/// A tank of 2 m x 1 m with a column of 1 m x 0.5 m at its left wall, dx = 0.05 m: 200 particles.
inline nlohmann::json base_scene() {
  return nlohmann::json::parse(R"({
    "name": "base",
    "tank": {"width": 2, "height": 1},
    "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [1, 0.5]}],
    "gravity": [0, -9.81],
    "resolution": {"spacing": 0.05},
    "end_time": 1
  })");
}

/// A tank of 2 m x 1 m x 0.6 m with a column of 1 m x 0.5 m at its left wall, dx = 0.05 m.
inline nlohmann::json space_scene() {
  return nlohmann::json::parse(R"({
    "name": "space",
    "tank": {"width": 2, "height": 1, "depth": 0.6},
    "fluid": [{"shape": "box", "corner": [0, 0, 0], "size": [1, 0.5, 0.6]}],
    "gravity": [0, -9.81, 0],
    "resolution": {"spacing": 0.05},
    "end_time": 1
  })");
}

inline nlohmann::json box(const std::vector<double>& corner, const std::vector<double>& size) {
  return {{"shape", "box"}, {"corner", corner}, {"size", size}};
}

inline nlohmann::json cylinder(const std::vector<double>& base, const std::vector<double>& axis,
                               double radius) {
  return {{"shape", "cylinder"}, {"base", base}, {"axis", axis}, {"radius", radius}};
}

/// Over the whole depth of the tank of space_scene().
inline nlohmann::json prism(const std::vector<std::vector<double>>& points) {
  return {{"shape", "prism"}, {"points", points}, {"z", 0}, {"depth", 0.6}};
}

/// SPHERIC test 2, whose measures have no spacing in common, and the valley: to pack their many
/// particles takes seconds, and a sanitizer a quarter of an hour.
inline bool takes_long_to_pack(const std::filesystem::path& example) {
  return example.stem().string().starts_with("spheric2") || example.stem() == "valley";
}

/// A free region with dx = 0.05 m, neither walls nor gravity, c = 20 m/s.
inline nlohmann::json free_scene(nlohmann::json region) {
  nlohmann::json scene = base_scene();
  scene.erase("tank");
  scene.erase("gravity");
  scene["material"]["sound_speed"] = 20;
  scene["fluid"] = {std::move(region)};
  return scene;
}

inline std::string list(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& each : problems) text += "'" + each.pointer + "': " + each.message + "\n";
  return text;
}

inline ParseResult parse(const nlohmann::json& scene) { return parse_scene(scene.dump()); }

/// The scene of a text that must be valid.
inline Scene parsed(const nlohmann::json& scene) {
  ParseResult result = parse(scene);
  if (!result.scene) throw std::runtime_error("not a valid scene:\n" + list(result.problems));
  return *result.scene;
}

/// The scene of a file that must be valid.
inline Scene parsed_file(const std::filesystem::path& path) {
  ParseResult result = parse_file(path);
  if (!result.scene) throw std::runtime_error(path.string() + ":\n" + list(result.problems));
  return *result.scene;
}

inline std::vector<std::string> pointers(const ParseResult& result) {
  std::vector<std::string> found;
  for (const Problem& each : result.problems) found.push_back(each.pointer);
  std::sort(found.begin(), found.end());
  return found;
}

/// The message at a pointer, "" when there is none.
inline std::string message_at(const ParseResult& result, const std::string& pointer) {
  for (const Problem& each : result.problems) {
    if (each.pointer == pointer) return each.message;
  }
  return "";
}

}  // namespace sluice::testing

#include "engine/scene/checks/parse.hpp"

#include <fmt/format.h>

#include "engine/scene/checks/check.hpp"
#include "engine/scene/checks/meaning.hpp"
#include "engine/scene/checks/surfaces.hpp"
#include "engine/scene/format/describe.hpp"
#include "engine/scene/format/former_words.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/numerics_json.hpp"
#include "engine/scene/format/reader.hpp"

namespace sluice {
namespace {

using nlohmann::json;

/// What a scene says in `numerics`, an empty object where it says nothing.
json numerics_of(const json& scene) {
  const auto found = scene.is_object() ? scene.find("numerics") : scene.end();
  const bool there = scene.is_object() && found != scene.end() && found->is_object();
  return there ? *found : json::object();
}

/// The scheme that numerics name; nothing also where that is no word, which the Reader reports.
std::optional<Scheme> named_scheme(const json& numerics) {
  const auto found = numerics.find("scheme");
  if (found == numerics.end()) return std::nullopt;
  for (const auto& each : kSchemeWords) {
    if (*found == each.word) return each.value;
  }
  return std::nullopt;
}

/// The number of dimensions that a scene names, or that of its first fluid's shape: what does not
/// fit is found by the Reader.
int named_dimensions(const json& scene) {
  if (!scene.is_object()) return kPlaneDim;
  const auto named = scene.find("dimensions");
  for (const int known : {kPlaneDim, kMostDim}) {
    if (named != scene.end() && *named == known) return known;
  }
  const json fluid = scene.value("fluid", json());
  if (!fluid.is_array() || fluid.empty() || !fluid.front().is_object()) return kPlaneDim;
  const json word = fluid.front().value("shape", json());
  for (const auto& each : kShapeWords) {
    if (word == each.word) return dimensions_of(shape_of(each.value));
  }
  return kPlaneDim;
}

std::vector<std::string> pointers_of(const json& numerics) {
  std::vector<std::string> pointers;
  if (numerics.empty()) return pointers;
  const json flat = numerics.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (pointer != "/scheme") pointers.push_back(pointer);
  }
  return pointers;
}

WrittenScene read_written(const json& scene, std::optional<Scheme> scheme, Problems& problems) {
  const int dimensions = named_dimensions(scene);
  WrittenScene written(scheme, dimensions);
  written.scene.numerics.named = pointers_of(numerics_of(scene));
  Reader reader(scene, "", problems, dimensions);
  describe(reader, written);
  reader.finish();
  leave_out_excluded(written.scene.method, written.scene.numerics);
  return written;
}

/// What a scene means that names no scheme; a problem where that cannot be told.
WrittenScene read_without_scheme(const json& scene, SceneOrigin origin, Problems& problems) {
  if (origin == SceneOrigin::job) return read_written(scene, std::nullopt, problems);
  WrittenScene now = read_written(scene, Scheme::recommended, problems);
  if (!problems.empty()) return now;
  WrittenScene before = read_written(scene, std::nullopt, problems);
  const WrittenScene paper = read_written(scene, Scheme::paper, problems);
  const Meanings meanings{now, paper, before};
  if (!has_two_meanings(meanings)) return now;
  if (origin == SceneOrigin::study) return before;
  problems.add("/numerics", how_to_tell(meanings));
  return now;
}

/// Writes the SHA-256 of each mesh beside its file where it is not there, and says whether it did.
bool name_meshes(const Scene& scene, nlohmann::ordered_json& text) {
  bool any = false;
  const auto name = [&](const Shape& shape, nlohmann::ordered_json& written) {
    const auto* mesh = std::get_if<Mesh>(&shape);
    if (mesh == nullptr || written.contains("sha256")) return;
    written["sha256"] = mesh->sha256;
    any = true;
  };
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) name(scene.fluid[i].shape, text["fluid"][i]);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    name(scene.obstacles[i], text["obstacles"][i]);
  }
  return any;
}

}  // namespace

ParseResult parse_scene(std::string_view text, StabilityCheck stability, SceneOrigin origin,
                        const SceneParts& parts) {
  Problems problems;
  Problems warnings;
  auto scene = read_json(text, problems);
  if (!scene) return {std::nullopt, problems.take(), {}};
  const auto former = use_present_words(*scene, kFormerSceneWords, problems);

  const json numerics = numerics_of(*scene);
  WrittenScene written =
      numerics.contains("scheme")
          ? read_written(*scene, named_scheme(numerics).value_or(Scheme::recommended), problems)
          : read_without_scheme(*scene, origin, problems);
  make_surfaces(written.scene, parts, problems, warnings);
  if (scene->is_object()) check(written, {stability, origin}, problems, warnings);

  if (!problems.empty()) return {std::nullopt, at_written_places(problems.take(), former), {}};
  return {resolve(written), {}, at_written_places(warnings.take(), former)};
}

ParseResult parse_job_scene(std::string_view text, const SceneParts& parts) {
  return parse_scene(text, StabilityCheck::skip, SceneOrigin::job, parts);
}

std::string text_for_folder(const std::string& text, const SceneParts& parts) {
  const ParseResult now = parse_scene(text, StabilityCheck::skip, SceneOrigin::study, parts);
  if (!now.scene) return text;
  const ParseResult before = parse_job_scene(text, parts);
  auto scene = nlohmann::ordered_json::parse(text);
  bool as_it_is = !name_meshes(*now.scene, scene);
  if (!before.scene || numerics_json(before.scene->method) != numerics_json(now.scene->method)) {
    scene["numerics"]["scheme"] = word_for(kSchemeWords, Scheme::recommended);
    as_it_is = false;
  }
  if (as_it_is) return text;
  std::string named = scene.dump(2) + "\n";
  if (named.size() > kMaxSceneBytes) named = scene.dump();
  if (named.size() <= kMaxSceneBytes) return named;
  throw SceneError(
      {"", fmt::format("is {} bytes with the scheme that it means and the SHA-256 of its meshes, "
                       "which it does not name; at most {}: write \"scheme\": \"recommended\" in "
                       "numerics and shorten its curves and heights",
                       named.size(), kMaxSceneBytes)});
}

}  // namespace sluice

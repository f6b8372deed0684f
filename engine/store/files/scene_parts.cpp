#include "engine/store/files/scene_parts.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <set>
#include <utility>

#include "engine/scene/model/problems.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/sha256.hpp"

namespace sluice {
namespace {

std::string sha256_of(const std::string& bytes) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes)));
  return hash.finish();
}

ScenePart read_part(const std::filesystem::path& folder, const std::string& name, Links links) {
  const std::filesystem::path path = folder / name;
  const std::string beside = folder.empty() ? "this folder" : folder.string();
  try {
    if (!is_present(path)) {
      return {{}, {}, fmt::format("there is no such file in {}; put it there", beside)};
    }
    std::string bytes = read_text(path, kMaxMeshBytes, links);
    std::string sha256 = sha256_of(bytes);
    return {std::move(bytes), std::move(sha256)};
  } catch (const StorageError& error) {
    return {{}, {}, fmt::format("it cannot be read: {}", error.what())};
  }
}

}  // namespace

SceneParts parts_in(const std::filesystem::path& folder, Links links) {
  auto known = std::make_shared<std::map<std::string, ScenePart>>();
  return [=](const std::string& name) {
    const auto found = known->find(name);
    if (found != known->end()) return found->second;
    return known->emplace(name, read_part(folder, name, links)).first->second;
  };
}

SceneParts parts_from(std::vector<NamedPart> parts, std::string how_to_send) {
  auto known = std::make_shared<std::map<std::string, ScenePart>>();
  for (NamedPart& each : parts) {
    std::string sha256 = sha256_of(each.bytes);
    known->insert_or_assign(std::move(each.name),
                            ScenePart{std::move(each.bytes), std::move(sha256)});
  }
  return [known = std::move(known), how = std::move(how_to_send)](const std::string& name) {
    const auto found = known->find(name);
    if (found != known->end()) return found->second;
    return ScenePart{{}, {}, fmt::format("no file of that name came with the scene{}", how)};
  };
}

std::vector<NamedPart> parts_of(const Scene& scene, const SceneParts& parts) {
  std::set<std::string> names;
  const auto take = [&](const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape)) names.insert(mesh->file);
  };
  for (const FluidRegion& region : scene.fluid) take(region.shape);
  for (const Shape& obstacle : scene.obstacles) take(obstacle);
  std::vector<NamedPart> result;
  for (const std::string& name : names) result.push_back({name, parts(name).bytes});
  return result;
}

}  // namespace sluice

#include "cli/client/scene_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "cli/json_text.hpp"
#include "cli/scene_file.hpp"
#include "cli/verbs.hpp"
#include "engine/scene/format/text_rules.hpp"

namespace sluice {
namespace {

/// The files that shapes of a text name, as far as it is a scene.
std::set<std::string> files_named_in(const std::string& scene) {
  std::set<std::string> names;
  const auto document = nlohmann::ordered_json::parse(scene, nullptr, /*allow_exceptions=*/false);
  for (const char* list : {"fluid", "obstacles"}) {
    for (const auto& shape : member(document, list)) {
      const std::string name = text_at(shape, "file");
      if (are_allowed(name, Characters::mesh)) names.insert(name);
    }
  }
  return names;
}

/// A line that stands in none of the parts.
std::string boundary_for(const std::vector<NamedPart>& parts) {
  std::string boundary = "sluice-part";
  const auto is_in = [&](const NamedPart& part) {
    return part.bytes.find(boundary) != std::string::npos;
  };
  for (int k = 0; std::any_of(parts.begin(), parts.end(), is_in); ++k) {
    boundary = fmt::format("sluice-part-{}", k);
  }
  return boundary;
}

}  // namespace

SceneForm form_of(const std::string& scene, const std::filesystem::path& path) {
  const std::set<std::string> names = files_named_in(scene);
  if (names.empty()) return {"application/json", scene};
  const SceneParts beside = parts_beside(path);
  std::vector<NamedPart> parts{{"", scene}};
  for (const std::string& name : names) {
    ScenePart part = beside(name);
    if (!part.why_none.empty()) {
      throw CommandEnd(ExitCode::invalid_scene, fmt::format("{} names the mesh {}, but {}",
                                                            path.string(), name, part.why_none));
    }
    parts.push_back({name, std::move(part.bytes)});
  }
  const std::string boundary = boundary_for(parts);
  std::string body;
  for (const NamedPart& part : parts) {
    const std::string field = part.name.empty()
                                  ? "name=\"scene\""
                                  : fmt::format("name=\"mesh\"; filename=\"{}\"", part.name);
    body += fmt::format("--{}\r\nContent-Disposition: form-data; {}\r\n\r\n", boundary, field);
    body += part.bytes;
    body += "\r\n";
  }
  body += fmt::format("--{}--\r\n", boundary);
  return {"multipart/form-data; boundary=" + boundary, std::move(body)};
}

}  // namespace sluice

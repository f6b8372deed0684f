#pragma once

#include <string>

namespace sluice {

/// The JSON Schema 2020-12 of a scene, from the same description that the parser reads by:
/// schemas/scene.schema.json is this text. What relates two keys (fluid inside the tank, unique
/// names) is beyond it and left to parse_scene().
[[nodiscard]] std::string scene_schema_text();

}  // namespace sluice

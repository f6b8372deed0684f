#pragma once

#include <functional>
#include <string>

namespace sluice {

/// A file that a scene names, such as a mesh; or why there is none, and what to do about it.
struct ScenePart {
  std::string bytes;
  std::string sha256;  ///< in hexadecimal digits
  std::string why_none = {};
};

/// Gives the part of this name. What a scene names has no folder in it, and is never a path of the
/// machine that reads it: who hands over a scene's text knows where its parts are.
using SceneParts = std::function<ScenePart(const std::string& name)>;

/// Of a scene that came without any.
[[nodiscard]] inline ScenePart no_parts(const std::string& /*name*/) {
  return {{}, {}, "no file came with the scene"};
}

}  // namespace sluice

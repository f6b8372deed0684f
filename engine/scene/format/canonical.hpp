#pragma once

#include <string>

#include "engine/scene/model/scene.hpp"

namespace sluice {

/// The whole scene as one line of JSON with every default filled in: keys sorted, numbers in the
/// shortest form that reads back to the same double. Parsing it gives an equal scene, and equal
/// scenes give equal text. Needs a scene that parse_scene() could have made.
[[nodiscard]] std::string canonical_text(const Scene& scene);

/// The same without name, description, end time, reference and times of pictures: what a checkpoint
/// is bound to. A run may be renamed, extended and looked at in another way, nothing more.
[[nodiscard]] std::string identity_text(const Scene& scene);

}  // namespace sluice

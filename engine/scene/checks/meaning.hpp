#pragma once

#include <optional>
#include <string>

#include "engine/scene/format/written_scene.hpp"

namespace sluice {

/// A scene that names no scheme, read in each way that it can be meant.
struct Meanings {
  const WrittenScene& recommended;  ///< the scheme recommended with the keys that are named
  const WrittenScene& paper;        ///< the scheme paper with them
  const WrittenScene& before;       ///< no scheme: what versions that knew none read
};

/// Whether the scene meant another method before there were schemes than it does now, and one that
/// worked: it had a stable step and was not refused as unstable. Answers no where the documents
/// cannot be resolved: what is wrong with them is found elsewhere.
[[nodiscard]] bool has_two_meanings(const Meanings& meanings);

/// What to write for the one and for the other.
[[nodiscard]] std::string how_to_tell(const Meanings& meanings);

}  // namespace sluice

#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/model/problems.hpp"

namespace sluice {

/// A key that had another name before: two JSON pointers into one object.
struct FormerWord {
  std::string_view former;
  std::string_view present;
};

/// Every key of a scene that was renamed. A scene may go on using the former name, and checkpoints
/// are bound to a text that has it (identity_text()).
inline constexpr FormerWord kFormerSceneWords[] = {
    {"/numerics/wall_friction", "/numerics/wall_artificial_viscosity"},
    {"/numerics/physical_viscosity", "/numerics/laminar_viscosity"},
    {"/numerics/wall_drag", "/numerics/wall_shear"},
    {"/jitter", "/perturbation"},
};

/// Gives the keys of a document that stand under a former name their present one, word by word, and
/// returns which those were. A key that stands under both is a problem, and keeps its present
/// value.
std::vector<FormerWord> use_present_words(nlohmann::json& document,
                                          std::span<const FormerWord> words, Problems& problems);

/// The other way round, for every key there is.
void use_former_words(nlohmann::json& document, std::span<const FormerWord> words);

/// A pointer with present names: /numerics/wall_drag/coefficient becomes
/// /numerics/wall_shear/coefficient.
[[nodiscard]] std::string present_pointer(std::string_view pointer,
                                          std::span<const FormerWord> words);

/// Problems of a document in which use_present_words() found `used`, at the places that the user
/// wrote.
[[nodiscard]] std::vector<Problem> at_written_places(std::vector<Problem> problems,
                                                     const std::vector<FormerWord>& used);

}  // namespace sluice

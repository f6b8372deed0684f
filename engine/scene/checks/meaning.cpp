#include "engine/scene/checks/meaning.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/scene/forecast/stability.hpp"
#include "engine/scene/format/describe.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/numerics_json.hpp"

namespace sluice {
namespace {

using nlohmann::json;

/// Whether such a scene was accepted and could run before there were schemes, in the plane only.
bool worked(const WrittenScene& written) {
  const auto& tank = written.scene.tank;
  if (written.scene.dimensions() != kPlaneDim || (tank && tank->depth)) return false;
  const bool falls = written.gravity && !written.gravity->isZero(0.0);
  if (written.scene.fluid.empty() || !(falls || written.sound_speed)) return false;
  const Scene scene = resolve(written);
  if (!kSoundSpeed.contains(scene.method.sound_speed)) return false;
  const StabilityPrediction p = predict_stability(scene);
  return p.courant_limit > 0.0 && p.outlook != Outlook::unstable;
}

/// The keys beside which `scheme` means `wanted`, as a part of a JSON object.
struct Spelling {
  std::string text;
  std::size_t keys = 0;
};
Spelling spell(std::string_view scheme, const json& now, const json& wanted) {
  Spelling spelling{fmt::format("\"scheme\": \"{}\"", scheme)};
  for (const auto& [key, value] : wanted.items()) {
    if (value == now[key]) continue;
    spelling.text += fmt::format(", \"{}\": {}", key, write_json(value));
    ++spelling.keys;
  }
  return spelling;
}

}  // namespace

bool has_two_meanings(const Meanings& meanings) {
  return numerics_json(meanings.recommended.scene.method) !=
             numerics_json(meanings.before.scene.method) &&
         worked(meanings.before);
}

std::string how_to_tell(const Meanings& meanings) {
  const json wanted = numerics_json(meanings.before.scene.method);
  const Spelling near =
      spell("recommended", numerics_json(meanings.recommended.scene.method), wanted);
  const Spelling far = spell("paper", numerics_json(meanings.paper.scene.method), wanted);
  return fmt::format(
      "names no scheme: what it leaves out is now that of the scheme recommended, but was left out "
      "before there were schemes; write \"scheme\": \"recommended\" for the former, or {} to keep "
      "the latter",
      far.keys < near.keys ? far.text : near.text);
}

}  // namespace sluice

#include "engine/scene/format/canonical.hpp"

#include "engine/scene/format/describe.hpp"
#include "engine/scene/format/former_words.hpp"
#include "engine/scene/format/json_text.hpp"
#include "engine/scene/format/writer.hpp"

namespace sluice {
namespace {

nlohmann::json to_json(const Scene& scene) {
  WrittenScene written(scene);
  Writer writer;
  describe(writer, written);
  return writer.object();
}

}  // namespace

std::string canonical_text(const Scene& scene) { return write_json(to_json(scene)); }

std::string identity_text(const Scene& scene) {
  Scene run = scene;
  run.pictures.clear();
  nlohmann::json object = to_json(run);
  for (const char* key : {"name", "description", "end_time", "reference"}) object.erase(key);
  // A term that is left out has no key: checkpoints are older than the null that says so.
  nlohmann::json& numerics = object["numerics"];
  for (auto each = numerics.begin(); each != numerics.end();) {
    each = each->is_null() ? numerics.erase(each) : std::next(each);
  }
  use_former_words(object, kFormerSceneWords);
  return write_json(object);
}

std::string_view to_string(SensorKind kind) { return word_for(kSensorWords, kind); }

}  // namespace sluice

#include "engine/scene/format/numerics_json.hpp"

#include "engine/scene/format/describe.hpp"
#include "engine/scene/format/writer.hpp"

namespace sluice {

nlohmann::json numerics_json(const Method& method) {
  Scene scene;
  scene.method = method;
  Writer writer;
  describe_numerics(writer, scene);
  return writer.object();
}

bool takes_null(std::string_view pointer) {
  constexpr std::string_view kNumerics = "/numerics/";
  if (!pointer.starts_with(kNumerics)) return false;
  // A fresh method has no term.
  const nlohmann::json none = numerics_json(Method{});
  const auto found = none.find(pointer.substr(kNumerics.size()));
  return found != none.end() && found->is_null();
}

}  // namespace sluice

#include "engine/scene/parse.hpp"

#include "engine/scene/check.hpp"
#include "engine/scene/describe.hpp"
#include "engine/scene/json_text.hpp"
#include "engine/scene/reader.hpp"

namespace sluice {

ParseResult parse_scene(std::string_view text, StabilityCheck stability) {
  Problems problems;
  const auto json = read_json(text, problems);
  if (!json) return {std::nullopt, problems.take()};

  Document document;
  Reader reader(*json, "", problems);
  describe(reader, document);
  reader.finish();
  if (json->is_object()) check(document, stability, problems);

  if (!problems.empty()) return {std::nullopt, problems.take()};
  return {resolve(document), {}};
}

}  // namespace sluice

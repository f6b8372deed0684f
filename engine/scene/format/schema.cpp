#include "engine/scene/format/schema.hpp"

#include <fmt/format.h>

#include <ranges>

#include "engine/scene/format/describe.hpp"
#include "engine/scene/format/former_words.hpp"
#include "engine/scene/format/schema_writer.hpp"
#include "engine/scene/format/text_rules.hpp"
#include "engine/scene/model/problems.hpp"

namespace sluice {
namespace {

/// Where a schema describes the key with this JSON pointer.
SchemaWriter::json::json_pointer in_schema(std::string_view key) {
  SchemaWriter::json::json_pointer place;
  for (std::string_view rest = key.substr(1);;) {
    const std::size_t end = rest.find('/');
    place = place / "properties" / std::string(rest.substr(0, end));
    if (end == rest.npos) return place;
    rest.remove_prefix(end + 1);
  }
}

}  // namespace

std::string SchemaWriter::about(std::string_view about, std::string_view otherwise) {
  std::string text{about};
  if (!otherwise.empty()) text += ". Left out: " + std::string(otherwise);
  return text;
}

// What allows one number; for a vector this holds for each component.
SchemaWriter::json SchemaWriter::describe_number(const NumberSpec& spec) {
  json schema = {{"type", "number"}};
  const bool excluded = spec.range.low_end == Range::Low::excluded;
  schema[excluded ? "exclusiveMinimum" : "minimum"] = spec.range.low;
  schema["maximum"] = spec.range.high;
  return schema;
}

SchemaWriter::json SchemaWriter::describe_vector(const NumberSpec& spec, int least, int most) {
  return {{"description", about(spec.about, spec.otherwise)},
          {"x-unit", spec.unit},
          {"type", "array"},
          {"items", describe_number(spec)},
          {"minItems", least},
          {"maxItems", most}};
}

void SchemaWriter::put(std::string_view key, json property, Need need) {
  if (need == Need::required) required_.push_back(key);
  properties_[std::string(key)] = std::move(property);
}

void SchemaWriter::put_list(std::string_view key, json items, const ListSpec& spec) {
  put(key,
      {{"description", spec.about},
       {"type", "array"},
       {"items", std::move(items)},
       {"minItems", spec.min},
       {"maxItems", spec.max}},
      spec.need);
}

void SchemaWriter::number(std::string_view key, double& member, const NumberSpec& spec) {
  std::optional<double> none;
  number(key, none, spec);
  if (spec.need == Need::optional) properties_[std::string(key)]["default"] = member;
}

void SchemaWriter::number(std::string_view key, std::optional<double>& /*member*/,
                          const NumberSpec& spec) {
  json property = {{"description", about(spec.about, spec.otherwise)}, {"x-unit", spec.unit}};
  property.update(describe_number(spec));
  put(key, std::move(property), spec.need);
}

void SchemaWriter::integer(std::string_view key, int& member, const NumberSpec& spec) {
  std::optional<int> none;
  integer(key, none, spec);
  if (spec.need == Need::optional) properties_[std::string(key)]["default"] = member;
}

void SchemaWriter::integer(std::string_view key, std::optional<int>& /*member*/,
                           const NumberSpec& spec) {
  std::optional<double> none;
  number(key, none, spec);
  properties_[std::string(key)]["type"] = "integer";
}

void SchemaWriter::flag(std::string_view key, bool& member, const KeySpec& spec) {
  json property = {{"description", about(spec.about, spec.otherwise)}, {"type", "boolean"}};
  if (spec.need == Need::optional) property["default"] = member;
  put(key, std::move(property), spec.need);
}

void SchemaWriter::text(std::string_view key, std::string& member, const TextSpec& spec) {
  json property = {{"description", spec.about},
                   {"type", "string"},
                   {"minLength", spec.min},
                   {"maxLength", spec.max},
                   {"pattern", allowed_pattern(spec.characters)}};
  // What is too short for a text to be given stands for none.
  if (spec.need == Need::optional && member.size() >= spec.min) property["default"] = member;
  put(key, std::move(property), spec.need);
}

void SchemaWriter::vector(std::string_view key, Vec& /*member*/, const NumberSpec& spec) {
  put(key, describe_vector(spec, kPlaneDim, kMostDim), spec.need);
}

void SchemaWriter::vector(std::string_view key, std::optional<Vec>& /*member*/,
                          const NumberSpec& spec) {
  put(key, describe_vector(spec, kPlaneDim, kMostDim), spec.need);
}

void SchemaWriter::points(std::string_view key, std::vector<Vec2>& /*member*/, const ListSpec& spec,
                          const NumberSpec& point) {
  put_list(key, describe_vector(point, 2, 2), spec);
}

void SchemaWriter::numbers(std::string_view key, std::vector<double>& /*member*/,
                           const ListSpec& spec, const NumberSpec& each) {
  put_list(key, describe_number(each), spec);
}

void SchemaWriter::rows(std::string_view key, std::vector<std::vector<double>>& /*member*/,
                        const ListSpec& spec, const NumberSpec& each) {
  put_list(key,
           {{"type", "array"},
            {"items", describe_number(each)},
            {"minItems", spec.min},
            {"maxItems", spec.max}},
           spec);
  properties_[std::string(key)]["x-unit"] = each.unit;
}

void SchemaWriter::any(std::string_view key, nlohmann::json& /*member*/, const KeySpec& spec,
                       std::initializer_list<std::string_view> types) {
  json allowed = json::array();
  for (const std::string_view type : types) allowed.push_back(type);
  json property = {{"description", about(spec.about, spec.otherwise)}};
  property["type"] = allowed.size() == 1 ? allowed.front() : allowed;
  put(key, std::move(property), spec.need);
}

SchemaWriter::json SchemaWriter::schema() const {
  if (!branches_.empty()) return {{"oneOf", branches_}};
  json result = {{"type", "object"}, {"properties", properties_}};
  if (!required_.empty()) result["required"] = required_;
  result["additionalProperties"] = false;
  return result;
}

void add_former_words(SchemaWriter::json& schema, std::span<const FormerWord> words) {
  for (const FormerWord& word : words | std::views::reverse) {
    SchemaWriter::json property = schema[in_schema(word.present)];
    property["description"] = fmt::format("former name of {}", word.present);
    property["deprecated"] = true;
    schema[in_schema(word.former)] = std::move(property);
  }
}

std::string scene_schema_text() {
  WrittenScene fresh;
  SchemaWriter writer;
  describe(writer, fresh);
  SchemaWriter::json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"$id", "urn:sluice:scene:1"},
      {"title", "Sluice scene"},
      {"description",
       "What to simulate. Lengths in m, times in s, SI units throughout; x to the right, y up, in "
       "space z towards the viewer. Vectors have a number for each dimension of the scene. A "
       "key that is left out is a term that is left out, or has the default given here."}};
  schema.update(writer.schema());
  add_former_words(schema, kFormerSceneWords);
  return schema.dump(2) + "\n";
}

}  // namespace sluice

#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/scene/format/former_words.hpp"
#include "engine/scene/model/spec.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// Archive that writes the JSON Schema of the object that describe() names. Members are taken from
/// fresh structs: an optional key's value is its default.
class SchemaWriter {
 public:
  using json = nlohmann::ordered_json;

  void number(std::string_view key, double& member, const NumberSpec& spec);
  void number(std::string_view key, std::optional<double>& member, const NumberSpec& spec);
  void integer(std::string_view key, int& member, const NumberSpec& spec);
  void integer(std::string_view key, std::optional<int>& member, const NumberSpec& spec);
  void flag(std::string_view key, bool& member, const KeySpec& spec);
  void text(std::string_view key, std::string& member, const TextSpec& spec);
  void vector(std::string_view key, Vec& member, const NumberSpec& spec);
  void vector(std::string_view key, std::optional<Vec>& member, const NumberSpec& spec);
  template <int Dim>
  void vector(std::string_view key, VecN<Dim>& /*member*/, const NumberSpec& spec) {
    put(key, describe_vector(spec, Dim, Dim), spec.need);
  }
  static constexpr bool kOfAllScenes = true;
  void fit(Vec& member) const { member = filled_vec<kAnyDim>(0.0, kMostDim); }
  void require_dimensions(std::string_view, int) {}
  void points(std::string_view key, std::vector<Vec2>& member, const ListSpec& spec,
              const NumberSpec& point);
  void numbers(std::string_view key, std::vector<double>& member, const ListSpec& spec,
               const NumberSpec& each);
  void rows(std::string_view key, std::vector<std::vector<double>>& member, const ListSpec& spec,
            const NumberSpec& each);
  void any(std::string_view key, nlohmann::json& member, const KeySpec& spec,
           std::initializer_list<std::string_view> types);

  template <class Enum, std::size_t n>
  void word(std::string_view key, const Words<Enum, n>& words, Enum& member, const KeySpec& spec) {
    std::string about{spec.about};
    json allowed = json::array();
    for (const auto& each : words) {
      about += allowed.empty() ? ". " : "; ";
      about += std::string(each.word) + ": " + std::string(each.about);
      allowed.push_back(each.word);
    }
    json property = {{"description", about}, {"enum", std::move(allowed)}};
    if (spec.need == Need::optional) property["default"] = word_for(words, member);
    put(key, std::move(property), spec.need);
  }

  template <class Enum, std::size_t n>
  void word(std::string_view key, const Words<Enum, n>& words, std::optional<Enum>& member,
            const KeySpec& spec) {
    Enum value = member.value_or(words.front().value);
    word(key, words, value, spec);
  }

  /// One branch of a oneOf for each word, told apart by the constant under `key`.
  template <class Enum, std::size_t n, class More>
  void choice(std::string_view key, const Words<Enum, n>& words, Enum /*current*/,
              std::string_view about, const More& more) {
    for (const auto& each : words) {
      SchemaWriter branch;
      branch.put(key, {{"description", about}, {"const", each.word}}, Need::required);
      more(branch, each.value);
      json schema = {{"title", each.word}};
      if (!each.about.empty()) schema["description"] = each.about;
      schema.update(branch.schema());
      branches_.push_back(std::move(schema));
    }
  }

  template <class More>
  void section(std::string_view key, const KeySpec& spec, const More& more) {
    SchemaWriter child;
    more(child);
    json property = {{"description", about(spec.about, spec.otherwise)}};
    property.update(child.schema());
    put(key, std::move(property), spec.need);
  }

  template <class T>
  void section(std::string_view key, std::optional<T>& /*member*/, const KeySpec& spec) {
    section(key, spec, [](SchemaWriter& child) {
      T fresh{};
      describe(child, fresh);
    });
  }

  /// An object or null; the member's values are the defaults of its keys.
  template <class T>
  void term(std::string_view key, std::optional<T>& member, const KeySpec& spec) {
    SchemaWriter child;
    T value = member.value_or(T{});
    describe(child, value);
    json property = {
        {"description",
         about(spec.about, member ? "the scheme's" : "the scheme's, none") + "; null: none"}};
    property.update(child.schema());
    property["type"] = {"object", "null"};
    put(key, std::move(property), spec.need);
  }

  template <class T>
  void list(std::string_view key, std::vector<T>& /*member*/, const ListSpec& spec) {
    SchemaWriter child;
    T fresh{};
    describe(child, fresh);
    put_list(key, child.schema(), spec);
  }

  /// {type: object, properties, required, additionalProperties: false}, or the oneOf of a choice.
  [[nodiscard]] json schema() const;

 private:
  static std::string about(std::string_view about, std::string_view otherwise);
  static json describe_number(const NumberSpec& spec);
  /// An array of at least and at most so many numbers.
  static json describe_vector(const NumberSpec& spec, int least, int most);
  void put(std::string_view key, json property, Need need);
  void put_list(std::string_view key, json items, const ListSpec& spec);

  json properties_ = json::object();
  json required_ = json::array();
  json branches_ = json::array();
};

/// Lets the schema of a document take its keys' former names, as deprecated. A word that renames
/// the section of another stands after it.
void add_former_words(SchemaWriter::json& schema, std::span<const FormerWord> words);

}  // namespace sluice

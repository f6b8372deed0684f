#pragma once

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/format/json_text.hpp"
#include "engine/scene/model/problems.hpp"
#include "engine/scene/model/spec.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// Archive that reads one JSON object into the members that describe() names. A member whose value
/// is missing or wrong keeps its default, and the reason goes to `problems`.
class Reader {
 public:
  /// What a scene lets have two or three components has `dimensions`.
  Reader(const nlohmann::json& value, std::string pointer, Problems& problems,
         int dimensions = kPlaneDim);

  /// An archive that describes all scenes knows no number of dimensions.
  static constexpr bool kOfAllScenes = false;
  /// Gives a vector as many components as the scene has dimensions.
  void fit(Vec& member) const;
  /// Reports the word of `key` where what it names is of another number of dimensions.
  void require_dimensions(std::string_view key, int dimensions);

  void number(std::string_view key, double& member, const NumberSpec& spec);
  void number(std::string_view key, std::optional<double>& member, const NumberSpec& spec);
  void integer(std::string_view key, int& member, const NumberSpec& spec);
  void integer(std::string_view key, std::optional<int>& member, const NumberSpec& spec);
  void flag(std::string_view key, bool& member, const KeySpec& spec);
  void text(std::string_view key, std::string& member, const TextSpec& spec);
  void vector(std::string_view key, Vec& member, const NumberSpec& spec);
  void vector(std::string_view key, std::optional<Vec>& member, const NumberSpec& spec);
  template <int Dim>
  void vector(std::string_view key, VecN<Dim>& member, const NumberSpec& spec) {
    const nlohmann::json* found = find(key, spec.need, spec.about);
    if (found == nullptr) return;
    if (const auto value = read_vector(*found, at(pointer_, key), spec, Dim)) member = *value;
  }
  void points(std::string_view key, std::vector<Vec2>& member, const ListSpec& spec,
              const NumberSpec& point);
  void numbers(std::string_view key, std::vector<double>& member, const ListSpec& spec,
               const NumberSpec& each);
  /// Rows of numbers, as many in each, of which `spec` says how many there may be both ways.
  void rows(std::string_view key, std::vector<std::vector<double>>& member, const ListSpec& spec,
            const NumberSpec& each);
  /// Any value whose type is one of `types`: "object", "array", "string".
  void any(std::string_view key, nlohmann::json& member, const KeySpec& spec,
           std::initializer_list<std::string_view> types);

  template <class Enum, std::size_t n>
  void word(std::string_view key, const Words<Enum, n>& words, Enum& member, const KeySpec& spec) {
    const nlohmann::json* found = find(key, spec.need, spec.about);
    if (found == nullptr) return;
    if (const auto value = pick(*found, at(pointer_, key), words)) member = *value;
  }

  template <class Enum, std::size_t n>
  void word(std::string_view key, const Words<Enum, n>& words, std::optional<Enum>& member,
            const KeySpec& spec) {
    const nlohmann::json* found = find(key, spec.need, spec.about);
    if (found == nullptr) return;
    if (const auto value = pick(*found, at(pointer_, key), words)) member = *value;
  }

  /// The keys that belong to the word of `key` are described by `more(*this, word)`.
  template <class Enum, std::size_t n, class More>
  void choice(std::string_view key, const Words<Enum, n>& words, Enum /*current*/,
              std::string_view about, const More& more) {
    const nlohmann::json* found = find(key, Need::required, about);
    const auto value = found == nullptr ? std::nullopt : pick(*found, at(pointer_, key), words);
    if (value) {
      more(*this, *value);
    } else {
      any_key_ = true;  // which keys belong here hangs on the word
    }
  }

  template <class More>
  void section(std::string_view key, const KeySpec& spec, const More& more) {
    if (const nlohmann::json* found = find(key, spec.need, spec.about)) enter(*found, key, more);
  }

  template <class T>
  void section(std::string_view key, std::optional<T>& member, const KeySpec& spec) {
    section(key, spec, [&](Reader& child) { describe(child, member.emplace()); });
  }

  /// A section that null leaves out. What it does not name keeps the member's value.
  template <class T>
  void term(std::string_view key, std::optional<T>& member, const KeySpec& spec) {
    const nlohmann::json* found = find(key, spec.need, spec.about);
    if (found == nullptr) return;
    if (found->is_null()) {
      member.reset();
      return;
    }
    enter(*found, key,
          [&](Reader& child) { describe(child, member ? *member : member.emplace()); });
  }

  template <class T>
  void list(std::string_view key, std::vector<T>& member, const ListSpec& spec) {
    const nlohmann::json* found = find_list(key, spec);
    if (found == nullptr) return;
    for (std::size_t i = 0; i < found->size(); ++i) {
      Reader child((*found)[i], at(at(pointer_, key), i), problems_, dimensions_);
      describe(child, member.emplace_back());
      child.finish();
    }
  }

  /// Reports every key that was not asked for. To be called once, after describe().
  void finish();

 private:
  using json = nlohmann::json;

  const json* find(std::string_view key, Need need, std::string_view about);
  const json* find_list(std::string_view key, const ListSpec& spec);
  std::optional<double> read_number(const json& value, const std::string& pointer,
                                    const NumberSpec& spec);
  std::optional<Vec> read_vector(const json& value, const std::string& pointer,
                                 const NumberSpec& spec, int dimensions);
  std::optional<std::string> pick_word(const json& value, const std::string& pointer,
                                       std::span<const std::string_view> words);

  template <class Enum, std::size_t n>
  std::optional<Enum> pick(const json& value, const std::string& pointer,
                           const Words<Enum, n>& words) {
    std::array<std::string_view, n> allowed;
    for (std::size_t i = 0; i < n; ++i) allowed[i] = words[i].word;
    const auto picked = pick_word(value, pointer, allowed);
    for (const auto& each : words) {
      if (picked && each.word == *picked) return each.value;
    }
    return std::nullopt;
  }

  template <class More>
  void enter(const json& value, std::string_view key, const More& more) {
    Reader child(value, at(pointer_, key), problems_, dimensions_);
    more(child);
    child.finish();
  }

  const json& value_;
  std::string pointer_;
  Problems& problems_;
  int dimensions_;
  std::vector<std::string_view> known_;
  bool is_object_ = true;
  bool any_key_ = false;
};

}  // namespace sluice

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/model/spec.hpp"
#include "engine/space/vec.hpp"

namespace sluice {

/// Archive that writes the members that describe() names into a JSON object. Optional members
/// without a value (but terms), empty lists that need not be there and sections without keys are
/// left out.
class Writer {
 public:
  void number(std::string_view key, double& member, const NumberSpec&) { put(key, member); }
  void number(std::string_view key, std::optional<double>& member, const NumberSpec&) {
    if (member) put(key, *member);
  }
  void integer(std::string_view key, int& member, const NumberSpec&) { put(key, member); }
  void integer(std::string_view key, std::optional<int>& member, const NumberSpec&) {
    if (member) put(key, *member);
  }
  void flag(std::string_view key, bool& member, const KeySpec&) { put(key, member); }
  void text(std::string_view key, std::string& member, const TextSpec&) { put(key, member); }
  template <int Dim>
  void vector(std::string_view key, VecN<Dim>& member, const NumberSpec&) {
    put(key, json(member));
  }
  void vector(std::string_view key, std::optional<Vec>& member, const NumberSpec&) {
    if (member) put(key, json(*member));
  }
  static constexpr bool kOfAllScenes = false;
  void fit(Vec&) const {}
  void require_dimensions(std::string_view, int) {}
  void points(std::string_view key, std::vector<Vec2>& member, const ListSpec&, const NumberSpec&) {
    json all = json::array();
    for (const Vec2& each : member) all.push_back(json(each));
    put(key, std::move(all));
  }
  void numbers(std::string_view key, std::vector<double>& member, const ListSpec& spec,
               const NumberSpec&) {
    if (!member.empty() || spec.need == Need::required) put(key, member);
  }

  void rows(std::string_view key, std::vector<std::vector<double>>& member, const ListSpec&,
            const NumberSpec&) {
    put(key, member);
  }

  template <class Enum, std::size_t n>
  void word(std::string_view key, const Words<Enum, n>& words, Enum& member, const KeySpec&) {
    put(key, word_for(words, member));
  }

  template <class Enum, std::size_t n>
  void word(std::string_view key, const Words<Enum, n>& words, std::optional<Enum>& member,
            const KeySpec&) {
    if (member) put(key, word_for(words, *member));
  }

  template <class Enum, std::size_t n, class More>
  void choice(std::string_view key, const Words<Enum, n>& words, Enum current, std::string_view,
              const More& more) {
    put(key, word_for(words, current));
    more(*this, current);
  }

  template <class More>
  void section(std::string_view key, const KeySpec&, const More& more) {
    Writer child;
    more(child);
    if (!child.object_.empty()) put(key, std::move(child.object_));
  }

  template <class T>
  void section(std::string_view key, std::optional<T>& member, const KeySpec& spec) {
    if (member) section(key, spec, [&](Writer& child) { describe(child, *member); });
  }

  /// null where it is left out: a missing one would be the scheme's.
  template <class T>
  void term(std::string_view key, std::optional<T>& member, const KeySpec& spec) {
    section(key, member, spec);
    if (!member) put(key, nullptr);
  }

  template <class T>
  void list(std::string_view key, std::vector<T>& member, const ListSpec& spec) {
    if (member.empty() && spec.need == Need::optional) return;
    json all = json::array();
    for (T& each : member) {
      Writer child;
      describe(child, each);
      all.push_back(std::move(child.object_));
    }
    put(key, std::move(all));
  }

  [[nodiscard]] const nlohmann::json& object() const { return object_; }

 private:
  using json = nlohmann::json;

  void put(std::string_view key, json value) { object_[std::string(key)] = std::move(value); }

  json object_ = json::object();
};

}  // namespace sluice

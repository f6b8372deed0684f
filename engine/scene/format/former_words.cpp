#include "engine/scene/format/former_words.hpp"

#include <fmt/format.h>

#include <ranges>
#include <utility>

namespace sluice {
namespace {

using nlohmann::json;

/// The object that holds the key a pointer names, and the key; null where there is none.
struct Place {
  json* object = nullptr;
  std::string key;
};
Place place_of(json& document, std::string_view pointer) {
  json::json_pointer parent{std::string(pointer)};
  std::string key = parent.back();
  parent.pop_back();
  if (!document.contains(parent) || !document[parent].is_object()) return {nullptr, key};
  return {&document[parent], std::move(key)};
}

/// Moves the value of key `from` to key `to` of the same object. False where there is none.
bool rename(json& document, std::string_view from, std::string_view to) {
  const Place place = place_of(document, from);
  if (place.object == nullptr || !place.object->contains(place.key)) return false;
  const std::string name{to.substr(to.rfind('/') + 1)};
  if (!place.object->contains(name)) (*place.object)[name] = (*place.object)[place.key];
  place.object->erase(place.key);
  return true;
}

bool is_at_or_below(std::string_view pointer, std::string_view key) {
  return pointer.starts_with(key) && (pointer.size() == key.size() || pointer[key.size()] == '/');
}

bool has_both(json& document, const FormerWord& word) {
  const Place former = place_of(document, word.former);
  const Place present = place_of(document, word.present);
  return former.object != nullptr && former.object->contains(former.key) &&
         present.object->contains(present.key);
}

}  // namespace

std::vector<FormerWord> use_present_words(json& document, std::span<const FormerWord> words,
                                          Problems& problems) {
  std::vector<FormerWord> used;
  for (const FormerWord& word : words) {
    if (has_both(document, word)) {
      problems.add(std::string(word.former),
                   fmt::format("is the former name of {}, which stands there too: leave one out",
                               word.present));
    }
    if (rename(document, word.former, word.present)) used.push_back(word);
  }
  return used;
}

void use_former_words(json& document, std::span<const FormerWord> words) {
  for (const FormerWord& word : words) rename(document, word.present, word.former);
}

std::string present_pointer(std::string_view pointer, std::span<const FormerWord> words) {
  for (const FormerWord& word : words) {
    if (!is_at_or_below(pointer, word.former)) continue;
    return std::string(word.present) + std::string(pointer.substr(word.former.size()));
  }
  return std::string(pointer);
}

std::vector<Problem> at_written_places(std::vector<Problem> problems,
                                       const std::vector<FormerWord>& used) {
  for (Problem& problem : problems) {
    for (const FormerWord& word : used | std::views::reverse) {
      if (!is_at_or_below(problem.pointer, word.present)) continue;
      problem.pointer = std::string(word.former) + problem.pointer.substr(word.present.size());
    }
  }
  return problems;
}

}  // namespace sluice

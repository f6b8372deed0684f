#include "engine/scene/format/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/format/code_points.hpp"
#include "engine/scene/format/text_rules.hpp"

namespace sluice {
Reader::Reader(const json& value, std::string pointer, Problems& problems, int dimensions)
    : value_(value), pointer_(std::move(pointer)), problems_(problems), dimensions_(dimensions) {
  is_object_ = value.is_object();
  if (!is_object_) {
    problems_.add(pointer_, fmt::format("is {}; must be an object", name_value(value)));
  }
}

const nlohmann::json* Reader::find(std::string_view key, Need need, std::string_view about) {
  known_.push_back(key);
  if (!is_object_) return nullptr;
  if (const auto found = value_.find(key); found != value_.end()) return &*found;
  if (need == Need::required) {
    problems_.add(at(pointer_, key), fmt::format("is missing; must be given: {}", about));
  }
  return nullptr;
}

const nlohmann::json* Reader::find_list(std::string_view key, const ListSpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return nullptr;
  const std::string allowed = fmt::format("an array of {} to {} entries", spec.min, spec.max);
  if (!found->is_array() || found->size() < spec.min || found->size() > spec.max) {
    problems_.add(at(pointer_, key), fmt::format("is {}; must be {}", name_value(*found), allowed));
    return nullptr;
  }
  return found;
}

std::optional<double> Reader::read_number(const json& value, const std::string& pointer,
                                          const NumberSpec& spec) {
  const std::string allowed = to_text(spec.range, spec.unit);
  if (!value.is_number()) {
    problems_.add(pointer, fmt::format("is {}; must be a number {}", name_value(value), allowed));
    return std::nullopt;
  }
  // Adding zero turns -0 into 0, so that equal scenes have equal bits.
  const double number = value.get<double>() + 0.0;
  if (!std::isfinite(number) || !spec.range.contains(number)) {
    problems_.add(pointer,
                  fmt::format("is {}; must be {}: {}", excerpt(value), allowed, spec.about));
    return std::nullopt;
  }
  return number;
}

std::optional<Vec> Reader::read_vector(const json& value, const std::string& pointer,
                                       const NumberSpec& spec, int dimensions) {
  const auto wanted = static_cast<std::size_t>(dimensions);
  if (!value.is_array() || value.size() != wanted) {
    const bool mixes = value.is_array() && (value.size() == 2 || value.size() == 3);
    problems_.add(pointer,
                  fmt::format("is {}; must be an array of {} numbers {}{}", name_value(value),
                              wanted, to_text(spec.range, spec.unit),
                              mixes ? fmt::format(", in a scene of {} dimensions", wanted) : ""));
    return std::nullopt;
  }
  Vec vector = filled_vec<kAnyDim>(0.0, dimensions);
  bool whole = true;
  for (std::size_t axis = 0; axis < wanted; ++axis) {
    const auto number = read_number(value[axis], at(pointer, axis), spec);
    whole = whole && number;
    vector[static_cast<Eigen::Index>(axis)] = number.value_or(0.0);
  }
  return whole ? std::optional(vector) : std::nullopt;
}

void Reader::fit(Vec& member) const {
  if (dimensions_of(member) != dimensions_) member = filled_vec<kAnyDim>(0.0, dimensions_);
}

void Reader::require_dimensions(std::string_view key, int dimensions) {
  if (dimensions == dimensions_) return;
  problems_.add(at(pointer_, key),
                fmt::format("is {}, which has {} dimensions; must have {}, as the scene",
                            excerpt(value_[std::string(key)]), dimensions, dimensions_));
}

std::optional<std::string> Reader::pick_word(const json& value, const std::string& pointer,
                                             std::span<const std::string_view> words) {
  if (!value.is_string()) {
    problems_.add(pointer,
                  fmt::format("is {}; must be a word, {}", name_value(value), hint("", words)));
    return std::nullopt;
  }
  const auto& word = value.get_ref<const std::string&>();
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    problems_.add(pointer, fmt::format("is {}; {}", excerpt(value), hint(word, words)));
    return std::nullopt;
  }
  return word;
}

void Reader::number(std::string_view key, double& member, const NumberSpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return;
  if (const auto value = read_number(*found, at(pointer_, key), spec)) member = *value;
}

void Reader::number(std::string_view key, std::optional<double>& member, const NumberSpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found != nullptr) member = read_number(*found, at(pointer_, key), spec);
}

void Reader::integer(std::string_view key, int& member, const NumberSpec& spec) {
  std::optional<int> read;
  integer(key, read, spec);
  member = read.value_or(member);
}

void Reader::integer(std::string_view key, std::optional<int>& member, const NumberSpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return;
  const auto value = read_number(*found, at(pointer_, key), spec);
  if (!value) return;
  if (*value != std::floor(*value)) {
    problems_.add(at(pointer_, key), fmt::format("is {}; must be a whole number {}",
                                                 excerpt(*found), to_text(spec.range, spec.unit)));
    return;
  }
  member = static_cast<int>(*value);
}

void Reader::flag(std::string_view key, bool& member, const KeySpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return;
  if (found->is_boolean()) {
    member = found->get<bool>();
  } else {
    problems_.add(at(pointer_, key),
                  fmt::format("is {}; must be true or false", name_value(*found)));
  }
}

void Reader::text(std::string_view key, std::string& member, const TextSpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return;
  const std::string allowed = fmt::format("a text of {} to {} characters, {}", spec.min, spec.max,
                                          allowed_text(spec.characters));
  const auto valid = [&](const std::string& text) {
    const std::size_t length = count_code_points(text);
    return length >= spec.min && length <= spec.max && are_allowed(text, spec.characters);
  };
  if (found->is_string() && valid(found->get_ref<const std::string&>())) {
    member = found->get<std::string>();
  } else {
    problems_.add(at(pointer_, key), fmt::format("is {}; must be {}", name_value(*found), allowed));
  }
}

void Reader::vector(std::string_view key, Vec& member, const NumberSpec& spec) {
  fit(member);
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return;
  if (const auto value = read_vector(*found, at(pointer_, key), spec, dimensions_)) member = *value;
}

void Reader::vector(std::string_view key, std::optional<Vec>& member, const NumberSpec& spec) {
  const json* found = find(key, spec.need, spec.about);
  if (found != nullptr) member = read_vector(*found, at(pointer_, key), spec, dimensions_);
}

void Reader::points(std::string_view key, std::vector<Vec2>& member, const ListSpec& spec,
                    const NumberSpec& point) {
  const json* found = find_list(key, spec);
  if (found == nullptr) return;
  for (std::size_t i = 0; i < found->size(); ++i) {
    if (const auto value = read_vector((*found)[i], at(at(pointer_, key), i), point, 2)) {
      member.push_back(*value);
    }
  }
}

void Reader::numbers(std::string_view key, std::vector<double>& member, const ListSpec& spec,
                     const NumberSpec& each) {
  const json* found = find_list(key, spec);
  if (found == nullptr) return;
  for (std::size_t i = 0; i < found->size(); ++i) {
    if (const auto value = read_number((*found)[i], at(at(pointer_, key), i), each)) {
      member.push_back(*value);
    }
  }
}

void Reader::rows(std::string_view key, std::vector<std::vector<double>>& member,
                  const ListSpec& spec, const NumberSpec& each) {
  const json* found = find_list(key, spec);
  if (found == nullptr) return;
  for (std::size_t j = 0; j < found->size(); ++j) {
    const json& row = (*found)[j];
    const std::string pointer = at(at(pointer_, key), j);
    const json& first = found->front();
    if (!row.is_array() || row.size() < spec.min || row.size() > spec.max) {
      problems_.add(pointer, fmt::format("is {}; must be a row of {} to {} numbers",
                                         name_value(row), spec.min, spec.max));
    } else if (first.is_array() && row.size() != first.size()) {
      problems_.add(pointer, fmt::format("has {} numbers; must have as many as the first row, {}",
                                         row.size(), first.size()));
    }
    std::vector<double>& numbers = member.emplace_back();
    for (std::size_t i = 0; row.is_array() && i < row.size(); ++i) {
      numbers.push_back(read_number(row[i], at(pointer, i), each).value_or(0.0));
    }
  }
}

void Reader::any(std::string_view key, json& member, const KeySpec& spec,
                 std::initializer_list<std::string_view> types) {
  const json* found = find(key, spec.need, spec.about);
  if (found == nullptr) return;
  if (std::find(types.begin(), types.end(), std::string_view(found->type_name())) != types.end()) {
    member = *found;
    return;
  }
  problems_.add(at(pointer_, key), fmt::format("is {}; must be of type {}: {}", name_value(*found),
                                               fmt::join(types, " or "), spec.about));
}

void Reader::finish() {
  if (!is_object_ || any_key_) return;
  for (const auto& [key, value] : value_.items()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    problems_.add(at(pointer_, key), fmt::format("unknown key; {}", hint(key, known_)));
  }
}

}  // namespace sluice

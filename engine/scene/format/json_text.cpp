#include "engine/scene/format/json_text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sluice {
namespace {

using nlohmann::json;

/// Builds the tree from the parser's events and stops it where a limit is broken. The tree is never
/// deeper than kMaxSceneDepth, so nothing that walks or copies it can run out of stack.
template <class Json>
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(Json& root, Problems& problems) : root_(root), problems_(problems) {}

  bool null() override { return value(nullptr); }
  bool boolean(bool v) override { return value(v); }
  bool number_integer(std::int64_t v) override { return value(v); }
  bool number_unsigned(std::uint64_t v) override { return value(v); }
  bool number_float(double v, const std::string&) override { return value(v); }
  bool string(std::string& v) override { return value(std::move(v)); }
  bool binary(typename Json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& v) override {
    Level& level = levels_.back();
    if (v.size() > kMaxKeyBytes) {
      return refuse(
          fmt::format("a key of {} bytes; no key has more than {}", v.size(), kMaxKeyBytes));
    }
    if (level.container->size() == kMaxKeys) {
      return refuse(fmt::format("an object of more than {} keys", kMaxKeys));
    }
    level.key = std::move(v);
    if (level.container->contains(level.key)) {
      problems_.add(pointer(), "this key stands twice in its object; remove one");
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    problems_.add(pointer(), describe(position, error));
    return false;
  }

 private:
  struct Level {
    Json* container;
    std::string key;
  };

  // The message of the library without its tag, and without bytes that need not be UTF-8.
  static std::string describe(std::size_t position, const nlohmann::detail::exception& error) {
    std::string what = error.what();
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    for (char& c : what) {
      if (c < ' ' || c > '~') c = '?';
    }
    constexpr std::size_t kLongest = 300;
    if (what.size() > kLongest) what = what.substr(0, kLongest) + "...";
    const bool overflow = error.id == 406;
    return overflow
               ? fmt::format("number beyond the range of a double at byte {}: {}", position, what)
               : "not JSON at " + place_and_reason(what);
  }

  /// "line 1, column 2: what is wrong" of the library's "parse error at line 1, column 2: syntax
  /// error while parsing value - what is wrong".
  static std::string place_and_reason(std::string_view what) {
    constexpr std::string_view kBefore = "parse error at ";
    if (what.starts_with(kBefore)) what.remove_prefix(kBefore.size());
    const std::size_t place_end = what.find(": ");
    const std::size_t between = what.find(" - ", place_end);
    if (place_end == what.npos || between == what.npos) return std::string(what);
    return fmt::format("{}: {}", what.substr(0, place_end), what.substr(between + 3));
  }

  [[nodiscard]] std::string pointer() const {
    std::string result;
    for (const Level& level : levels_) {
      if (level.container->is_array()) {
        // An element that is being read is counted only once it is there; an open one already is.
        const bool innermost = &level == &levels_.back();
        result = at(result, level.container->size() - (innermost ? 0 : 1));
      } else if (!level.key.empty() || &level != &levels_.back()) {
        result = at(result, level.key);
      }
    }
    return result;
  }

  Json* put(Json v) {
    if (levels_.empty()) {
      root_ = std::move(v);
      return &root_;
    }
    Json& container = *levels_.back().container;
    if (container.is_array()) {
      container.push_back(std::move(v));
      return &container.back();
    }
    Json& slot = container[levels_.back().key];
    slot = std::move(v);
    return &slot;
  }

  bool value(Json v) {
    put(std::move(v));
    return true;
  }

  bool open(Json v) {
    if (levels_.size() == kMaxSceneDepth) {
      return refuse(fmt::format("nested deeper than {} levels", kMaxSceneDepth));
    }
    levels_.push_back({put(std::move(v)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  bool refuse(std::string message) {
    problems_.add(pointer(), std::move(message));
    return false;
  }

  Json& root_;
  Problems& problems_;
  std::vector<Level> levels_;
};

template <class Json>
std::optional<Json> read_bounded(std::string_view text, std::size_t most, Problems& problems) {
  if (text.size() > most) {
    problems.add("", fmt::format("the text has {} bytes; at most {} are read", text.size(), most));
    return std::nullopt;
  }
  // The parser would take it for the end of the text.
  if (const auto place = text.find('\0'); place != std::string_view::npos) {
    problems.add("", fmt::format("not JSON at byte {}: a byte of value zero", place + 1));
    return std::nullopt;
  }
  Json root;
  Builder<Json> builder(root, problems);
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) return std::nullopt;
  return root;
}

void write(const json& value, std::string& out) {
  if (value.is_object() || value.is_array()) {
    const bool object = value.is_object();
    out += object ? '{' : '[';
    bool first = true;
    for (const auto& [key, each] : value.items()) {
      if (!std::exchange(first, false)) out += ',';
      if (object) out += json(key).dump() + ':';
      write(each, out);
    }
    out += object ? '}' : ']';
  } else if (value.is_number_float()) {
    out += shortest(value.get<double>());
  } else {
    out += value.dump();
  }
}

}  // namespace

std::optional<json> read_json(std::string_view text, Problems& problems) {
  return read_bounded<json>(text, kMaxSceneBytes, problems);
}

nlohmann::ordered_json read_stored_json(std::string_view text) {
  Problems problems;
  auto value = read_bounded<nlohmann::ordered_json>(text, kMaxStoredBytes, problems);
  if (value && problems.empty()) return *std::move(value);
  const Problem problem = problems.take().front();
  throw std::runtime_error(problem.pointer.empty()
                               ? problem.message
                               : fmt::format("{}: {}", problem.pointer, problem.message));
}

std::string write_json(const json& value) {
  std::string out;
  write(value, out);
  return out;
}

std::string excerpt(const json& value) {
  constexpr std::size_t kLongest = 60;
  std::string text =
      value.is_number_float() ? shortest(value.get<double>()) : value.dump(-1, ' ', true);
  if (text.size() > kLongest) text = text.substr(0, kLongest - 3) + "...";
  return text;
}

std::string name_value(const json& value) {
  switch (value.type()) {
    case json::value_t::object:
      return fmt::format("an object with {} keys", value.size());
    case json::value_t::array:
      return fmt::format("an array of {}", value.size());
    case json::value_t::string:
      return fmt::format("the string {}", excerpt(value));
    case json::value_t::boolean:
    case json::value_t::null:
      return excerpt(value);
    default:
      return fmt::format("the number {}", excerpt(value));
  }
}

}  // namespace sluice

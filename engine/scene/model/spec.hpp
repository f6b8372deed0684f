#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace sluice {

/// Whether a key must be there. An optional one has the default of its struct, or `otherwise` says
/// what its absence means.
enum class Need { required, optional };

/// Allowed numbers: from `low`, itself excluded or not, to `high`.
struct Range {
  double low = 0.0;
  double high = 0.0;
  enum class Low { included, excluded } low_end = Low::included;

  [[nodiscard]] constexpr bool contains(double value) const {
    return (low_end == Low::included ? value >= low : value > low) && value <= high;
  }
};
[[nodiscard]] constexpr Range from(double low, double high) { return {low, high}; }
[[nodiscard]] constexpr Range above(double low, double high) {
  return {low, high, Range::Low::excluded};
}

/// "from 0 to 2", "above 0 and at most 1e+06 m".
[[nodiscard]] std::string to_text(const Range& range, std::string_view unit);

// What the parser, its messages and the schema say of a key. Members left out of an initialiser
// keep their defaults.
struct NumberSpec {
  std::string_view about = {};
  std::string_view unit = "1";  ///< SI; "1": dimensionless
  Range range = {};
  Need need = Need::optional;
  std::string_view otherwise = {};
};
struct KeySpec {
  std::string_view about = {};
  Need need = Need::optional;
  std::string_view otherwise = {};
};
struct ListSpec {
  std::string_view about = {};
  std::size_t min = 0;
  std::size_t max = 0;
  Need need = Need::optional;
};

enum class Characters {
  name,      ///< letters, digits, _ . -
  sentence,  ///< anything but control characters
};
struct TextSpec {
  std::string_view about = {};
  Characters characters = Characters::name;
  std::size_t min = 0;  ///< in code points, as JSON Schema counts
  std::size_t max = 0;
  Need need = Need::optional;
};

/// One word of an enumeration as scenes write it.
template <class Enum>
struct Word {
  std::string_view word;
  Enum value;
  std::string_view about;
};
template <class Enum, std::size_t n>
using Words = std::array<Word<Enum>, n>;

template <class Enum, std::size_t n>
[[nodiscard]] constexpr std::string_view word_for(const Words<Enum, n>& words, Enum value) {
  for (const auto& each : words) {
    if (each.value == value) return each.word;
  }
  return {};
}

}  // namespace sluice

#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace sluice {

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

// The parameters of a term, each once: parser, messages, canonical text and schema follow. The
// default is the value of the member in a fresh term.

/// A number, double or int.
template <class Term, class Value>
struct Number {
  std::string_view key;  ///< in a scene, below the term's own
  Value Term::*member;
  std::string_view about;
  Range range;
  std::string_view unit = "1";  ///< SI; "1": dimensionless
};
template <class Term, class Value>
Number(std::string_view, Value Term::*, std::string_view, Range, std::string_view = "1")
    -> Number<Term, Value>;

/// A word out of a few.
template <class Term, class Enum, std::size_t n>
struct Choice {
  std::string_view key;
  Enum Term::*member;
  std::string_view about;
  Words<Enum, n> words;
};
template <class Term, class Enum, std::size_t n>
Choice(std::string_view, Enum Term::*, std::string_view, Words<Enum, n>) -> Choice<Term, Enum, n>;

}  // namespace sluice

#pragma once

#include <optional>
#include <string_view>

namespace sluice {

/// What is said of a term. `{key}` in a line stands for the value of that parameter.
struct TermText {
  std::string_view key;    ///< of the term in a scene's `numerics`
  std::string_view about;  ///< what it is, for messages and the schema
  std::string_view plan;   ///< the line of `sluice plan` with the term
  std::string_view plan_without = plan;
};

/// The rate that a term of the pair sums adds to: D rho/Dt of eq. 4 or Dv/Dt of eq. 5.
enum class RateOf { density, velocity };

/// The particles j of a sum over pairs.
enum class Neighbours { fluid, walls };

/// Where a term is summed.
struct Summation {
  RateOf rate = RateOf::velocity;
  bool over_fluid = true;
  bool over_walls = true;
  bool holds_at_walls = false;  ///< it replaces free slip: a method has at most one such term
  int forms = 1;                ///< summands, compiled each, of which Term::form() picks one

  [[nodiscard]] constexpr bool over_walls_alone() const { return over_walls && !over_fluid; }
  [[nodiscard]] constexpr bool over(Neighbours j) const {
    return j == Neighbours::fluid ? over_fluid : over_walls;
  }
};

/// The place of a term in a method: a struct with one optional, whose name is the method's member.
/// Each term specialises it.
template <class Term>
struct InMethod;

template <class... Terms>
struct TermList {};

template <class... A, class... B>
constexpr TermList<A..., B...> join(TermList<A...>, TermList<B...>);
template <class First, class Second>
using Joined = decltype(join(First{}, Second{}));

/// Calls visit.operator()<Term>() for each, in order.
template <class... Terms, class Visit>
constexpr void for_each_term(TermList<Terms...>, const Visit& visit) {
  (visit.template operator()<Terms>(), ...);
}

/// The summand of a term that its parameters ask for: 0 where it has one only.
template <class Term>
[[nodiscard]] constexpr int form_of(const Term& term) {
  if constexpr (requires { term.form(); }) {
    return term.form();
  } else {
    return 0;
  }
}

/// The terms of a list that may stand in a method beside `Term`.
template <class Term>
constexpr TermList<> beside(TermList<>) {
  return {};
}
template <class Term, class First, class... Rest>
constexpr auto beside(TermList<First, Rest...>) {
  using Others = decltype(beside<Term>(TermList<Rest...>{}));
  if constexpr (Term::kSummation.holds_at_walls && First::kSummation.holds_at_walls) {
    return Others{};
  } else {
    return Joined<TermList<First>, Others>{};
  }
}

/// A term for each of a list, or none: nothing is computed, allocated or written for those that are
/// left out.
template <class List>
struct OptionalTerms;
template <class... Terms>
struct OptionalTerms<TermList<Terms...>> : InMethod<Terms>... {
  template <class Term>
  [[nodiscard]] const std::optional<Term>& term() const {
    const auto& [member] = static_cast<const InMethod<Term>&>(*this);
    return member;
  }
  template <class Term>
  [[nodiscard]] std::optional<Term>& term() {
    auto& [member] = static_cast<InMethod<Term>&>(*this);
    return member;
  }
};

}  // namespace sluice

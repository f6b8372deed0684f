#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>

#include "engine/scene/format/describe_ranges.hpp"
#include "engine/scene/model/scene.hpp"
#include "engine/scene/model/vocabulary.hpp"

namespace sluice {

// Part of the scene format (describe.hpp): the terms of the method, and the scheme.

template <class Archive, class Term, class Value>
void describe(Archive& a, Term& term, const Number<Term, Value>& number) {
  const NumberSpec spec{.about = number.about, .unit = number.unit, .range = number.range};
  if constexpr (std::is_same_v<Value, int>) {
    a.integer(number.key, term.*number.member, spec);
  } else {
    a.number(number.key, term.*number.member, spec);
  }
}
template <class Archive, class Term, class Enum, std::size_t n>
void describe(Archive& a, Term& term, const Choice<Term, Enum, n>& choice) {
  a.word(choice.key, choice.words, term.*choice.member, {.about = choice.about});
}

/// A term, by its parameters.
template <class Archive, class Term>
requires requires { Term::kParameters; }
void describe(Archive& a, Term& term) {
  std::apply([&](const auto&... each) { (describe(a, term, each), ...); }, Term::kParameters);
}

template <class List, class Archive>
void describe_terms(Archive& a, Method& method) {
  for_each_term(List{}, [&]<class Term>() {
    a.term(Term::kText.key, method.term<Term>(), {.about = Term::kText.about});
  });
}

/// Of a scheme, and of single keys beside it. A term takes null: left out.
template <class Archive>
void describe_numerics(Archive& a, Scene& scene) {
  Method& method = scene.method;
  a.word("scheme", kSchemeWords, scene.numerics.scheme,
         {.about = "what the keys that are missing here are; defaults below are those of "
                   "recommended"});
  a.word("kernel", kKernelWords, method.kernel, {.about = "smoothing function W"});
  a.word("integrator", kIntegratorWords, method.integrator, {.about = "time integration"});
  a.number("courant", method.courant,
           {.about = "Courant number C of the time step, eq. 18; 0.25 with modified_leap_frog; "
                     "impacts need it below about two thirds of the limit that linear analysis "
                     "gives for particles at rest (sluice plan)",
            .range = above(0, 2)});
  a.word("precision", kPrecisionWords, method.precision, {.about = "arithmetic"});
  describe_terms<RateTerms>(a, method);
  a.word("wall_pressure", kWallPressureWords, method.wall_pressure,
         {.about = "pressure of the walls' dummy particles, eq. 9"});
  describe_terms<Corrections>(a, method);
}

}  // namespace sluice

#include "engine/sph/terms/list.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "engine/sph/method/method.hpp"

namespace sluice {
namespace {

template <class Term, class Visit>
void for_each_parameter(const Visit& visit) {
  std::apply([&](const auto&... each) { (visit(each), ...); }, Term::kParameters);
}

TEST(TermList, HasEachKeyOnce) {
  std::set<std::string_view> terms;
  for_each_term(AllTerms{}, [&]<class Term>() {
    EXPECT_TRUE(terms.insert(Term::kText.key).second) << Term::kText.key;
    EXPECT_FALSE(Term::kText.about.empty()) << Term::kText.key;
    std::set<std::string_view> keys;
    for_each_parameter<Term>([&](const auto& parameter) {
      EXPECT_TRUE(keys.insert(parameter.key).second) << Term::kText.key << "." << parameter.key;
      EXPECT_FALSE(parameter.about.empty()) << Term::kText.key << "." << parameter.key;
    });
  });
}

TEST(TermList, HasDefaultsThatScenesMayWrite) {
  for_each_term(AllTerms{}, [&]<class Term>() {
    const Term fresh;
    for_each_parameter<Term>([&](const auto& parameter) {
      const auto value = fresh.*parameter.member;
      if constexpr (std::is_enum_v<std::remove_const_t<decltype(value)>>) {
        EXPECT_FALSE(word_for(parameter.words, value).empty()) << parameter.key;
      } else {
        EXPECT_TRUE(parameter.range.contains(value)) << Term::kText.key << "." << parameter.key;
      }
    });
  });
}

TEST(TermList, HasASummandForEachFormOfATerm) {
  for_each_term(RateTerms{}, [&]<class Term>() {
    EXPECT_LT(form_of(Term{}), Term::kSummation.forms) << Term::kText.key;
  });
  EXPECT_LT(form_of(ArtificialViscosity{.beta = 1.0}), ArtificialViscosity::kSummation.forms);
}

TEST(TermList, IsTheMembersOfAMethod) {
  MethodN<2> m;
  for_each_term(AllTerms{}, [&]<class Term>() { EXPECT_FALSE(m.term<Term>()) << "left out"; });
  m.viscosity = ArtificialViscosity{.alpha = 0.5};
  EXPECT_EQ(m.term<ArtificialViscosity>()->alpha, 0.5);
  m.term<WallShear>() = WallShear{.coefficient = 0.25};
  EXPECT_EQ(m.wall_shear->coefficient, 0.25);
  EXPECT_FALSE(m.wall_artificial_viscosity);
}

TEST(TermList, LetsOneTermHoldTheFluidAtWalls) {
  using Beside = decltype(beside<WallArtificialViscosity>(
      TermList<DensityDiffusion, LaminarViscosity, WallShear>{}));
  EXPECT_TRUE((std::is_same_v<Beside, TermList<DensityDiffusion>>));
  using BesideFree = decltype(beside<ArtificialViscosity>(TermList<LaminarViscosity, WallShear>{}));
  EXPECT_TRUE((std::is_same_v<BesideFree, TermList<LaminarViscosity, WallShear>>));
}

TEST(TermList, PicksTheFormWithAQuadraticPartWhereThereIsOne) {
  EXPECT_EQ(form_of(ArtificialViscosity{.beta = 0.0}), 0);
  EXPECT_EQ(form_of(ArtificialViscosity{.beta = 0.1}), 1);
  for_each_term(RateTerms{}, [&]<class Term>() {
    EXPECT_LT(form_of(Term{}), Term::kSummation.forms) << Term::kText.key;
    EXPECT_TRUE(Term::kSummation.over_fluid || Term::kSummation.over_walls) << Term::kText.key;
  });
}

}  // namespace
}  // namespace sluice

// What each term of the list gets from its entry there: keys, schema, lines for readers, plan.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "engine/scene/forecast/plan.hpp"
#include "engine/scene/format/numerics_json.hpp"
#include "engine/scene/format/schema.hpp"
#include "engine/scene/format/term_line.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;

template <class Term>
std::string key() {
  return std::string(Term::kText.key);
}

TEST(TermLine, HasTheValuesOfTheParameters) {
  const DensityDiffusion term{DiffusionKind::fourtakas, 0.25};
  EXPECT_EQ(filled_in("of {kind}, delta {delta}", term), "of fourtakas, delta 0.25");
  EXPECT_EQ(filled_in("every {interval} steps", Reinitialisation{7}), "every 7 steps");
  EXPECT_EQ(filled_in("nu {nu:g}", LaminarViscosity{1e-6}), "nu 1e-06");
}

TEST(TermLine, OfEachTermNamesItsOwnParametersOnly) {
  for_each_term(AllTerms{}, []<class Term>() {
    EXPECT_NO_THROW((void)filled_in(Term::kText.plan, Term{})) << key<Term>();
    EXPECT_NO_THROW((void)filled_in(Term{}.in_report(), Term{})) << key<Term>();
    EXPECT_EQ(Term::kText.plan_without.find('{'), std::string::npos) << key<Term>();
  });
}

TEST(Terms, AreReadFromTheirKeysAndWrittenWithAllParameters) {
  for_each_term(AllTerms{}, []<class Term>() {
    json text = testing::base_scene();
    text["numerics"] = {{"scheme", "recommended"}, {key<Term>(), json::object()}};
    const Method method = testing::parsed(text).method;
    ASSERT_TRUE(method.term<Term>()) << key<Term>();
    const json written = numerics_json(method)[key<Term>()];
    EXPECT_EQ(written.size(), std::tuple_size_v<decltype(Term::kParameters)>) << key<Term>();
    text["numerics"][key<Term>()] = nullptr;
    EXPECT_FALSE(testing::parsed(text).method.term<Term>()) << key<Term>();
  });
}

TEST(Terms, StandInTheSchemaWithAllParameters) {
  const json schema = json::parse(scene_schema_text());
  const json& numerics = schema["properties"]["numerics"]["properties"];
  for_each_term(AllTerms{}, [&]<class Term>() {
    ASSERT_TRUE(numerics.contains(key<Term>())) << key<Term>();
    const json& keys = numerics[key<Term>()]["properties"];
    const auto is_there = [&](const auto& parameter) {
      EXPECT_TRUE(keys.contains(std::string(parameter.key))) << key<Term>() << parameter.key;
    };
    std::apply([&](const auto&... each) { (is_there(each), ...); }, Term::kParameters);
  });
}

TEST(Terms, ArePlannedOrLeftOutOnce) {
  for (const bool walls : {true, false}) {
    const json text =
        walls ? testing::base_scene()
              : testing::free_scene({{"shape", "circle"}, {"center", {0, 0}}, {"radius", 1}});
    const Plan p = plan(testing::parsed(text));
    for_each_term(AllTerms{}, [&]<class Term>() {
      const auto is_it = [](const PlanItem& item) { return item.name == Term::kText.key; };
      EXPECT_EQ(
          std::ranges::count_if(p.passes, is_it) + std::ranges::count_if(p.passes_left_out, is_it),
          1)
          << key<Term>();
    });
  }
}

}  // namespace
}  // namespace sluice

#include "engine/scene/format/former_words.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/canonical.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::base_scene;
using testing::parsed;

TEST(FormerWords, MakeTheSceneThatTheirPresentNamesMake) {
  json former = base_scene();
  former["numerics"] = {{"scheme", "recommended"}, {"wall_drag", {{"coefficient", 0.02}}}};
  former["jitter"] = {{"amplitude", 0.1}, {"seed", 3}};
  json present = base_scene();
  present["numerics"] = {{"scheme", "recommended"}, {"wall_shear", {{"coefficient", 0.02}}}};
  present["perturbation"] = {{"amplitude", 0.1}, {"seed", 3}};
  EXPECT_EQ(canonical_text(parsed(former)), canonical_text(parsed(present)));
  EXPECT_NE(canonical_text(parsed(former)), canonical_text(parsed(base_scene())));
}

TEST(FormerWords, StandInTheTextThatCheckpointsAreBoundTo) {
  const std::string identity = identity_text(parsed(base_scene()));
  EXPECT_NE(identity.find("\"wall_drag\""), std::string::npos) << identity;
  EXPECT_EQ(identity.find("\"wall_shear\""), std::string::npos) << identity;
}

TEST(FormerWords, KeepTheirPlaceInProblems) {
  json scene = base_scene();
  scene["numerics"] = {{"scheme", "recommended"}, {"wall_drag", {{"coefficient", -1}}}};
  const ParseResult result = parse_scene(scene.dump());
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].pointer, "/numerics/wall_drag/coefficient");
}

TEST(FormerWords, OfNoObjectAreLeftToTheReader) {
  Problems problems;
  for (json scene :
       {json(3), json::array({1}), json{{"numerics", 3}}, json{{"numerics", nullptr}}}) {
    const json before = scene;
    EXPECT_TRUE(use_present_words(scene, kFormerSceneWords, problems).empty());
    EXPECT_EQ(scene, before);
  }
  EXPECT_TRUE(problems.empty());
}

TEST(FormerWords, AreReplacedInPointersAtOrBelowThem) {
  EXPECT_EQ(present_pointer("/numerics/wall_drag", kFormerSceneWords), "/numerics/wall_shear");
  EXPECT_EQ(present_pointer("/jitter/seed", kFormerSceneWords), "/perturbation/seed");
  EXPECT_EQ(present_pointer("/numerics/wall_dragon", kFormerSceneWords), "/numerics/wall_dragon");
}

}  // namespace
}  // namespace sluice

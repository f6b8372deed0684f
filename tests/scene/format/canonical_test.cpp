#include "engine/scene/format/canonical.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/scene/format/former_words.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::base_scene;
using testing::parsed;

std::vector<std::filesystem::path> all_valid() {
  auto files = testing::json_files(testing::source_dir() / "schemas/examples");
  for (auto& path : testing::json_files(testing::source_dir() / "tests/scene/fixtures/valid")) {
    files.push_back(path);
  }
  return files;
}

/// Whether every key and value of `part` stands in `whole` too.
bool holds(const json& whole, const json& part) {
  if (part.is_object()) {
    for (const auto& [key, value] : part.items()) {
      // Sections without a key in them and lists without an entry are left out.
      const bool nothing = value.is_structured() && value.empty();
      if (!whole.contains(key) ? !nothing : !holds(whole[key], value)) return false;
    }
    return true;
  }
  if (part.is_array()) {
    if (whole.size() != part.size()) return false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (!holds(whole[i], part[i])) return false;
    }
    return true;
  }
  return whole == part;
}

TEST(CanonicalText, KeepsEveryKeyThatASceneGives) {
  for (const auto& path : all_valid()) {
    json written = json::parse(testing::read_text(path));
    const json canonical = json::parse(canonical_text(testing::parsed_file(path)));
    if (written.contains("numerics")) written["numerics"].erase("scheme");  // each key is there
    Problems none;
    use_present_words(written, kFormerSceneWords, none);
    EXPECT_TRUE(holds(canonical, written)) << path << "\n" << canonical;
  }
}

TEST(CanonicalText, ReadsBackToItself) {
  for (const auto& path : all_valid()) {
    const std::string once = canonical_text(testing::parsed_file(path));
    const ParseResult again = parse_scene(once, testing::parts_beside(path));
    ASSERT_TRUE(again.scene) << path << "\n" << testing::list(again.problems);
    EXPECT_EQ(canonical_text(*again.scene), once) << path;
  }
}

TEST(CanonicalText, FillsInDerivedValues) {
  const json text = json::parse(canonical_text(parsed(base_scene())));
  EXPECT_EQ(text["resolution"]["smoothing_ratio"], 1.5);
  EXPECT_TRUE(text["material"].contains("sound_speed"));
  EXPECT_TRUE(text["domain"].contains("max"));
  EXPECT_EQ(text["numerics"]["integrator"], "kick_drift_kick");
  EXPECT_TRUE(text["numerics"]["wall_artificial_viscosity"].is_null());
  EXPECT_EQ(text["fluid"][0]["pressure"], "hydrostatic");
}

TEST(CanonicalText, IsBlindToOrderSpaceAndTheFormOfNumbers) {
  const json text = base_scene();
  std::string other = R"({"end_time": 1.0, "resolution": {"spacing": 5.0e-2},
    "gravity": [-0.0, -9.810], "fluid": [{"size": [1e0, 0.5], "pressure": "hydrostatic",
    "corner": [-0, 0], "shape": "rectangle"}], "tank": {"open_top": true, "height": 1,
    "width": 2.000}, "name": "base", "sensors": []})";
  const ParseResult result = parse_scene(other);
  ASSERT_TRUE(result.scene) << testing::list(result.problems);
  EXPECT_EQ(canonical_text(*result.scene), canonical_text(parsed(text)));
}

TEST(CanonicalText, WritesNumbersInTheirShortestForm) {
  json text = base_scene();
  text["end_time"] = 0.1;
  const std::string canonical = canonical_text(parsed(text));
  EXPECT_THAT(canonical, ::testing::HasSubstr(R"("end_time":0.1,)"));
  EXPECT_THAT(canonical, ::testing::HasSubstr(R"("gravity":[0,-9.81])"));
}

RC_GTEST_PROP(CanonicalText, GivesBackTheSameDoubles, ()) {
  json text = base_scene();
  const auto draw = [](double low, double high) {
    return low + (high - low) * (*rc::gen::inRange(1, 1'000'000'000)) / 1e9;
  };
  text["numerics"] = {{"courant", 0.5}};  // stable whatever is drawn
  text["resolution"]["spacing"] = draw(0.01, 0.1);
  text["resolution"]["smoothing_ratio"] = draw(0.8, 2.5);
  text["gravity"] = {draw(-10, 10), draw(-10, 10)};
  text["fluid"][0]["velocity"] = {draw(-1, 1), draw(-1, 1)};
  text["fluid"][0]["strain_rate"] = draw(-1, 1);
  text["fluid"][0]["rotation_rate"] = draw(-1, 1);
  const Scene scene = parsed(text);
  const ParseResult again = parse_scene(canonical_text(scene));
  RC_ASSERT(again.scene.has_value());
  const Method& a = scene.method;
  const Method& b = again.scene->method;
  RC_ASSERT(a.spacing == b.spacing);
  RC_ASSERT(a.smoothing_length == b.smoothing_length);
  RC_ASSERT(a.sound_speed == b.sound_speed);
  RC_ASSERT(a.gravity == b.gravity);
  RC_ASSERT(scene.domain.box.min == again.scene->domain.box.min);
  RC_ASSERT(scene.domain.box.max == again.scene->domain.box.max);
  RC_ASSERT(scene.fluid[0].velocity == again.scene->fluid[0].velocity);
  RC_ASSERT(scene.fluid[0].strain_rate == again.scene->fluid[0].strain_rate);
  RC_ASSERT(scene.fluid[0].rotation_rate == again.scene->fluid[0].rotation_rate);
}

TEST(IdentityText, IsBlindToNameDescriptionAndEndTime) {
  json text = base_scene();
  text["sensors"] = json::parse(R"([{"name": "P", "kind": "energy", "interval": 0.1}])");
  const std::string identity = identity_text(parsed(text));
  text["name"] = "another";
  text["description"] = "another";
  text["end_time"] = 2;
  EXPECT_EQ(identity_text(parsed(text)), identity);
  EXPECT_THAT(identity, ::testing::HasSubstr(R"("name":"P")")) << "a sensor's name is its series'";
}

TEST(IdentityText, SeesEveryOtherChange) {
  const std::string path = "tests/scene/fixtures/valid/every_key.json";
  const json text = json::parse(testing::read_text(testing::source_dir() / path));
  const std::string identity = identity_text(parsed(text));
  int changed = 0;
  const json flat = text.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (pointer == "/name" || pointer == "/description" || pointer == "/end_time") continue;
    if (!value.is_number() || pointer.starts_with("/reference")) continue;
    json other = text;
    other[json::json_pointer(pointer)] =
        pointer == "/numerics/reinitialisation/interval" ? 8.0 : value.get<double>() * 1.001 + 1e-4;
    const ParseResult result = testing::parse(other);
    if (!result.scene) continue;
    EXPECT_NE(identity_text(*result.scene), identity) << pointer;
    ++changed;
  }
  EXPECT_GE(changed, 40);
}

}  // namespace
}  // namespace sluice

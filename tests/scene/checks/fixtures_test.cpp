#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/format/schema.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

fs::path fixtures() { return testing::source_dir() / "tests/scene/fixtures"; }

TEST(SceneFixtures, ValidOnesAreAcceptedAndMakeParticles) {
  for (const fs::path& path : testing::json_files(fixtures() / "valid")) {
    const ParseResult result = testing::parse_file(path);
    EXPECT_TRUE(result.problems.empty()) << path << "\n" << testing::list(result.problems);
    ASSERT_TRUE(result.scene) << path;
    if (testing::takes_long_to_pack(path)) continue;
    EXPECT_GT(create_particles(*result.scene).state.particles.size(), 0U) << path;
  }
}

TEST(SceneFixtures, InvalidOnesAreRefusedWhereTheyAreWrongAndNowhereElse) {
  const auto expected = nlohmann::json::parse(testing::read_text(fixtures() / "problems.json"));
  std::size_t count = 0;
  for (const fs::path& folder : {fs::path("invalid"), fs::path("beyond_schema")}) {
    for (const fs::path& path : testing::json_files(fixtures() / folder)) {
      const ParseResult result = testing::parse_file(path);
      EXPECT_FALSE(result.scene) << path;
      const auto wanted = expected.at(folder / path.filename()).get<std::vector<std::string>>();
      EXPECT_THAT(testing::pointers(result), ::testing::UnorderedElementsAreArray(wanted))
          << path << "\n"
          << testing::list(result.problems);
      ++count;
    }
  }
  EXPECT_EQ(count, expected.size()) << "problems.json names a fixture that is not there";
}

TEST(SceneFixtures, ExamplesAreAcceptedAndMakeParticles) {
  for (const fs::path& path : testing::json_files(testing::source_dir() / "schemas/examples")) {
    const ParseResult result = testing::parse_file(path);
    ASSERT_TRUE(result.scene) << path << "\n" << testing::list(result.problems);
    EXPECT_EQ(result.scene->name, path.stem()) << "an example bears the name of its file";
    if (testing::takes_long_to_pack(path)) continue;
    EXPECT_GT(create_particles(*result.scene).state.particles.size(), 0U) << path;
  }
}

// The published schema is generated. To publish a change to the format, run this test once with
// SLUICE_PUBLISH_SCHEMA=1 in the environment and commit what it wrote.
TEST(SceneSchema, PublishedFileIsWhatTheParserReadsBy) {
  const fs::path path = testing::source_dir() / "schemas/scene.schema.json";
  if (std::getenv("SLUICE_PUBLISH_SCHEMA") != nullptr) {
    std::ofstream(path, std::ios::binary) << scene_schema_text();
  }
  EXPECT_TRUE(testing::read_text(path) == scene_schema_text())
      << path << " is not what the parser reads by; publish it again";
}

/// Calls f(schema, pointer) for every property anywhere in a schema.
template <class F>
void for_each_property(const nlohmann::json& schema, const std::string& pointer, const F& f) {
  if (schema.contains("properties")) {
    for (const auto& [key, property] : schema["properties"].items()) {
      f(property, pointer + "/" + key);
      for_each_property(property, pointer + "/" + key, f);
    }
    EXPECT_EQ(schema.value("additionalProperties", true), false) << pointer;
  }
  if (schema.contains("items")) for_each_property(schema["items"], pointer + "/*", f);
  for (const auto& each : schema.value("oneOf", nlohmann::json::array())) {
    for_each_property(each, pointer + "/" + each.value("title", "?"), f);
  }
}

TEST(SceneSchema, DescribesEveryKeyAndGivesEveryNumberAUnitAndARange) {
  int numbers = 0;
  const auto check = [&](const nlohmann::json& property, const std::string& pointer) {
    EXPECT_FALSE(property.value("description", "").empty()) << pointer;
    const auto allowed = property.find("type");  // an array where null is a value
    const std::string type =
        allowed != property.end() && allowed->is_string() ? allowed->get<std::string>() : "";
    if (type != "number" && type != "integer") return;
    ++numbers;
    EXPECT_TRUE(property.contains("x-unit")) << pointer;
    EXPECT_TRUE(property.contains("maximum")) << pointer;
    EXPECT_TRUE(property.contains("minimum") || property.contains("exclusiveMinimum")) << pointer;
  };
  for_each_property(nlohmann::json::parse(scene_schema_text()), "", check);
  EXPECT_GE(numbers, 20);
}

}  // namespace
}  // namespace sluice

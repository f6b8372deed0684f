#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "engine/scene/checks/parse.hpp"
#include "tests/scene/support.hpp"

namespace sluice {
namespace {

using nlohmann::json;
using testing::base_scene;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_at;
using testing::parse;
using testing::pointers;

/// `text` with as many spaces as make it `bytes` long.
std::string padded(const std::string& text, std::size_t bytes) {
  return text + std::string(bytes - text.size(), ' ');
}

TEST(SceneLimits, AcceptsATextOf64KibibytesAndNoByteMore) {
  const std::string text = base_scene().dump();
  EXPECT_TRUE(parse_scene(padded(text, 256 * 1024)).scene);
  const ParseResult result = parse_scene(padded(text, 256 * 1024 + 1));
  EXPECT_THAT(message_at(result, ""), HasSubstr("262145 bytes"));
}

TEST(SceneLimits, RefusesADeepTree) {
  for (const std::size_t depth : {17U, 60000U, 200000U}) {
    for (const std::string open : {"[", "{\"a\":"}) {
      std::string text;
      for (std::size_t i = 0; i < depth; ++i) text += open;
      const ParseResult result = parse_scene(text);
      EXPECT_FALSE(result.scene);
      ASSERT_EQ(result.problems.size(), 1U) << depth;
      EXPECT_THAT(result.problems[0].message,
                  HasSubstr(text.size() > kMaxSceneBytes ? "bytes" : "deeper than 16"));
    }
  }
}

TEST(SceneLimits, ReadsATreeOfSixteenLevels) {
  const ParseResult result = parse_scene(std::string(16, '[') + std::string(16, ']'));
  EXPECT_THAT(message_at(result, ""), HasSubstr("must be an object"));
}

TEST(SceneLimits, RefusesNumbersBeyondDouble) {
  for (const std::string number : {"1e999", "-1e999", "1e99999999999999999999"}) {
    const ParseResult result = parse_scene(R"({"tank": {"width": )" + number + "}}");
    EXPECT_THAT(message_at(result, "/tank/width"), HasSubstr("beyond the range of a double"));
  }
}

TEST(SceneLimits, RefusesWordsForNumbers) {
  for (const std::string word : {"NaN", "Infinity", "-Infinity", "nan", "inf"}) {
    const ParseResult result = parse_scene(R"({"tank": {"width": )" + word + "}}");
    EXPECT_THAT(message_at(result, "/tank/width"), HasSubstr("not JSON")) << word;
  }
}

TEST(SceneLimits, RefusesATrillionParticlesAndSaysWhatIsPossible) {
  json text = base_scene();
  text["tank"] = {{"width", 1000}, {"height", 1000}};
  text["fluid"] =
      json::parse(R"([{"shape": "rectangle", "corner": [0, 0], "size": [1000, 1000]}])");
  text["resolution"]["spacing"] = 0.001;
  const ParseResult result = parse(text);
  EXPECT_THAT(message_at(result, "/resolution/spacing"), HasSubstr("1e+12 fluid"));
  EXPECT_THAT(message_at(result, "/resolution/spacing"), HasSubstr("near 0.141 m"));
}

TEST(SceneLimits, CountsTheCellsOfObstaclesToo) {
  json text = base_scene();
  text["tank"] = {{"width", 1000}, {"height", 1000}};
  text["resolution"]["spacing"] = 0.01;
  text["obstacles"] = json::parse(R"([{"shape": "circle", "center": [500, 500], "radius": 400}])");
  EXPECT_THAT(pointers(parse(text)), ElementsAre("/resolution/spacing"));
}

TEST(SceneLimits, ListsAHundredProblemsAndCountsTheRest) {
  std::string text = "{";
  for (int i = 0; i < 500; ++i) text += "\"x" + std::to_string(i) + "\": 0, ";
  const ParseResult result = parse_scene(text + "\"y\": 0}");
  ASSERT_EQ(result.problems.size(), kMaxProblems + 1);
  // 501 unknown keys and 4 missing ones.
  EXPECT_THAT(result.problems.back().message, HasSubstr("405 more problems"));
}

TEST(SceneLimits, QuotesOnlyTheStartOfALongValue) {
  json text = base_scene();
  text["name"] = std::string(60000, 'x');
  EXPECT_LT(message_at(parse(text), "/name").size(), 300U);
}

TEST(SceneLimits, AnswersBrokenEncodingInValidText) {
  for (const std::string bytes : {"\xff", "\xc3", "\xed\xa0\x80", "\x01"}) {
    for (const std::string& text :
         {bytes, "{\"" + bytes + "\": 1}", "{\"name\": \"" + bytes + "\"}", "{\"a\":" + bytes}) {
      const ParseResult result = parse_scene(text);
      ASSERT_FALSE(result.problems.empty());
      for (const Problem& each : result.problems) {
        EXPECT_NO_THROW((void)json(each.pointer + each.message).dump());
      }
    }
  }
}

TEST(SceneLimits, AnswersTextThatEndsTooEarly) {
  const std::string whole = base_scene().dump();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const ParseResult result = parse_scene(whole.substr(0, length));
    EXPECT_FALSE(result.scene) << length;
    EXPECT_EQ(result.problems.size(), 1U) << length;
  }
}

}  // namespace
}  // namespace sluice

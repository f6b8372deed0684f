#include <gtest/gtest.h>

#include <string>

#include "service/http/line_reader.hpp"
#include "service/worker/worker_message.hpp"

namespace sluice::test {
namespace {

TEST(LineReader, JoinsWhatCameInPieces) {
  LineReader reader(100);
  EXPECT_TRUE(reader.feed("one").empty());
  const auto lines = reader.feed(" two\n\nthree\nfo");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].text, "one two");
  EXPECT_EQ(lines[1].text, "");
  EXPECT_EQ(lines[2].text, "three");
  EXPECT_EQ(reader.take_rest(), "fo");
  EXPECT_EQ(reader.take_rest(), "");
}

TEST(LineReader, KeepsALineOfExactlyTheLimit) {
  LineReader reader(4);
  const auto lines = reader.feed("abcd\n");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].text, "abcd");
  EXPECT_FALSE(lines[0].cut);
}

TEST(LineReader, CutsALongLineOnceAndGoesOnWithTheNext) {
  LineReader reader(4);
  auto lines = reader.feed("abcdef");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].text, "abcd");
  EXPECT_TRUE(lines[0].cut);
  EXPECT_TRUE(reader.feed(std::string(1000, 'x')).empty());
  lines = reader.feed("x\nok\n");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].text, "ok");
  EXPECT_FALSE(lines[0].cut);
}

TEST(WorkerMessage, HasEventStepAndTheRestAsJson) {
  const auto message = parse_worker_line(R"({"event":"checkpoint","step":17,"file":"a.h5"})");
  ASSERT_TRUE(message);
  EXPECT_EQ(message->event, "checkpoint");
  EXPECT_EQ(message->step, 17U);
  EXPECT_EQ(message->detail, R"({"step":17,"file":"a.h5"})");
}

TEST(WorkerMessage, RefusesWhatIsNoEvent) {
  for (const char* line : {"", "hello", "[]", "17", "null", "{}", R"({"event":17})",
                           R"({"event":""})", R"({"event":"a")", "{\"event\":\"\xff\"}"}) {
    EXPECT_FALSE(parse_worker_line(line)) << line;
  }
}

TEST(WorkerMessage, RefusesNestingThatWouldOverflowTheStack) {
  const std::size_t depth = 30000;
  const std::string line =
      R"({"event":"progress","a":)" + std::string(depth, '[') + std::string(depth, ']') + "}";
  EXPECT_FALSE(parse_worker_line(line));
}

TEST(WorkerMessage, StepsThatAreNoCountsAreNoSteps) {
  for (const char* step : {"-1", "1.5", "1e300", "\"7\"", "null"}) {
    const auto message =
        parse_worker_line(std::string(R"({"event":"progress","step":)") + step + "}");
    ASSERT_TRUE(message) << step;
    EXPECT_FALSE(message->step) << step;
  }
}

TEST(Printable, ReplacesControlCharactersAndCutsTheLength) {
  EXPECT_EQ(printable("a\x1b[2Jb\xff", 100), "a?[2Jb?");
  EXPECT_EQ(printable("abcdef", 3), "abc");
}

}  // namespace
}  // namespace sluice::test

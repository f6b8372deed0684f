#include "engine/run/progress.hpp"
#include "engine/run/events.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/run/reporter.hpp"

namespace sluice {
namespace {

Progress halfway() {
  Progress progress;
  progress.time = 1.0;
  progress.end_time = 2.0;
  progress.time_step = 1e-4;
  progress.step = 10;
  return progress;
}

TEST(RateMeter, KnowsNoRateBeforeTwoPointsLieApart) {
  RateMeter meter;
  EXPECT_FALSE(meter.rate());
  meter.add(1.0, 0.0, 0, 0);
  EXPECT_FALSE(meter.rate());
  meter.add(1.0, 0.5, 5, 50);
  EXPECT_FALSE(meter.rate());
  meter.add(2.0, 0.5, 5, 50);
  ASSERT_TRUE(meter.rate());
  EXPECT_DOUBLE_EQ(meter.rate()->model_time, 0.5);
}

TEST(RateMeter, ForgetsWhatIsOlderThanItsWindow) {
  RateMeter meter(10.0);
  double model = 0.0;
  for (int second = 0; second <= 100; ++second) {
    meter.add(second, model, static_cast<std::uint64_t>(second), 0);
    model += second < 50 ? 1.0 : 0.1;
  }
  EXPECT_NEAR(meter.rate()->model_time, 0.1, 1e-12);
  EXPECT_NEAR(meter.rate()->steps, 1.0, 1e-12);
}

TEST(Eta, IsUnknownAndNeverInfiniteUntilTheRunMoves) {
  Progress progress = halfway();
  EXPECT_FALSE(progress.remaining());
  for (const double rate : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 5e-324}) {
    progress.rate = Rate{rate, 0.0, 0.0};
    EXPECT_FALSE(progress.remaining()) << rate;
    EXPECT_TRUE(to_json(progress)["eta"].is_null());
    EXPECT_NE(progress_bar(progress, 400).find("ETA unknown"), std::string::npos);
  }
}

TEST(Eta, IsTheTimeToGoAtTheRecentRate) {
  Progress progress = halfway();
  progress.rate = Rate{0.25, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(*progress.remaining(), 4.0);
  progress.time = 3.0;
  EXPECT_EQ(*progress.remaining(), 0.0);
}

TEST(DurationText, ReadsAsPeopleSayIt) {
  EXPECT_EQ(duration_text(45.2), "45 s");
  EXPECT_EQ(duration_text(725.0), "12 min 05 s");
  EXPECT_EQ(duration_text(12000.0), "3 h 20 min");
  EXPECT_EQ(duration_text(532800.0), "6 d 4 h");
  EXPECT_EQ(duration_text(59.7), "1 min 00 s");
  EXPECT_EQ(duration_text({}), "unknown");
  EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), "unknown");
  EXPECT_EQ(duration_text(1e300), "unknown");
}

TEST(ProgressBar, NeverOutgrowsTheTerminal) {
  const Progress progress = halfway();
  for (std::size_t width = 1; width < 200; ++width) {
    EXPECT_LE(progress_bar(progress, width).size(), width);
  }
  EXPECT_NE(progress_bar(progress, 150).find("50.0 %"), std::string::npos);
}

TEST(Bar, TellsOfWarningsAndLeavesTheRestToTheAccount) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  BarReporter reporter(file);
  reporter.event({EventKind::checkpoint, {{"step", 5}}});
  reporter.event({EventKind::finished, {{"step", 9}}});
  reporter.event(warning_event("mind the gap"));
  std::fclose(file);
  const std::string lines(text, size);
  free(text);
  EXPECT_EQ(lines, "warning: mind the gap\n");
}

TEST(JsonLine, IsOneObjectPerLineEvenWhenANameIsNoUtf8) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  JsonReporter reporter(file);
  reporter.event(warning_event("bad \xff name\nand a new line"));
  reporter.progress(halfway());
  std::fclose(file);
  const std::string lines(text, size);
  free(text);
  const auto first_end = lines.find('\n');
  const auto first = nlohmann::json::parse(lines.substr(0, first_end));
  EXPECT_EQ(first["event"], "warning");
  const auto second = nlohmann::json::parse(lines.substr(first_end + 1));
  EXPECT_EQ(second["event"], "progress");
  EXPECT_EQ(second["step"], 10);
  EXPECT_EQ(second["step_limit"], std::string(to_string(StepLimit::sound)));
}

}  // namespace
}  // namespace sluice

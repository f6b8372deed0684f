#include "engine/store/read/series_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "engine/store/read/filter.hpp"
#include "tests/store/pressure_series.hpp"

namespace sluice::test {
namespace {

constexpr double kDry = std::numeric_limits<double>::quiet_NaN();

std::vector<double> noise(std::size_t count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> values(count);
  for (double& value : values) value = normal(random);
  return values;
}

TEST(SeriesView, DecimationKeepsTheExtremesOfEveryPart) {
  std::vector<double> values = noise(10'000);
  values[1234] = 1e6;
  values[8765] = -1e6;
  const Series all = pressure_series(values);
  const Series few = decimate(all, 302);
  EXPECT_LE(few.size(), 302U);
  EXPECT_TRUE(std::ranges::is_sorted(few.time));
  const std::size_t parts = 100;  // three samples of each, beside the first and the last
  for (std::size_t part = 0; part < parts; ++part) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(part * 100);
    const auto [least, greatest] = std::minmax_element(first, first + 100);
    EXPECT_NE(std::ranges::find(few.values, *least), few.values.end());
    EXPECT_NE(std::ranges::find(few.values, *greatest), few.values.end());
  }
}

TEST(SeriesView, DecimationKeepsWhereASeriesBeginsAndEnds) {
  const Series all = pressure_series(noise(1000));
  for (const std::size_t most : {10U, 11U, 12U, 50U, 999U}) {
    const Series few = decimate(all, most);
    EXPECT_LE(few.size(), most);
    EXPECT_EQ(few.time.front(), all.time.front()) << most;
    EXPECT_EQ(few.time.back(), all.time.back()) << most;
    EXPECT_EQ(few.values.back(), all.values.back()) << most;
  }
}

TEST(SeriesView, DecimationShowsDryStretchesAndLeavesShortSeriesAlone) {
  std::vector<double> values(1000, 1.0);
  std::fill(values.begin() + 500, values.begin() + 503, kDry);
  const Series few = decimate(pressure_series(values), 30);
  EXPECT_TRUE(std::ranges::any_of(few.values, [](double value) { return std::isnan(value); }));
  const Series whole = pressure_series(noise(30));
  EXPECT_EQ(decimate(whole, 30).values, whole.values);
}

TEST(SeriesView, DecimatesAllColumnsOfASample) {
  Series series = pressure_series(noise(900));
  series.columns = {{"a", "J/m"}, {"b", "J/m"}, {"c", "J/m"}};
  for (auto* const list : {&series.time, &series.duration, &series.weight}) list->resize(300);
  const Series few = decimate(series, 90);
  EXPECT_LE(few.size(), 90U);
  EXPECT_EQ(few.values.size(), 3 * few.size());
  for (std::size_t column = 0; column < 3; ++column) {
    double greatest = -1e9;
    for (std::size_t n = column; n < 900; n += 3) greatest = std::max(greatest, series.values[n]);
    double kept = -1e9;
    for (std::size_t n = column; n < few.values.size(); n += 3)
      kept = std::max(kept, few.values[n]);
    EXPECT_EQ(kept, greatest);
  }
}

TEST(SeriesView, APartIsFilteredAsItIsInTheWhole) {
  const Series raw = pressure_series(noise(2000));
  SeriesQuery query;
  query.tau = 0.01;
  const SeriesView whole = make_view(raw, query, SeriesState::final);
  query.from = 0.5;
  query.to = 0.7;
  const SeriesView part = make_view(raw, query, SeriesState::final);
  ASSERT_GT(part.series.size(), 150U);
  const auto place = std::ranges::find(whole.series.time, part.series.time.front());
  const auto offset = static_cast<std::size_t>(place - whole.series.time.begin());
  for (std::size_t n = 0; n < part.series.size(); ++n) {
    EXPECT_EQ(part.series.values[n], whole.series.values[offset + n]);
    EXPECT_EQ(part.series.weight[n], whole.series.weight[offset + n]);
  }
}

TEST(SeriesView, CutsAtBothEndsInclusive) {
  SeriesQuery query;
  query.from = 0.002;
  query.to = 0.004;
  const SeriesView view = make_view(pressure_series({0, 1, 2, 3, 4, 5}), query, SeriesState::final);
  EXPECT_EQ(view.series.values, (std::vector<double>{2, 3, 4}));
  EXPECT_EQ(view.samples, 3U);
}

TEST(SeriesView, RefusesAFilterThatTakesForEver) {
  const Series raw = pressure_series(std::vector<double>(20'000, 1.0));
  SeriesQuery query;
  query.max_products = 5e7;
  query.tau = 1000.0;  // every sample with every other: 4e8 products
  EXPECT_THROW((void)make_view(raw, query, SeriesState::final), std::length_error);
  query.tau = 0.01;
  EXPECT_NO_THROW((void)make_view(raw, query, SeriesState::final));
}

TEST(SeriesView, AnEmptySeriesIsShownEmpty) {
  SeriesQuery query;
  query.tau = 0.01;
  const SeriesView view = make_view(pressure_series({}), query, SeriesState::growing);
  EXPECT_EQ(view.samples, 0U);
  EXPECT_FALSE(view.provisional_after);
  EXPECT_EQ(nlohmann::json::parse(json_text(view, query))["time"], nlohmann::json::array());
}

}  // namespace
}  // namespace sluice::test

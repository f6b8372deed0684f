#include "engine/store/read/filter.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace sluice {
namespace {

constexpr double kDry = std::numeric_limits<double>::quiet_NaN();

Series series_of(std::vector<double> time, std::vector<double> values) {
  Series series;
  series.name = "P1";
  series.kind = "pressure";
  series.columns = {{"value", "Pa"}};
  for (std::size_t n = 0; n < time.size(); ++n) {
    series.duration.push_back(n == 0 ? 0.0 : time[n] - time[n - 1]);
    series.weight.push_back(std::isnan(values[n]) ? 0.0 : 1.0);
  }
  series.time = std::move(time);
  series.values = std::move(values);
  return series;
}

Series sampled(int count, double interval, const std::function<double(double)>& value) {
  std::vector<double> time, values;
  for (int n = 0; n < count; ++n) {
    time.push_back(interval * n);
    values.push_back(value(interval * n));
  }
  return series_of(std::move(time), std::move(values));
}

TEST(TimeFilter, LeavesAConstantAsItIsWhateverTheStepsAre) {
  const Series series = series_of({0.0, 0.1, 0.15, 0.4, 0.41, 0.9}, {7, 7, 7, 7, 7, 7});
  for (const double value : gaussian_filter(series, 0.2).value) EXPECT_NEAR(value, 7.0, 1e-14);
}

TEST(TimeFilter, LeavesALineAsItIsAwayFromTheEnds) {
  const Series series = sampled(201, 0.01, [](double t) { return 3.0 * t - 1.0; });
  // No whole number of steps, so that rounding cannot cut the window on one side only.
  const double tau = 0.053;
  const Filtered filtered = gaussian_filter(series, tau);
  for (std::size_t m = 0; m < series.size(); ++m) {
    const double t = series.time[m];
    if (t < 3.0 * tau || t > series.time.back() - 3.0 * tau) continue;
    EXPECT_NEAR(filtered.value[m], 3.0 * t - 1.0, 1e-12) << "at t = " << t;
  }
}

TEST(TimeFilter, DampsAWaveByTheFourierTransformOfTheGaussian) {
  const double tau = 0.05;
  const Series series = sampled(4001, 0.001, [](double t) { return std::cos(20.0 * t); });
  const Filtered filtered = gaussian_filter(series, tau);
  const std::size_t middle = 2000;
  // exp(-(omega tau/2)^2); the cut at 3 tau leaves out less than erfc(3) = 2.2e-5.
  EXPECT_NEAR(filtered.value[middle] / series.values[middle], std::exp(-0.25), 5e-5);
}

TEST(TimeFilter, WeighsASampleByTheTimeItStandsFor) {
  // Two samples at the distance d: v = (v0 D0 e^{-R^2} + v1 D1) / (D0 e^{-R^2} + D1).
  Series series = series_of({0.0, 1.0, 1.5}, {10.0, 20.0, 40.0});
  const double tau = 1.0;
  const double w = std::exp(-0.25);
  const double w0 = std::exp(-2.25);
  const double expected = (10.0 * 1.0 * w0 + 20.0 * 1.0 * w + 40.0 * 0.5) / (w0 + w + 0.5);
  EXPECT_NEAR(gaussian_filter(series, tau).value[2], expected, 1e-13);
}

TEST(TimeFilter, WeightIsTheIntegralOfTheKernelInsideAndHalfOfItAtAnEnd) {
  const Series series = sampled(2001, 0.001, [](double) { return 1.0; });
  const Filtered filtered = gaussian_filter(series, 0.05);
  EXPECT_NEAR(filtered.weight[1000], std::erf(3.0), 1e-3);
  EXPECT_NEAR(filtered.weight[2000], 0.5 * std::erf(3.0),
              0.5 * 0.001 / (0.05 * std::sqrt(std::numbers::pi)) + 1e-3);
}

TEST(TimeFilter, SkipsDrySamplesAndGivesNoValueWhereAllAreDry) {
  Series series = series_of({0, 1, 2, 3, 10, 11}, {kDry, kDry, 5, 5, kDry, kDry});
  series.kind = "surface_height";
  const Filtered filtered = gaussian_filter(series, 0.5);
  EXPECT_TRUE(std::isnan(filtered.value[0]));
  EXPECT_EQ(filtered.weight[0], 0.0);
  EXPECT_NEAR(filtered.value[1], 5.0, 1e-14);
  EXPECT_NEAR(filtered.value[3], 5.0, 1e-14);
  EXPECT_TRUE(std::isnan(filtered.value[4]));
}

TEST(TimeFilter, CountsADryPressureAsThatOfTheAirSoThatNothingArrivesBeforeTheFluid) {
  const double tau = 1.0;
  const Series series = series_of({0, 1, 2, 3}, {kDry, kDry, 5, 5});
  const Filtered filtered = gaussian_filter(series, tau);
  const double w1 = std::exp(-1.0);
  const double w2 = std::exp(-4.0);
  EXPECT_NEAR(filtered.value[0], 5.0 * w2 / (1.0 + w1 + w2), 1e-14);
  EXPECT_NEAR(filtered.value[1], 5.0 * (w1 + w2) / (1.0 + 2.0 * w1 + w2), 1e-14);
  EXPECT_EQ(gaussian_filter(series_of({0, 1}, {kDry, kDry}), tau).value[0], 0.0);
}

TEST(TimeFilter, SeesNothingAtOrBeyondThreeTau) {
  const Series series = series_of({0, 3, 6}, {1, 2, 4});
  const Filtered filtered = gaussian_filter(series, 1.0);
  for (std::size_t m = 0; m < 3; ++m) EXPECT_DOUBLE_EQ(filtered.value[m], series.values[m]);
}

TEST(TimeFilter, KeepsASingleSampleAndAnEmptySeries) {
  EXPECT_DOUBLE_EQ(gaussian_filter(series_of({0.0}, {3.0}), 0.1).value.at(0), 3.0);
  EXPECT_TRUE(gaussian_filter(series_of({}, {}), 0.1).value.empty());
}

TEST(TimeFilter, SurvivesATauAtTheEndsOfDouble) {
  const Series series = series_of({0.0, 0.1, 0.2}, {1.0, 2.0, 3.0});
  EXPECT_DOUBLE_EQ(gaussian_filter(series, 1e-300).value[1], 2.0);
  EXPECT_NEAR(gaussian_filter(series, 1e300).value[1], 2.0, 1e-14);
}

TEST(TimeFilter, FiltersTheColumnAskedFor) {
  Series series = series_of({0.0, 0.1}, {1.0, 1.0});
  series.columns = {{"kinetic", "J/m"}, {"potential", "J/m"}};
  series.values = {1.0, 5.0, 1.0, 5.0};
  EXPECT_NEAR(gaussian_filter(series, 1.0, 1).value[0], 5.0, 1e-14);
}

std::vector<Series> sampled_together(std::size_t count) {
  std::vector<Series> all;
  for (std::size_t s = 0; s < count; ++s) {
    const double pitch = 1.0 + 0.1 * static_cast<double>(s);
    all.push_back(sampled(150, 0.01, [&](double t) { return std::sin(pitch * 20.0 * t); }));
    // Dry stretches of their own, one longer than the window.
    for (std::size_t n = s; n < s + 40 && n < all[s].size(); ++n) all[s].values[n] = kDry;
  }
  return all;
}

std::vector<const Series*> pointers_to(const std::vector<Series>& all) {
  std::vector<const Series*> list;
  for (const Series& one : all) list.push_back(&one);
  return list;
}

TEST(TimeFilter, OfManySampledTogetherIsBitByBitThatOfEach) {
  const std::vector<Series> all = sampled_together(70);
  const std::vector<Filtered> together = gaussian_filter(pointers_to(all), 0.03);
  ASSERT_EQ(together.size(), all.size());
  const auto bits = [](const std::vector<double>& values) {
    std::vector<std::uint64_t> list;
    for (const double value : values) list.push_back(std::bit_cast<std::uint64_t>(value));
    return list;
  };
  for (std::size_t s = 0; s < all.size(); ++s) {
    const Filtered alone = gaussian_filter(all[s], 0.03);
    EXPECT_EQ(bits(together[s].value), bits(alone.value)) << s;
    EXPECT_EQ(bits(together[s].weight), bits(alone.weight)) << s;
  }
}

TEST(TimeFilter, RefusesSeriesThatWereNotSampledTogether) {
  for (const bool shifted : {true, false}) {
    std::vector<Series> all = sampled_together(3);
    (shifted ? all[2].time : all[2].duration).back() += 1e-3;
    EXPECT_THROW((void)gaussian_filter(pointers_to(all), 0.03), std::invalid_argument);
  }
  EXPECT_TRUE(gaussian_filter(std::span<const Series* const>(), 0.03).empty());
  EXPECT_THROW((void)gaussian_filter(std::span<const Series* const>(), -1.0),
               std::invalid_argument);
}

TEST(TimeFilter, RefusesATauThatIsNoPositiveNumberAndAColumnThatIsNotThere) {
  const Series series = series_of({0.0}, {1.0});
  for (const double tau : {0.0, -1.0, kDry, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)gaussian_filter(series, tau), std::invalid_argument) << tau;
  }
  EXPECT_THROW((void)gaussian_filter(series, 1.0, 1), std::invalid_argument);
}

TEST(TimeFilter, ValuesBeforeTheProvisionalTimeDoNotChangeWhenSamplesFollow) {
  const auto wave = [](double t) { return std::sin(7.0 * t); };
  const Series all = sampled(300, 0.01, wave);
  const Series part = sampled(200, 0.01, wave);
  const double tau = 0.1;
  const Filtered early = gaussian_filter(part, tau);
  const Filtered late = gaussian_filter(all, tau);
  bool changed = false;
  for (std::size_t m = 0; m < part.size(); ++m) {
    if (part.time[m] < provisional_after(part, tau)) {
      EXPECT_EQ(early.value[m], late.value[m]) << part.time[m];
    } else {
      changed = changed || early.value[m] != late.value[m];
    }
  }
  EXPECT_TRUE(changed);
}

}  // namespace
}  // namespace sluice

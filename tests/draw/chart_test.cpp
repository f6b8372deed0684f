#include "engine/draw/chart.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sluice {
namespace {

TEST(Axis, TicksAreOneTwoOrFiveTimesAPowerOfTenApart) {
  EXPECT_EQ(ticks({"", 0.0, 8.0}, 8), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(ticks({"", 0.0, 1.0}, 2), (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(ticks({"", -1.0, 1.0}, 1), (std::vector<double>{0.0}));
}

TEST(Axis, LogarithmicTicksAreThePowersOfTen) {
  const auto places = ticks({"", 0.5, 2e4, AxisScale::logarithmic}, 6);
  ASSERT_EQ(places.size(), 5u);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_DOUBLE_EQ(places[k], std::pow(10.0, static_cast<double>(k)));
  }
}

TEST(Axis, HoldsEveryFiniteValueAndNothingOfWhatIsNot) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Axis axis;
  fit_axis(axis, {kNan, 3.7, -2.2, INFINITY});
  EXPECT_LE(axis.low, -2.2);
  EXPECT_GE(axis.high, 3.7);
  EXPECT_LT(axis.high, 10.0);
}

TEST(Axis, IsUsableWithoutAnyValueAndWithOneValueOnly) {
  for (const auto& values : {std::vector<double>{}, std::vector<double>{5.0, 5.0}}) {
    for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
      Axis axis{"", 0.0, 0.0, scale};
      fit_axis(axis, values);
      EXPECT_LT(axis.low, axis.high);
      EXPECT_FALSE(ticks(axis, 6).empty());
    }
  }
}

TEST(Axis, OfWhatHardlyChangesSpansATenthOfIt) {
  Axis axis;
  fit_axis(axis, {2943.0, 2943.2, 2942.9});
  EXPECT_GE(axis.high - axis.low, 294.0);
  EXPECT_LT(axis.high - axis.low, 1000.0);
}

TEST(Axis, OfTimesEndsWithThem) {
  Axis axis;
  hold_axis(axis, {0.0, 1.7, 4.013});
  EXPECT_EQ(axis.low, 0.0);
  EXPECT_EQ(axis.high, 4.013);
}

TEST(Axis, NumbersOfTicksHaveNoTrailingZeros) {
  EXPECT_EQ(tick_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(tick_text(-2.0), "-2");
  EXPECT_EQ(tick_text(1e6), "1e6");
  EXPECT_EQ(tick_text(1e-17), "0");
}

Chart one_line(std::vector<double> x, std::vector<double> y) {
  Chart chart;
  chart.id = "one";
  chart.title = "A <b> & \"c\"";
  chart.x = {"x", 0.0, 10.0};
  chart.y = {"y", -1.0, 1.0};
  chart.lines.push_back({"line", Ink::simulation, std::move(x), std::move(y)});
  return chart;
}

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(Chart, KeepsItsLabelClearOfLongNumbers) {
  Chart chart = one_line({0, 10}, {0, 1});
  chart.y = {"y", 1234.5, 1234.6};
  const std::string svg = chart_svg(chart, SvgPlace::page);
  double x = 0;
  const auto rect = svg.find("<rect class=\"frame\"");
  ASSERT_EQ(std::sscanf(svg.c_str() + rect, "<rect class=\"frame\" x=\"%lf\"", &x), 1);
  // 1234.52 is seven digits of some 8 units; the label ends 20 units from the left.
  EXPECT_GT(x, 20.0 + 7.0 + 7 * 8.0);
}

TEST(Chart, EscapesWhatAUserNamed) {
  const std::string svg = chart_svg(one_line({0, 10}, {0, 1}), SvgPlace::page);
  EXPECT_EQ(svg.find("<b>"), std::string::npos);
  EXPECT_NE(svg.find("A &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
}

TEST(Chart, DrawsAStraightLineFromCornerToCorner) {
  const std::string svg = chart_svg(one_line({0, 10}, {-1, 1}), SvgPlace::page);
  // The frame says where the corners are.
  const auto rect = svg.find("<rect class=\"frame\"");
  ASSERT_NE(rect, std::string::npos);
  double x = 0, y = 0, width = 0, height = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + rect,
                        "<rect class=\"frame\" x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"",
                        &x, &y, &width, &height),
            4);
  const auto line = svg.rfind("class=\"line simulation\" d=\"M");
  ASSERT_NE(line, std::string::npos);
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + line, "class=\"line simulation\" d=\"M%lf %lf %lf %lf", &x1,
                        &y1, &x2, &y2),
            4);
  EXPECT_NEAR(x1, x, 0.06);
  EXPECT_NEAR(y1, y + height, 0.06);
  EXPECT_NEAR(x2, x + width, 0.06);
  EXPECT_NEAR(y2, y, 0.06);
}

TEST(Chart, InterruptsALineWhereThereIsNoValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = chart_svg(one_line({0, 1, 2, 3, 4}, {0, 0, nan, 0, 0}), SvgPlace::page);
  const auto line = svg.rfind("class=\"line simulation\" d=\"");
  const std::string path = svg.substr(line, svg.find("/>", line) - line);
  EXPECT_EQ(count_of(path, "M"), 2u);
  EXPECT_EQ(path.find("nan"), std::string::npos);
}

TEST(Chart, ThinsALongLineButKeepsItsHighestPoint) {
  std::vector<double> x, y;
  for (int i = 0; i < 200000; ++i) {
    x.push_back(i * 5e-5);
    y.push_back(i == 123456 ? 0.9 : 1e-3 * (i % 7));
  }
  const std::string svg = chart_svg(one_line(x, y), SvgPlace::page);
  EXPECT_LT(svg.size(), 60000u);
  const std::string flat = chart_svg(one_line({0, 10}, {0.9, 0.9}), SvgPlace::page);
  const auto at = flat.rfind("d=\"M");
  double x1 = 0, top = 0;
  ASSERT_EQ(std::sscanf(flat.c_str() + at, "d=\"M%lf %lf", &x1, &top), 2);
  char place[32];
  std::snprintf(place, sizeof place, " %.1f", top);
  const auto line = svg.rfind("class=\"line simulation\" d=\"");
  EXPECT_NE(svg.find(place, line), std::string::npos);
}

TEST(Chart, AsAFileBringsItsStyle) {
  const Chart chart = one_line({0, 10}, {0, 1});
  EXPECT_NE(chart_svg(chart, SvgPlace::file).find("prefers-color-scheme: dark"), std::string::npos);
  EXPECT_EQ(chart_svg(chart, SvgPlace::page).find("<style>"), std::string::npos);
}

TEST(Chart, OnASheetStandsTwoInARowAndOnTheNextRowBelow) {
  Chart first = one_line({0.0, 10.0}, {0.0, 1.0});
  Chart second = first;
  second.id = "two";
  Chart third = first;
  third.id = "three";
  const std::string sheet = sheet_svg({first, second, third}, 2, "a & b");
  EXPECT_EQ(sheet.find("<svg"), 0u);
  EXPECT_EQ(sheet.find("<svg", 1), std::string::npos);
  EXPECT_NE(sheet.find("<title>a &amp; b</title>"), std::string::npos);
  std::size_t frames = 0;
  for (std::size_t at = 0; (at = sheet.find("class=\"frame\"", at)) != std::string::npos; ++at) {
    ++frames;
  }
  EXPECT_EQ(frames, 3u);
  EXPECT_NE(sheet.find("translate(560 0)"), std::string::npos);
  EXPECT_EQ(sheet.find("translate(1120"), std::string::npos);
}

}  // namespace
}  // namespace sluice

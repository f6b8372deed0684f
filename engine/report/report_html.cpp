#include <fmt/format.h>

#include <string>
#include <string_view>

#include "engine/draw/chart.hpp"
#include "engine/draw/markup.hpp"
#include "engine/report/figures.hpp"
#include "engine/report/report.hpp"
#include "engine/report/report_tables.hpp"

namespace sluice {
namespace {

constexpr std::string_view kPageStyle = R"(
:root { color-scheme: light dark; --page: #ffffff; --text: #1b1f24; --rule: #d0d7de; --quiet: #57606a; }
@media (prefers-color-scheme: dark) {
:root { --page: #0d1117; --text: #e6edf3; --rule: #30363d; --quiet: #8b949e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1240px; padding: 1.5rem 1.25rem 4rem; background: var(--page);
  color: var(--text); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.6rem; margin: 0 0 .5rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .5rem; }
p { margin: .25rem 0; max-width: 90ch; }
.note, figcaption { color: var(--quiet); font-size: .9rem; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 460px), 1fr));
  gap: 1.5rem; }
figure { margin: 0; }
.pictures figure { max-width: 900px; margin-bottom: 1rem; }
svg { display: block; width: 100%; height: auto; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .75rem .2rem 0; border-bottom: 1px solid var(--rule); text-align: left;
  vertical-align: top; }
thead th { font-weight: 600; white-space: nowrap; }
tbody th { font-weight: 400; }
.n { text-align: right; white-space: nowrap; }
td, tbody th { min-width: 5.5rem; }
.n { min-width: 0; }
@media print { .charts { grid-template-columns: 1fr 1fr; } figure { break-inside: avoid; } }
)";

std::string head(const Report& report) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}: report</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>{1}{2}</style>\n"
      "</head>\n<body>\n<h1>{0}</h1>\n",
      escaped(report.scene.name), kPageStyle, chart_style());
  for (const std::string& line : report_lines(report)) {
    text += fmt::format("<p>{}</p>\n", escaped(line));
  }
  return text;
}

std::string charts_html(const std::vector<Chart>& charts, std::size_t sensors) {
  if (charts.empty()) return {};
  std::string text = "<h2>Figures</h2>\n<div class=\"charts\">\n";
  for (const Chart& chart : charts) {
    text += fmt::format("<figure>\n{}</figure>\n", chart_svg(chart, SvgPlace::page));
  }
  text += "</div>\n";
  if (charts.size() >= kMostCharts && sensors > charts.size()) {
    text += fmt::format(
        "<p class=\"note\">a page has {} plots at most; sluice sensors prints any sensor's "
        "samples</p>\n",
        kMostCharts);
  }
  return text;
}

std::string pictures_html(const std::vector<std::string>& svgs) {
  if (svgs.empty()) return {};
  std::string text =
      "<h2>Particles</h2>\n<p class=\"note\">coloured by pressure, one scale for all; what lies "
      "above its end has the last colour, what is negative the first. Solids are grey, the gate is "
      "red. sluice report --format apng makes an animation</p>\n<div class=\"pictures\">\n";
  for (const std::string& svg : svgs) text += fmt::format("<figure>\n{}</figure>\n", svg);
  return text + "</div>\n";
}

}  // namespace

std::string report_html(const Report& report, const std::vector<Series>& series,
                        const std::vector<Snapshot>& frames) {
  std::string text = head(report);
  text += charts_html(report_charts(report, series), series.size());
  text += pictures_html(picture_svgs(report, frames));
  for (const Table& table : comparison_tables(report)) text += table_html(table);
  for (const Table& table : run_tables(report)) text += table_html(table);
  return text + "</body>\n</html>\n";
}

}  // namespace sluice

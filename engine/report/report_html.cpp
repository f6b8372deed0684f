#include <fmt/format.h>

#include <string>
#include <string_view>

#include "engine/draw/chart.hpp"
#include "engine/draw/markup.hpp"
#include "engine/draw/page.hpp"
#include "engine/report/figures.hpp"
#include "engine/report/report.hpp"
#include "engine/report/report_tables.hpp"
#include "engine/report/snapshots.hpp"

namespace sluice {
namespace {

std::string head(const Report& report) {
  std::string text = fmt::format("<h1>{}</h1>\n", escaped(report.scene.name));
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

std::string pictures_html(const Report& report, const std::vector<Snapshot>& frames) {
  if (frames.empty()) return {};
  const bool in_space = report.scene.dimensions() == 3;
  std::string text = fmt::format(
      "<h2>Particles</h2>\n<p class=\"note\">coloured by pressure, one scale for all; what lies "
      "above its end has the last colour, what is negative the first. Solids are grey, the gate is "
      "red. {}sluice report --format apng makes an animation</p>\n<div class=\"pictures\">\n",
      in_space ? fmt::format("Each time is shown as a body and as a section at z = {:.4g} m. ",
                             picture_section(report.scene))
               : "");
  std::vector<std::string> bodies;
  if (in_space) bodies = picture_svgs(report, frames, Look::rendered);
  const std::vector<std::string> sections = picture_svgs(report, frames, Look::section);
  for (std::size_t k = 0; k < sections.size(); ++k) {
    if (in_space) text += fmt::format("<figure>\n{}</figure>\n", bodies[k]);
    text += fmt::format("<figure>\n{}</figure>\n", sections[k]);
  }
  return text + "</div>\n";
}

}  // namespace

std::string report_html(const Report& report, const std::vector<Series>& series,
                        const std::vector<Snapshot>& frames) {
  std::string text = head(report);
  text += charts_html(report_charts(report, series), series.size());
  text += pictures_html(report, frames);
  for (const Table& table : comparison_tables(report)) text += table_html(table);
  for (const Table& table : run_tables(report)) text += table_html(table);
  return html_page(report.scene.name + ": report", text);
}

}  // namespace sluice

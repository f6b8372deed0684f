#include "engine/verify/stability_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "engine/draw/markup.hpp"
#include "engine/draw/page.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

std::string figures_text(const CaseResult& result) {
  std::string text;
  for (const Figure& figure : result.figures) {
    text += fmt::format("{}{} {:.3g} (at most {:.3g})", text.empty() ? "" : ", ", figure.what,
                        figure.value, figure.gate);
  }
  return text;
}

/// NaN and infinity have no JSON number.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json verdict_json(const CaseResult& r) {
  Json verdict{{"verdict", to_string(r.verdict)},
               {"reason", r.reason.empty() ? Json(nullptr) : Json(r.reason)}};
  for (const char* key : {"step", "time", "value", "limit"}) verdict[key] = nullptr;
  if (r.diagnosis) {
    verdict["step"] = r.diagnosis->step;
    verdict["time"] = number(r.diagnosis->time);
    verdict["value"] = number(r.diagnosis->value);
    verdict["limit"] = number(r.diagnosis->limit);
  }
  verdict["checkpoint"] = r.checkpoint.empty() ? Json(nullptr) : Json(r.checkpoint);
  return verdict;
}

std::string picture_svg(const std::vector<Dot>& dots) {
  if (dots.empty()) return "";
  constexpr double kSize = 120;
  std::string svg =
      fmt::format(R"(<svg width="{0}" height="{0}" viewBox="-3 -3 {1} {1}">)", kSize, kSize + 6);
  for (const Dot& dot : dots) {
    svg +=
        fmt::format(R"svg(<circle cx="{:.1f}" cy="{:.1f}" r="1.4" fill="hsl({:.0f},80%,45%)"/>)svg",
                    kSize * dot.x, kSize * (1.0 - dot.y), 220.0 * (1.0 - dot.speed));
  }
  return svg + "</svg>";
}

std::string_view standing(const JudgedCase& judged) {
  if (judged.result.met()) return "met";
  return judged.acceptable() ? "known" : "MISS";
}

}  // namespace

SuiteTally tally(const std::vector<JudgedCase>& all) {
  SuiteTally sum;
  for (const JudgedCase& judged : all) {
    if (judged.result.met()) {
      ++sum.met;
    } else {
      ++(judged.acceptable() ? sum.known : sum.missed);
    }
  }
  return sum;
}

std::string tally_text(const SuiteTally& t) {
  std::string text = fmt::format("{} of {} gates met", t.met, t.met + t.known + t.missed);
  if (t.known > 0) text += fmt::format(", {} missed for the causes named", t.known);
  if (t.missed > 0) text += fmt::format(", {} missed", t.missed);
  return text;
}

std::string suite_line(const JudgedCase& judged) {
  const CaseResult& r = judged.result;
  std::string line =
      fmt::format("{:<5} {:<18} {:<21} {:>6.2f} s  {}", standing(judged), judged.subject.name,
                  to_string(r.verdict), r.seconds, figures_text(r));
  if (!r.met()) line += fmt::format("\n      gate: {}", judged.subject.gate);
  if (!r.met() && !judged.cause.empty()) line += fmt::format("\n      cause: {}", judged.cause);
  if (!r.reason.empty()) line += fmt::format("\n      {}", r.reason);
  return line;
}

Json suite_json(const std::vector<JudgedCase>& all) {
  Json cases = Json::array();
  for (const auto& [subject, result, cause] : all) {
    Json figures = Json::array();
    for (const Figure& f : result.figures) {
      figures.push_back(
          {{"what", f.what}, {"value", number(f.value)}, {"gate", f.gate}, {"met", f.met()}});
    }
    cases.push_back({{"name", subject.name},
                     {"about", subject.about},
                     {"gate", subject.gate},
                     {"met", result.met()},
                     {"cause", result.met() || cause.empty() ? Json(nullptr) : Json(cause)},
                     {"verdict", verdict_json(result)},
                     {"figures", figures},
                     {"seconds", result.seconds}});
  }
  const SuiteTally sum = tally(all);
  return {{"met", sum.met}, {"known", sum.known}, {"missed", sum.missed}, {"cases", cases}};
}

std::string suite_html(const std::vector<JudgedCase>& all) {
  std::string rows;
  for (const JudgedCase& judged : all) {
    const auto& [subject, result, cause] = judged;
    const std::string why = result.met() || cause.empty() ? "" : "<br>" + escaped(cause);
    rows += fmt::format(
        "<tr class=\"{}\"><td>{}</td><td><b>{}</b><br>{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td>{}</td></tr>\n",
        judged.acceptable() ? "met" : "miss", standing(judged), escaped(subject.name),
        escaped(subject.about), to_string(result.verdict),
        escaped(figures_text(result)) + "<br><small>" + escaped(result.reason) + "</small>",
        escaped(subject.gate) + why, picture_svg(result.picture));
  }
  return html_page(
      "Sluice stability",
      fmt::format("<h1>Stability: {}</h1>\n<table>\n<tr><th></th><th>case</th><th>verdict</th>"
                  "<th>figures</th><th>gate</th><th>last state, colour is speed</th></tr>\n"
                  "{}</table>\n",
                  tally_text(tally(all)), rows));
}

}  // namespace sluice

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/study/stability_case.hpp"

namespace sluice {

/// A case with what came of it.
struct JudgedCase {
  StabilityCase subject;
  CaseResult result;
};

/// One line: verdict, figures beside their gates, and the reason where there is one.
[[nodiscard]] std::string suite_line(const JudgedCase& judged);
/// {met, cases: [{name, gate, met, verdict: {verdict, reason, step, time, particle, value, limit,
/// checkpoint}, figures, seconds}]}.
[[nodiscard]] nlohmann::ordered_json suite_json(const std::vector<JudgedCase>& all);
/// One self-contained page with a picture of each case's last state.
[[nodiscard]] std::string suite_html(const std::vector<JudgedCase>& all);

}  // namespace sluice

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/verify/stability_case.hpp"

namespace sluice {

/// A case with what came of it.
struct JudgedCase {
  StabilityCase subject;
  CaseResult result;
  std::string_view cause{};  ///< why the scheme is known to miss the gate; empty: it must not

  [[nodiscard]] bool acceptable() const { return result.met() || !cause.empty(); }
};

struct SuiteTally {
  std::size_t met = 0;
  std::size_t known = 0;   ///< missed for a cause that has a name
  std::size_t missed = 0;  ///< missed without one
};
[[nodiscard]] SuiteTally tally(const std::vector<JudgedCase>& all);
/// "41 of 44 gates met, 3 missed for the causes named".
[[nodiscard]] std::string tally_text(const SuiteTally& tally);

/// Verdict, figures beside their gates, and the reason where there is one.
[[nodiscard]] std::string suite_line(const JudgedCase& judged);
/// {met, known, missed, cases: [{name, about, gate, met, cause, verdict: {verdict, reason, step,
/// time, particle, value, limit, checkpoint}, figures, seconds}]}.
[[nodiscard]] nlohmann::ordered_json suite_json(const std::vector<JudgedCase>& all);
/// One self-contained page with a picture of each case's last state.
[[nodiscard]] std::string suite_html(const std::vector<JudgedCase>& all);

}  // namespace sluice

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/verify/case_runner.hpp"

namespace sluice {

enum class Verdict {
  stable,
  stable_with_warnings,
  drifting,  ///< ends well, but off by more than the recommended scheme may be
  unstable,  ///< a guard ended it
  rejected,  ///< refused before anything was allocated
};
[[nodiscard]] std::string_view to_string(Verdict verdict);

/// A measured figure and what it may be at most, dimensionless.
struct Figure {
  std::string what;
  double value = 0.0;
  double gate = 0.0;
  [[nodiscard]] bool met() const { return value <= gate; }
};

/// A particle of a picture: place in units of the picture's width, y up, and speed over the
/// largest.
struct Dot {
  double x, y, speed;
};

/// How a case ended, with the step, time, particle, value and limit of the guard that ended it.
struct CaseResult {
  Verdict verdict = Verdict::stable;
  std::string reason;
  std::optional<Diagnosis> diagnosis;
  std::string checkpoint;  ///< the last good one, from the suite's folder
  std::vector<Figure> figures;
  bool as_expected = true;  ///< the verdict is one that the case must end with
  std::vector<Dot> picture;
  double seconds = 0.0;

  [[nodiscard]] bool met() const;
};

/// One case of the suite.
struct StabilityCase {
  std::string_view name;
  std::string_view about;
  std::string_view gate;  ///< what must come out, in words
  CaseResult (*judge)(CaseRunner&);
  std::string_view paper_miss{};  ///< why the paper's scheme misses the gate, where it does
};

/// Why still water and films rise with the paper's scheme.
inline constexpr std::string_view kLifted =
    "eqs. 7 and 10 diffuse and spread the hydrostatic density too, which lifts water at rest; "
    "fourtakas without eq. 10 holds it";

// The cases, by file.
[[nodiscard]] std::span<const StabilityCase> table_cases();    ///< scheme against theory
[[nodiscard]] std::span<const StabilityCase> limit_cases();    ///< of the Courant number
[[nodiscard]] std::span<const StabilityCase> drop_cases();     ///< drops in empty space
[[nodiscard]] std::span<const StabilityCase> flow_cases();     ///< waves, impacts, small fluids
[[nodiscard]] std::span<const StabilityCase> extreme_cases();  ///< far ends of every parameter
[[nodiscard]] std::vector<StabilityCase> all_cases();

/// Verdict, diagnosis, checkpoint and picture of a run; expected to end with `expected`, or with
/// `or_else`.
[[nodiscard]] CaseResult result_of(const CaseRun& run, Verdict expected,
                                   std::optional<Verdict> or_else = {});

/// Runs one case and takes its time. Throws what CaseRunner::run throws.
[[nodiscard]] CaseResult run_case(const StabilityCase& each, CaseRunner& bench);

}  // namespace sluice

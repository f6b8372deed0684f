#include "engine/verify/stability_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/run/stopwatch.hpp"

namespace sluice {
namespace {

constexpr std::size_t kMostDots = 1500;

/// As seen along z.
std::vector<Dot> picture_of(const Checkpoint& state) {
  const Particles& p = state.solver.particles;
  if (p.size() == 0) return {};
  Vec2 low = p.position_of(0).head<2>();
  Vec2 high = low;
  double fastest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    low = low.cwiseMin(p.position_of(i).head<2>());
    high = high.cwiseMax(p.position_of(i).head<2>());
    fastest = std::max(fastest, p.velocity_of(i).norm());
  }
  const double size = std::max((high - low).maxCoeff(), 1e-300);
  const std::size_t stride = (p.size() + kMostDots - 1) / kMostDots;
  std::vector<Dot> dots;
  for (std::size_t i = 0; i < p.size(); i += stride) {
    const Vec2 at = (p.position_of(i).head<2>() - low) / size;
    const double speed = p.velocity_of(i).norm();
    dots.push_back({at.x(), at.y(), fastest > 0.0 ? speed / fastest : 0.0});
  }
  return dots;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::stable:
      return "stable";
    case Verdict::stable_with_warnings:
      return "stable with warnings";
    case Verdict::drifting:
      return "drifting";
    case Verdict::unstable:
      return "unstable";
    case Verdict::rejected:
      return "rejected";
  }
  return "";
}

bool CaseResult::met() const {
  return as_expected &&
         std::all_of(figures.begin(), figures.end(), [](const Figure& f) { return f.met(); });
}

std::vector<StabilityCase> all_cases() {
  std::vector<StabilityCase> all;
  for (const auto cases :
       {table_cases(), limit_cases(), drop_cases(), flow_cases(), extreme_cases()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

CaseResult result_of(const CaseRun& run, Verdict expected, std::optional<Verdict> or_else) {
  CaseResult result;
  result.checkpoint = run.checkpoint;
  if (!run.problems.empty()) {
    result.verdict = Verdict::rejected;
    result.reason = run.problems.front().pointer + " " + run.problems.front().message;
  } else if (!run.completed()) {
    result.verdict = Verdict::unstable;
    result.reason = run.outcome.reason;
    result.diagnosis = run.outcome.diagnosis;
  } else if (!run.warnings.empty()) {
    result.verdict = Verdict::stable_with_warnings;
    result.reason = run.warnings.front();
  }
  if (run.last) result.picture = picture_of(*run.last);
  result.as_expected = result.verdict == expected || result.verdict == or_else;
  return result;
}

CaseResult run_case(const StabilityCase& each, CaseRunner& bench) {
  const Stopwatch clock;
  CaseResult result = each.judge(bench);
  result.seconds = clock.seconds();
  return result;
}

}  // namespace sluice

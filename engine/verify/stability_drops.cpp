// Drops in empty space whose shape over time is known.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/scene/filling/initial.hpp"
#include "engine/sph/solver/solver.hpp"
#include "engine/verify/elliptical_drop.hpp"
#include "engine/verify/stability_case.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

CaseResult elliptical_drop(CaseRunner& bench) {
  const DropRun drop = run_drop(bench, bench.pick(15, 40));
  CaseResult result = result_of(drop.run, Verdict::stable, Verdict::stable_with_warnings);
  if (drop.point) result.figures.push_back({"axis", drop.point->error(), 0.02});
  return result;
}

/// A drop of velocity sigma (x, -y) under the acceleration -omega^2 (x, y): with semi-axes a and b,
///   da/dt = sigma a,  db/dt = -sigma b,  dsigma/dt = (sigma^2 + omega^2) (b^2 - a^2)/(b^2 + a^2)
/// (Monaghan and Rafiee 2013). Lengths in radii, times in 1/omega.
struct PulsingDrop {
  double sigma = 0.5;
  double a = 1.0;
  double b = 1.0;

  [[nodiscard]] double pull() const {
    return (sigma * sigma + 1.0) * (b * b - a * a) / (b * b + a * a);
  }
  /// The midpoint rule in ten parts.
  void advance(double time) {
    constexpr int kParts = 10;
    const double half = 0.5 * time / kParts;
    for (int n = 0; n < kParts; ++n) {
      const PulsingDrop middle{sigma + half * pull(), a + half * sigma * a, b - half * sigma * b};
      sigma += 2.0 * half * middle.pull();
      a += 2.0 * half * middle.sigma * middle.a;
      b -= 2.0 * half * middle.sigma * middle.b;
    }
  }
};

/// Kinetic energy and that of the central force, per mass.
double central_energy(const Particles& p) {
  return 0.5 * (mean_square(p.position[0]) + mean_square(p.position[1]) +
                mean_square(p.velocity[0]) + mean_square(p.velocity[1]));
}

void pull_to_center(Particles& p, double time) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.velocity[0][i] -= time * p.position[0][i];
    p.velocity[1][i] -= time * p.position[1][i];
    if (p.velocity_half[0].empty()) continue;
    p.velocity_half[0][i] -= time * p.position[0][i];
    p.velocity_half[1][i] -= time * p.position[1][i];
  }
}

/// No scene has a central force, so it acts between the steps here: split off, to first order in a
/// step, which is a thousandth of 1/omega.
CaseResult pulsing_drop(CaseRunner& bench) {
  const double end = bench.pick(5.0, 14.0);
  PulsingDrop exact;
  Json drop = circle(Vec2::Zero(), 1.0);
  drop["strain_rate"] = exact.sigma;
  const Json scene =
      with_scheme(in_space("pulsing-drop", std::move(drop), 1.0 / bench.pick(15, 40), 15.0, end),
                  bench.scheme());
  const ParseResult parsed = parse_scene(scene.dump(), StabilityCheck::refuse, SceneOrigin::job);
  CaseRun refused;
  refused.problems = parsed.problems;
  if (!parsed.scene) return result_of(refused, Verdict::stable);

  const Method& method = parsed.scene->method;
  SolverState state = create_particles(*parsed.scene).state;
  Particles& p = state.particles;
  const double energy = central_energy(p);
  const double radius = std::sqrt(mean_square(p.position[0]));
  double axis_error = 0.0;
  while (state.time < end) {
    Solver solver(method, parsed.scene->domain, state, {}, {});
    solver.step();
    state = solver.state();
    pull_to_center(p, solver.time_step());
    exact.advance(solver.time_step());
    const double axis = std::sqrt(mean_square(p.position[0])) / radius;
    const bool whole = solver.removed_count() == 0;
    axis_error = std::max(axis_error, whole ? std::abs(axis - exact.a) : HUGE_VAL);
    if (!whole) break;
  }
  CaseResult result;
  result.figures.push_back({"axis", axis_error, 0.08});
  result.figures.push_back({"energy loss", std::abs(1.0 - central_energy(p) / energy), 0.15});
  return result;
}

constexpr std::array kDropCases{
    StabilityCase{"elliptical-drop", "drop of v = A (-x, y), to A t = 0.8", "axis within 2 %",
                  elliptical_drop},
    StabilityCase{"pulsing-drop", "drop that pulses under a central force",
                  "axis within 8 %, energy loss at most 15 %", pulsing_drop},
};

}  // namespace

std::span<const StabilityCase> drop_cases() { return kDropCases; }

}  // namespace sluice

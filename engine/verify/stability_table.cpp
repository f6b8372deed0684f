// Cases that hold the scheme against theory: still water and scaling.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/verify/stability_case.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

CaseResult still_recommended(CaseRunner& bench) {
  StillWater water;
  water.time = bench.pick(12.0, 57.0);  // 57: ten seconds of 0.3 m of water
  water.per_depth = 30.0;
  const CaseRun run = bench.run(still_water("still-tank", water));
  CaseResult result = result_of(run, Verdict::stable);
  if (run.completed()) {
    result.figures.push_back({"pressure L2", pressure_error(run, water, 0.0), 0.01});
  }
  return result;
}

CaseResult still_in_space(CaseRunner& bench) {
  StillWater water;
  water.breadth = 0.75;
  water.time = bench.pick(8.0, 20.0);
  water.per_depth = bench.pick(12.0, 20.0);
  const CaseRun run = bench.run(still_water("still-tank-3d", water));
  CaseResult result = result_of(run, Verdict::stable);
  if (run.completed()) {
    result.figures.push_back({"pressure L2", pressure_error(run, water, 0.0), 0.02});
  }
  return result;
}

CaseResult still_paper(CaseRunner& bench) {
  StillWater water;
  water.time = bench.pick(12.0, 57.0);
  water.per_depth = bench.pick(15.0, 30.0);
  const CaseRun run =
      bench.run(with_scheme(still_water("still-tank-paper", water), paper_scheme()));
  CaseResult result = result_of(run, Verdict::stable, Verdict::drifting);
  if (!run.completed()) return result;
  const double error = pressure_error(run, water, 0.0);
  result.figures.push_back({"pressure L2", error, 0.08});
  if (error > 0.01) {
    result.verdict = Verdict::drifting;
    result.reason = fmt::format(
        "pressure off by {:.2g} of rho g H: eq. 7 diffuses the hydrostatic "
        "density too, and eq. 10 spreads it",
        error);
  }
  return result;
}

CaseResult still_at_sound_ratio(CaseRunner& bench, double ratio, double gate) {
  StillWater water;
  water.sound_ratio = ratio;
  water.per_depth = 10.0;
  water.time = ratio > 50 ? bench.pick(1.5, 6.0) : 6.0;
  const CaseRun run = bench.run(still_water(fmt::format("sound-{:g}", ratio), water));
  CaseResult result = result_of(run, ratio > 2 ? Verdict::stable : Verdict::rejected,
                                Verdict::stable_with_warnings);
  if (ratio <= 2) result.as_expected = result.verdict == Verdict::rejected;
  if (run.completed()) {
    result.figures.push_back({"pressure L2", pressure_error(run, water, 0.0), gate});
  }
  return result;
}
CaseResult sound_2(CaseRunner& b) { return still_at_sound_ratio(b, 2, 0.0); }
CaseResult sound_5(CaseRunner& b) { return still_at_sound_ratio(b, 5, 0.05); }
CaseResult sound_10(CaseRunner& b) { return still_at_sound_ratio(b, 10, 0.02); }
CaseResult sound_100(CaseRunner& b) { return still_at_sound_ratio(b, 100, 0.02); }
CaseResult sound_400(CaseRunner& b) { return still_at_sound_ratio(b, 400, 0.02); }

/// Largest difference of the dimensionless energies of two runs of one scene in other units.
double series_difference(const CaseRun& a, const StillWater& of_a, const CaseRun& b,
                         const StillWater& of_b) {
  const auto scale = [](const StillWater& w) {
    return w.density * w.gravity * w.depth * w.depth * w.depth;
  };
  const std::vector<double>& values_a = a.sensor("energy").values;
  const std::vector<double>& values_b = b.sensor("energy").values;
  if (values_a.size() != values_b.size()) return HUGE_VAL;
  double most = 0.0;
  for (std::size_t i = 0; i < values_a.size(); ++i) {
    most = std::max(most, std::abs(values_a[i] / scale(of_a) - values_b[i] / scale(of_b)));
  }
  return most;
}

/// A scene of other units, by the name of its figure.
struct OtherUnits {
  std::string_view name;
  StillWater water;
};

/// Water that fills half of its tank and falls: something moves.
Json falling_water(const StillWater& water, Json scheme) {
  scheme["numerics"]["precision"] = "double";
  // A viscosity in m^2/s is not the same in other units.
  scheme["numerics"].erase("laminar_viscosity");
  Json scene = with_scheme(still_water("units", water), scheme);
  // Every step: where a sample falls must not hang on the rounding of its time.
  scene["sensors"][0]["interval"] = 0.0;
  scene["fluid"][0]["size"][0] = 0.5 * scene["fluid"][0]["size"][0].get<double>();
  return scene;
}

CaseResult same_in_other_units(CaseRunner& bench, std::span<const OtherUnits> others) {
  const auto sized = [](StillWater water) {
    water.per_depth = 8.0;
    water.time = 2.0;
    return water;
  };
  const StillWater water = sized({});
  const CaseRun reference = bench.run(falling_water(water, bench.scheme()));
  CaseResult result = result_of(reference, Verdict::stable, Verdict::stable_with_warnings);
  for (const OtherUnits& units : others) {
    const StillWater other = sized(units.water);
    const CaseRun run = bench.run(falling_water(other, bench.scheme()));
    if (!run.completed()) return result_of(run, Verdict::stable, Verdict::stable_with_warnings);
    result.figures.push_back(
        {std::string(units.name), series_difference(reference, water, run, other), 1e-9});
  }
  return result;
}
CaseResult gravity_scales(CaseRunner& bench) {
  const std::array others{OtherUnits{"g x 1e-6", {.gravity = 9.81e-6}},
                          OtherUnits{"g x 1e6", {.gravity = 9.81e6}}};
  return same_in_other_units(bench, others);
}
CaseResult length_scales(CaseRunner& bench) {
  const std::array others{OtherUnits{"length x 1e-7", {.depth = 1e-7}},
                          OtherUnits{"length x 1e5", {.depth = 1e5}}};
  return same_in_other_units(bench, others);
}
CaseResult density_scales(CaseRunner& bench) {
  const std::array others{OtherUnits{"density x 1e-9", {.density = 1e-6}},
                          OtherUnits{"density x 1e3", {.density = 1e6}}};
  return same_in_other_units(bench, others);
}

CaseResult undamped_leap_frog(CaseRunner& bench) {
  StillWater water;
  water.per_depth = 10.0;
  water.time = 60.0;
  const Json bare{{"numerics", {{"integrator", "modified_leap_frog"}, {"courant", 0.5}}}};
  const CaseRun run =
      bench.run(with_scheme(still_water("undamped", water), bare), StabilityCheck::skip);
  CaseResult result = result_of(run, Verdict::unstable);
  result.figures.push_back({"without a kept checkpoint", run.last ? 0.0 : 1.0, 0.0});
  return result;
}

CaseResult zero_pressure_start(CaseRunner& bench) {
  StillWater water;
  water.per_depth = bench.pick(15.0, 40.0);
  water.time = bench.pick(20.0, 40.0);
  Json scene = still_water("zero-pressure", water);
  scene["fluid"][0]["pressure"] = "zero";
  const CaseRun run = bench.run(scene);
  CaseResult result = result_of(run, Verdict::stable, Verdict::stable_with_warnings);
  if (run.completed()) {
    result.figures.push_back({"pressure L2, last half", pressure_error(run, water, 0.5), 0.06});
  }
  return result;
}

CaseResult tall_column(CaseRunner& bench) {
  StillWater water;
  water.width = 0.05;
  water.per_depth = bench.pick(120.0, 240.0);
  water.time = bench.pick(3.0, 10.0);
  const CaseRun run = bench.run(still_water("tall-column", water));
  CaseResult result = result_of(run, Verdict::stable);
  if (run.completed()) {
    result.figures.push_back({"pressure L2", pressure_error(run, water, 0.0), 0.015});
  }
  return result;
}

constexpr std::array kTableCases{
    StabilityCase{"still-tank", "still water, recommended scheme", "pressure within 1 %",
                  still_recommended},
    StabilityCase{"still-tank-3d", "the same in space", "pressure within 2 %", still_in_space,
                  kLifted},
    StabilityCase{"still-tank-paper", "still water, the paper's scheme", "drifts by at most 8 %",
                  still_paper},
    StabilityCase{"sound-2", "c = 2 sqrt(g H)", "rejected", sound_2},
    StabilityCase{"sound-5", "c = 5 sqrt(g H)", "pressure within 5 %", sound_5},
    StabilityCase{"sound-10", "c = 10 sqrt(g H)", "pressure within 2 %", sound_10},
    StabilityCase{"sound-100", "c = 100 sqrt(g H)", "pressure within 2 %", sound_100},
    StabilityCase{"sound-400", "c = 400 sqrt(g H)", "pressure within 2 %", sound_400},
    StabilityCase{"gravity-scales", "g x 1e-6 and 1e6, double precision", "equal to 1e-9",
                  gravity_scales},
    StabilityCase{"length-scales", "lengths x 1e-7 and 1e5, double precision", "equal to 1e-9",
                  length_scales,
                  "eq. 6 is cut at R = 3, where lattice neighbours lie at h = dx: rounding decides "
                  "which of them count"},
    StabilityCase{"density-scales", "density 1e-6 and 1e6, double precision", "equal to 1e-9",
                  density_scales},
    StabilityCase{"undamped", "alpha = delta = 0 with the paper's integrator",
                  "fails by a guard, checkpoint kept", undamped_leap_frog},
    StabilityCase{"zero-pressure", "still water that starts without pressure",
                  "pressure within 6 % in the end", zero_pressure_start},
    StabilityCase{"tall-column", "still water 20 times as deep as wide", "pressure within 1.5 %",
                  tall_column},
};

}  // namespace

std::span<const StabilityCase> table_cases() { return kTableCases; }

}  // namespace sluice

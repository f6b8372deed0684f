// Waves, impacts and the smallest fluids.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "engine/scene/filling/initial.hpp"
#include "engine/verify/stability_case.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

double angular_momentum(const Particles& p) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i)
    sum += p.position[0][i] * p.velocity[1][i] - p.position[1][i] * p.velocity[0][i];
  return sum;
}

double closest_pair(const Particles& p) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(least, (p.position_of(i) - p.position_of(j)).squaredNorm());
    }
  }
  return std::sqrt(least);
}

CaseResult rotating_patch(CaseRunner& bench) {
  const double dx = 1.0 / bench.pick(20, 50);
  Json patch = cuboid(Vec2(-0.5, -0.5), Vec2(1, 1));
  patch["rotation_rate"] = -1.0;
  const CaseRun run =
      bench.run(without_tank("rotating-patch", std::move(patch), dx, 7.0, bench.pick(1.0, 2.0)));
  CaseResult result = result_of(run, Verdict::stable, Verdict::stable_with_warnings);
  if (!run.completed()) return result;
  const double at_start = angular_momentum(create_particles(run.scene).state.particles);
  const Particles& end = run.last->solver.particles;
  result.figures.push_back(
      {"angular momentum", std::abs(angular_momentum(end) / at_start - 1.0), 1e-3});
  result.figures.push_back({"clumping 1 - closest/dx", 1.0 - closest_pair(end) / dx, 1.0});
  return result;
}

/// Angular frequency at which a series that oscillates about its mean has the most of it, searched
/// within 20 % of `near`.
double dominant_frequency(const Series& series, double near) {
  const std::size_t columns = series.columns.size();
  double mean = 0.0;
  for (std::size_t n = 0; n < series.size(); ++n) mean += series.values[columns * n];
  mean /= static_cast<double>(series.size());
  const double end = series.time.back();
  double best = 0.0;
  double most = -1.0;
  for (double omega = 0.8 * near; omega < 1.2 * near; omega += 1e-3 * near) {
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < series.size(); ++n) {
      const double window = 1.0 - std::cos(2 * std::numbers::pi * series.time[n] / end);
      sum += window * (series.values[columns * n] - mean) * std::polar(1.0, omega * series.time[n]);
    }
    if (std::abs(sum) > most) {
      most = std::abs(sum);
      best = omega;
    }
  }
  return best;
}

/// First sloshing mode of a tank of width L = 2 H: k = pi/L, omega^2 = g k tanh(k H). The kinetic
/// energy goes twice as fast. In space `breadth`, in H, is above zero.
CaseResult standing_wave_in(CaseRunner& bench, std::string_view name, double breadth,
                            int per_depth) {
  constexpr double kAmplitude = 0.05;
  const double k = 0.5 * std::numbers::pi;
  const double omega = std::sqrt(kGravity * k * std::tanh(k));
  Json points = Json::array({{0.0, 0.0}, {2.0, 0.0}});
  for (int i = 100; i >= 0; --i) {
    const double x = 0.02 * i;
    points.push_back({x, 1.0 + kAmplitude * std::cos(k * x)});
  }
  Json water{{"shape", "polygon"}, {"points", points}};
  Vec tank = Vec2(2.0, 1.5);
  if (breadth > 0.0) {
    water["shape"] = "prism";
    water["z"] = 0.0;
    water["depth"] = breadth;
    tank = Vec3(2.0, 1.5, breadth);
  }
  const Json scene = tank_scene(name, tank, Json::array({water}), 1.0 / per_depth,
                                10 * std::sqrt(2 * kGravity), 4 * 2 * std::numbers::pi / omega);
  const CaseRun run = bench.run(scene);
  CaseResult result = result_of(run, Verdict::stable, Verdict::stable_with_warnings);
  if (!run.completed()) return result;
  const double found = 0.5 * dominant_frequency(run.sensor("energy"), 2 * omega);
  result.figures.push_back({"period", std::abs(omega / found - 1.0), 0.02});
  return result;
}
CaseResult standing_wave(CaseRunner& b) {
  return standing_wave_in(b, "standing-wave", 0.0, b.pick(20, 40));
}
CaseResult standing_wave_in_space(CaseRunner& b) {
  return standing_wave_in(b, "standing-wave-3d", 0.25, b.pick(12, 24));
}

/// Falls until most of the drop has met the floor. Its jets are five times as fast as the drop: the
/// tank is so wide that they meet no wall.
CaseResult droplet_at(CaseRunner& bench, double mach, Verdict expected) {
  constexpr double kDropSound = 20.0;
  const double dx = 0.1 / bench.pick(15, 40);
  Json drop = ball(Vec2(1.5, 0.12), 0.1);
  drop["velocity"] = {0.0, -mach * kDropSound};
  return result_of(
      bench.run(tank_scene(fmt::format("droplet-mach-{:g}", mach), Vec2(3.0, 0.5),
                           Json::array({drop}), dx, kDropSound, 0.2 / (mach * kDropSound))),
      expected);
}
CaseResult droplet_01(CaseRunner& b) { return droplet_at(b, 0.1, Verdict::stable_with_warnings); }
CaseResult droplet_05(CaseRunner& b) { return droplet_at(b, 0.5, Verdict::unstable); }
CaseResult droplet_1(CaseRunner& b) { return droplet_at(b, 1.0, Verdict::unstable); }

CaseResult one_particle_film(CaseRunner& bench) {
  StillWater water;
  water.depth = 0.01;
  water.width = 40;
  water.per_depth = 1;
  water.time = 50;
  const CaseRun run = bench.run(still_water("one-particle-film", water));
  return result_of(run, Verdict::stable, Verdict::stable_with_warnings);
}

/// Still water of a few hundred particles, in the plane or in space.
Json small_tank(std::string_view name, bool in_space) {
  StillWater water;
  if (in_space) {
    water.breadth = 1.0;
    water.per_depth = 8.0;
  }
  return still_water(name, water);
}

CaseResult half_perturbation_in(CaseRunner& bench, Json scene) {
  scene["perturbation"] = {{"amplitude", 0.5}};
  return result_of(bench.run(scene), Verdict::stable, Verdict::stable_with_warnings);
}

CaseResult half_perturbation(CaseRunner& b) {
  return half_perturbation_in(b, small_tank("perturbation-half", false));
}
CaseResult half_perturbation_in_space(CaseRunner& b) {
  return half_perturbation_in(b, small_tank("perturbation-half-3d", true));
}

/// A pair at one place has no direction to part in: the others must move them, without a NaN.
CaseResult coincident_in(CaseRunner& bench, const Json& scene) {
  const CaseRun run = bench.run(scene, StabilityCheck::refuse, [](Particles& p) {
    for (auto& along : p.position) along[210] = along[211];
  });
  return result_of(run, Verdict::stable, Verdict::stable_with_warnings);
}
CaseResult coincident_particles(CaseRunner& b) {
  return coincident_in(b, small_tank("coincident", false));
}
CaseResult coincident_in_space(CaseRunner& b) {
  return coincident_in(b, small_tank("coincident-3d", true));
}

CaseResult overlapping_regions(CaseRunner& bench) {
  Json scene = still_water("overlap", {});
  scene["fluid"].push_back(scene["fluid"][0]);
  return result_of(bench.run(scene), Verdict::rejected);
}

CaseResult free_fall(CaseRunner& bench) {
  Json scene = without_tank("free-fall", cuboid(Vec2::Zero(), Vec2(0.01, 0.01)), 0.01, 50.0, 1.0);
  scene["gravity"] = {0.0, -kGravity};
  scene["fluid"][0]["velocity"] = {1.0, 2.0};
  const CaseRun run = bench.run(scene);
  CaseResult result = result_of(run, Verdict::stable);
  if (!run.completed()) return result;
  const SolverState& end = run.last->solver;
  const double t = end.time;
  const Vec2 exact = Vec2(0.005, 0.005) + Vec2(t, 2 * t - 0.5 * kGravity * t * t);
  result.figures.push_back(
      {"place over path", (end.particles.position_of(0) - exact).norm() / exact.norm(), 1e-12});
  return result;
}

CaseResult absurd_values(CaseRunner& bench) {
  const Json good = with_scheme(still_water("absurd", {}), bench.scheme());
  double accepted = 0;
  CaseResult result;
  for (const auto& [pointer, value] :
       std::initializer_list<std::pair<const char*, Json>>{{"/resolution/spacing", 1e-300},
                                                           {"/resolution/spacing", 1e-6},
                                                           {"/resolution/spacing", 0.0},
                                                           {"/resolution/spacing", -0.05},
                                                           {"/resolution/spacing", nullptr},
                                                           {"/tank/width", 1e308},
                                                           {"/tank/width", -1.0},
                                                           {"/fluid/0/size/0", 1e300},
                                                           {"/gravity/1", -1e300},
                                                           {"/material/density", 1e-310},
                                                           {"/material/density", -1000.0},
                                                           {"/material/sound_speed", 1e200},
                                                           {"/numerics/courant", 0.0},
                                                           {"/numerics/courant", 1e9},
                                                           {"/end_time", 1e300}}) {
    Json scene = good;
    scene[Json::json_pointer(pointer)] = value;
    const CaseRun run = bench.run(scene);
    accepted += run.problems.empty() ? 1 : 0;
    result = result_of(run, Verdict::rejected);
  }
  result.figures.push_back({"absurd scenes accepted, of 15", accepted, 0});
  return result;
}

constexpr std::array kFlowCases{
    StabilityCase{"rotating-patch", "rotating square patch", "angular momentum to 1e-3",
                  rotating_patch},
    StabilityCase{"standing-wave", "first sloshing mode, a = H/20", "period within 2 %",
                  standing_wave},
    StabilityCase{"standing-wave-3d", "the same in space", "period within 2 %",
                  standing_wave_in_space, kLifted},
    StabilityCase{"droplet-mach-0.1", "drop on a floor at 0.1 c", "warned", droplet_01},
    StabilityCase{"droplet-mach-0.5", "drop on a floor at 0.5 c", "failed", droplet_05},
    StabilityCase{"droplet-mach-1", "drop on a floor at c", "failed", droplet_1},
    StabilityCase{"one-particle-film", "one layer of particles at rest", "stable",
                  one_particle_film, kLifted},
    StabilityCase{"perturbation-half", "particles displaced by up to half their distance", "stable",
                  half_perturbation},
    StabilityCase{"perturbation-half-3d", "the same in space", "stable",
                  half_perturbation_in_space},
    StabilityCase{"coincident", "two particles at one place", "stable", coincident_particles},
    StabilityCase{"coincident-3d", "the same in space", "stable", coincident_in_space},
    StabilityCase{"overlap", "two regions at one place", "rejected", overlapping_regions},
    StabilityCase{"free-fall", "one particle in free fall", "place to 1e-12", free_fall},
    StabilityCase{"absurd-values", "ends of double, 1e12 particles, negative sizes", "all rejected",
                  absurd_values},
};

}  // namespace

std::span<const StabilityCase> flow_cases() { return kFlowCases; }

}  // namespace sluice

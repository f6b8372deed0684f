#include "engine/verify/elliptical_drop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/scene/filling/initial.hpp"
#include "engine/verify/stability_scenes.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kEnd = 0.8;     // A t, with A = 1/s and R = 1 m
constexpr double kSound = 15.0;  // m/s

}  // namespace

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

double drop_stretch(double a_t) {
  constexpr int kSteps = 1000;
  const auto rate = [](double s) { return std::sqrt(2.0 / (1.0 + std::pow(s, -4))); };
  double s = 1.0;
  for (int n = 0; n < kSteps; ++n) {
    const double half = s + 0.5 * a_t / kSteps * rate(s);
    s += a_t / kSteps * rate(half);
  }
  return s;
}

DropRun run_drop(CaseRunner& bench, int per_radius) {
  Json drop = ball(Vec2::Zero(), 1.0);
  drop["strain_rate"] = -1.0;
  DropRun result{bench.run(without_tank(fmt::format("elliptical-drop-{}", per_radius),
                                        std::move(drop), 1.0 / per_radius, kSound, kEnd)),
                 {}};
  if (!result.run.completed() || !result.run.last) return result;
  const SolverState& end = result.run.last->solver;
  const double at_start =
      mean_square(create_particles(result.run.scene).state.particles.position[1]);
  result.point =
      DropPoint{1.0 / per_radius, std::sqrt(mean_square(end.particles.position[1]) / at_start),
                drop_stretch(end.time), static_cast<double>(end.particles.size())};
  return result;
}

std::vector<DropPoint> run_drops(CaseRunner& bench) {
  std::vector<DropPoint> points;
  for (const int per_radius :
       bench.pick(std::vector{10, 15, 20, 30}, std::vector{10, 20, 40, 80})) {
    const DropRun drop = run_drop(bench, per_radius);
    if (!drop.point) {
      throw std::runtime_error(fmt::format("the drop with R/dx = {} did not end well", per_radius));
    }
    points.push_back(*drop.point);
  }
  return points;
}

DropOrder order_of(const std::vector<DropPoint>& points) {
  DropOrder result;
  std::vector<Refined> ratios;
  for (const DropPoint& point : points) {
    ratios.push_back({point.spacing, point.ratio()});
    result.errors.push_back({point.spacing, point.error()});
  }
  const auto finer = [](const Refined& a, const Refined& b) { return a.spacing < b.spacing; };
  std::sort(ratios.begin(), ratios.end(), finer);
  std::sort(result.errors.begin(), result.errors.end(), finer);
  result.order = order_of_errors(result.errors);
  result.richardson = richardson(ratios);
  return result;
}

Table drop_table(const std::vector<DropPoint>& points) {
  const DropOrder order = order_of(points);
  Table table;
  table.title = "Elliptical drop: order of convergence";
  table.note =
      fmt::format("semi-axis at A t = {:g} over that of the exact solution; order of the error: {}",
                  kEnd, cell(order.order, 2));
  if (const auto& fit = order.richardson) {
    table.note +=
        fmt::format("; three finest: {}, order {}, limit {}, grid convergence index {} %",
                    to_string(fit->approach), cell(fit->order, 2), cell(fit->extrapolated, 5),
                    cell(fit->gci ? std::optional(100.0 * *fit->gci) : std::nullopt, 3));
  }
  table.head = {"R/dx", "particles", "semi-axis over exact", "error, %"};
  for (const DropPoint& point : points) {
    table.rows.push_back({brief(1.0 / point.spacing, 4), brief(point.particles, 12),
                          cell(point.ratio(), 5), cell(100.0 * point.error(), 3)});
  }
  return table;
}

nlohmann::ordered_json drop_json(const std::vector<DropPoint>& points) {
  const auto value = [](const std::optional<double>& number) {
    return number ? Json(*number) : Json(nullptr);
  };
  const DropOrder order = order_of(points);
  const Richardson fit = order.richardson.value_or(Richardson{});
  Json runs = Json::array();
  for (const DropPoint& point : points) {
    runs.push_back({{"spacing_over_radius", point.spacing},
                    {"particles", point.particles},
                    {"stretch", point.stretch},
                    {"exact", point.exact}});
  }
  return Json{{"flow", "elliptical drop"},
              {"end_time_s", kEnd},
              {"order_of_error", value(order.order)},
              {"richardson_order", value(fit.order)},
              {"extrapolated", value(fit.extrapolated)},
              {"grid_convergence_index", value(fit.gci)},
              {"runs", std::move(runs)}};
}

}  // namespace sluice

#include "engine/verify/stability_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/scene/model/vocabulary.hpp"
#include "engine/sph/solver/solver.hpp"
#include "engine/sph/stability/von_neumann.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

// Particles along a side, by dimensions.
int side_of(int dimensions) { return dimensions == 3 ? 10 : 20; }

constexpr double kNoise = 1e-9;  // of c
constexpr double kBeyondDoubt = 100;
constexpr int kFewestSteps = 2000;
constexpr int kMostSteps = 20000;

constexpr std::array kAlphas{0.0, 0.02, 0.1, 1.0};
constexpr std::array kDeltas{0.0, 0.1, 0.5};
/// Courant numbers of a row over its limit, and those of a row without one.
constexpr std::array kAround{0.7, 0.85, 0.95, 0.98, 1.02, 1.05, 1.15, 1.3};
constexpr std::array kWithoutLimit{0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};

Method method_of(Integrator integrator, double alpha, double delta) {
  Method m;
  m.spacing = 1.0;
  m.smoothing_length = 1.0;
  m.reference_density = 1.0;
  m.sound_speed = 1.0;
  m.integrator = integrator;
  m.precision = Precision::double_precision;
  if (alpha > 0.0) m.viscosity = ArtificialViscosity{alpha, 0.01};
  if (delta > 0.0) m.diffusion = DensityDiffusion{DiffusionKind::molteni_colagrossi, delta};
  return m;
}

SolverState noisy_patch(const Method& m, double displacement) {
  const int dimensions = m.dimensions();
  const int side = side_of(dimensions);
  SolverState state;
  state.particles = no_particles(dimensions);
  Particles& p = state.particles;
  std::mt19937_64 random(1);
  const auto either_way = [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
  const auto noise = [&] { return kNoise * m.sound_speed * either_way(); };
  const auto off = [&] { return displacement > 0.0 ? displacement * either_way() : 0.0; };
  const int count = side * side * (dimensions == 3 ? side : 1);
  for (int i = 0; i < count; ++i) {
    p.id.push_back(i);
    int rest = i;
    for (auto& along : p.position) {
      along.push_back(m.spacing * (rest % side + off()));
      rest /= side;
    }
    for (auto& along : p.velocity) along.push_back(noise());
    p.density_excess.push_back(0.0);
  }
  return state;
}

/// Enough for the fastest wave to grow by 1e5 from its share of the noise.
int steps_for(double growth_per_step) {
  if (growth_per_step <= 0.0) return kFewestSteps;
  const double steps = 1.5 * std::log(1e5) / growth_per_step;
  return static_cast<int>(std::clamp<double>(steps, kFewestSteps, kMostSteps));
}

StabilityCell make_cell(Method method, const LatticeStability& analysis, double limit,
                        double courant) {
  StabilityCell cell;
  cell.courant = method.courant = courant;
  cell.growth_per_step = analysis.spectral_radius(courant) - 1.0;
  cell.predicted_stable = courant <= limit;
  cell.measured = measure_noise(method, steps_for(cell.growth_per_step));
  return cell;
}

StabilityRow make_row(Integrator integrator, double alpha, double delta) {
  const Method method = method_of(integrator, alpha, delta);
  const LatticeStability analysis(method_as<2>(method), Surface::free);
  StabilityRow row{integrator, alpha, delta, analysis.courant_limit(), {}};
  for (std::size_t i = 0; i < kAround.size(); ++i) {
    const double courant = row.limit > 0.0 ? row.limit * kAround[i] : kWithoutLimit[i];
    row.cells.push_back(make_cell(method, analysis, row.limit, courant));
  }
  return row;
}

std::string_view name_of(Integrator integrator) { return word_for(kIntegratorWords, integrator); }

// Pixels of the picture.
constexpr double kLeft = 150;
constexpr double kTop = 50;
constexpr double kScale = 200;  // per unit of the Courant number
constexpr double kLine = 26;
constexpr double kMostShown = 3.2;

std::string mark_svg(const StabilityCell& cell, double x, double y) {
  const std::string_view fill = cell.measured.grows ? "white" : "#1b7f4b";
  const std::string_view rim = cell.measured.grows ? "#c0392b" : "#1b7f4b";
  std::string svg = fmt::format(
      R"(<circle cx="{:.1f}" cy="{:.1f}" r="4.5" fill="{}" stroke="{}" stroke-width="2"><title>C {:.4g}: {} after {} steps, factor {:.3g}</title></circle>)",
      x, y, fill, rim, cell.courant, cell.measured.grows ? "grows" : "stable", cell.measured.steps,
      cell.measured.factor);
  if (!cell.agrees()) {
    svg += fmt::format(R"(<path d="M{0:.1f} {2:.1f}L{1:.1f} {3:.1f}" stroke="black"/>)", x - 7,
                       x + 7, y - 7, y + 7);
  }
  return svg + "\n";
}

std::string row_svg(const StabilityRow& row, double y) {
  std::string svg = fmt::format("<text x=\"10\" y=\"{:.1f}\">&#945; {:g}, &#948; {:g}</text>\n",
                                y + 4, row.alpha, row.delta);
  const double limit = kLeft + kScale * row.limit;
  svg += fmt::format(
      R"(<path d="M{0:.1f} {2:.1f}H{1:.1f}" stroke="#ccc"/><path d="M{3:.1f} {4:.1f}V{5:.1f}" stroke="#2456a6" stroke-width="3"/>)"
      "\n",
      kLeft, kLeft + kScale * kMostShown, y, limit, y - 11, y + 11);
  for (const StabilityCell& cell : row.cells) {
    if (cell.courant <= kMostShown) svg += mark_svg(cell, kLeft + kScale * cell.courant, y);
  }
  return svg;
}

}  // namespace

NoiseGrowth measure_noise(const Method& method, int most_steps, double displacement) {
  Method m = method;
  const int dimensions = m.dimensions();
  FlowDomain domain;
  domain.box = {filled_vec<kAnyDim>(0.0, dimensions), filled_vec<kAnyDim>(0.0, dimensions)};
  domain.box = grown(domain.box, 10.0 * side_of(dimensions) * m.spacing);
  domain.rim = domain.room = Box::everywhere(dimensions);
  m.gravity.setZero();
  Solver solver(m, domain, noisy_patch(m, displacement), {}, {});
  const double start = solver.extremes().max_speed;
  NoiseGrowth growth;
  while (growth.steps < most_steps && !growth.grows) {
    solver.step();
    ++growth.steps;
    growth.factor = solver.extremes().max_speed / start;
    growth.grows = !(growth.factor < kBeyondDoubt);
  }
  return growth;
}

double StabilityRow::measured_limit() const {
  double stable = 0.0;
  for (const StabilityCell& cell : cells) {
    if (cell.measured.grows) return stable > 0.0 ? 0.5 * (stable + cell.courant) : 0.0;
    stable = cell.courant;
  }
  return stable;
}

std::size_t StabilityMap::cells() const {
  std::size_t sum = 0;
  for (const StabilityRow& row : rows) sum += row.cells.size();
  return sum;
}

std::size_t StabilityMap::disagreements() const {
  std::size_t sum = 0;
  for (const StabilityRow& row : rows) {
    sum += static_cast<std::size_t>(std::count_if(row.cells.begin(), row.cells.end(),
                                                  [](const auto& c) { return !c.agrees(); }));
  }
  return sum;
}

StabilityMap make_stability_map(const std::function<void(const StabilityRow&)>& done) {
  StabilityMap map;
  for (const Integrator integrator :
       {Integrator::modified_leap_frog, Integrator::kick_drift_kick}) {
    for (const double alpha : kAlphas) {
      for (const double delta : kDeltas) {
        map.rows.push_back(make_row(integrator, alpha, delta));
        done(map.rows.back());
      }
    }
  }
  return map;
}

std::string map_text_line(const StabilityRow& row) {
  std::string marks;
  for (const StabilityCell& cell : row.cells) {
    marks += fmt::format(" {:.3f}{}{}", cell.courant, cell.measured.grows ? "-" : "+",
                         cell.agrees() ? " " : "!");
  }
  return fmt::format("{:<19} alpha {:<5g} delta {:<4g} predicted {:.3f} measured {:.3f} {}",
                     name_of(row.integrator), row.alpha, row.delta, row.limit, row.measured_limit(),
                     marks);
}

nlohmann::ordered_json map_json(const StabilityMap& map) {
  Json rows = Json::array();
  for (const StabilityRow& row : map.rows) {
    Json cells = Json::array();
    for (const StabilityCell& cell : row.cells) {
      cells.push_back({{"courant", cell.courant},
                       {"predicted", cell.predicted_stable ? "stable" : "unstable"},
                       {"growth_per_step", cell.growth_per_step},
                       {"measured", cell.measured.grows ? "unstable" : "stable"},
                       {"factor", cell.measured.factor},
                       {"steps", cell.measured.steps}});
    }
    rows.push_back({{"integrator", name_of(row.integrator)},
                    {"alpha", row.alpha},
                    {"delta", row.delta},
                    {"predicted_limit", row.limit},
                    {"measured_limit", row.measured_limit()},
                    {"cells", cells}});
  }
  return {{"cells", map.cells()}, {"disagreements", map.disagreements()}, {"rows", rows}};
}

std::string map_svg(const StabilityMap& map) {
  std::string body;
  double y = kTop;
  std::string_view last;
  for (const StabilityRow& row : map.rows) {
    if (name_of(row.integrator) != last) {
      last = name_of(row.integrator);
      body +=
          fmt::format("<text x=\"10\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n", y + 4, last);
      y += kLine;
    }
    body += row_svg(row, y);
    y += kLine;
  }
  for (double c = 0.0; c <= kMostShown; c += 0.5) {
    body += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.1f}</text>\n",
                        kLeft + kScale * c, y + 4, c);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n"
      "<text x=\"10\" y=\"20\">Courant number: line predicted limit, full mark stable, hollow mark "
      "grows, crossed mark differs from the prediction</text>\n{}</svg>\n",
      kLeft + kScale * kMostShown + 20, y + 20, body);
}

}  // namespace sluice

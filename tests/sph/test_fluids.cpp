#include "tests/sph/test_fluids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace sluice {

SolverN<2> solver_for(const TestMethod& m, const SolverStateN<2>& state,
                      const std::vector<Vec2>& walls, const Execution& execution) {
  return {m, m.domain, state, walls, execution};
}

TestMethod plain_method() {
  TestMethod m;
  m.spacing = 0.1;
  m.smoothing_length = 0.1;
  m.reference_density = 1000.0;
  m.sound_speed = 20.0;
  m.precision = Precision::double_precision;
  m.domain.box = {{-2.0, -2.0}, {2.0, 2.0}};
  return m;
}

TestMethod full_method() {
  TestMethod m = plain_method();
  m.smoothing_length = 0.12;
  m.gravity = {0.7, -9.81};
  m.diffusion = DensityDiffusion{DiffusionKind::fourtakas, 0.13};
  m.viscosity = ArtificialViscosity{0.06, 0.02};
  m.wall_artificial_viscosity = WallArtificialViscosity{0.09, 0.03};
  m.reinitialisation = Reinitialisation{20};
  return m;
}

Fluid random_block(Dice& dice, const Vec2& corner, int columns, int rows, double spacing,
                   double perturbation, double speed, double excess) {
  Fluid fluid;
  const Vec2 one = Vec2::Ones();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 place = corner + spacing * Vec2(column + 0.5, row + 0.5);
      const Vec2 shift = dice.in_box(-perturbation * spacing * one, perturbation * spacing * one);
      const Vec2 velocity = dice.in_box(-speed * one, speed * one);
      fluid.add(place + shift, velocity, dice.between(-excess, excess));
    }
  }
  return fluid;
}

std::vector<Vec2> walls_around(const Vec2& corner, int columns, int rows, double spacing) {
  constexpr int kLayers = 3;
  std::vector<Vec2> walls;
  for (int row = -kLayers; row < rows; ++row) {
    for (int column = -kLayers; column < columns + kLayers; ++column) {
      if (row >= 0 && column >= 0 && column < columns) continue;
      walls.emplace_back(corner + spacing * Vec2(column + 0.5, row + 0.5));
    }
  }
  return walls;
}

SolverStateN<2> start_from(const Fluid& fluid) {
  SolverStateN<2> state;
  ParticlesN<2>& p = state.particles;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    append(p.position, fluid.x[i]);
    append(p.velocity, fluid.v[i]);
    p.density_excess.push_back(fluid.excess[i]);
    p.id.push_back(static_cast<double>(i));
  }
  return state;
}

std::vector<double> by_id(const SolverStateN<2>& state,
                          const FieldMember<ParticlesN<2>, Values, ParticlesN<2>::Axes>& field) {
  const ParticlesN<2>& p = state.particles;
  std::vector<double> values(p.size(), std::nan(""));
  for (std::size_t i = 0; i < p.size(); ++i) {
    values.at(static_cast<std::size_t>(p.id[i])) = field.of(p)[i];
  }
  return values;
}

Fluid fluid_of(const SolverStateN<2>& state) {
  const auto x = by_id(state, {&ParticlesN<2>::position, 0});
  const auto y = by_id(state, {&ParticlesN<2>::position, 1});
  const auto vx = by_id(state, {&ParticlesN<2>::velocity, 0});
  const auto vy = by_id(state, {&ParticlesN<2>::velocity, 1});
  Fluid fluid;
  for (std::size_t i = 0; i < x.size(); ++i) fluid.add({x[i], y[i]}, {vx[i], vy[i]});
  fluid.excess = by_id(state, &ParticlesN<2>::density_excess);
  return fluid;
}

Fluid middle_of_step(Fluid fluid, const SolverStateN<2>& start, double dt) {
  const auto ax = by_id(start, {&ParticlesN<2>::acceleration, 0});
  const auto ay = by_id(start, {&ParticlesN<2>::acceleration, 1});
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    fluid.v[i] += 0.5 * dt * Vec2(ax[i], ay[i]);
    fluid.x[i] += 0.5 * dt * fluid.v[i];
  }
  return fluid;
}

void expect_same_bits(const SolverStateN<2>& a, const SolverStateN<2>& b, const std::string& what) {
  for (const FieldN<2>& field : FieldList<2>::fields) {
    const auto& one = field.values.of(a.particles);
    const auto& other = field.values.of(b.particles);
    ASSERT_EQ(one.size(), other.size()) << what << ", field " << field.name;
    if (one.empty()) continue;
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0)
        << what << ", field " << field.name;
  }
  EXPECT_EQ(a.step, b.step) << what;
  EXPECT_EQ(std::memcmp(&a.time, &b.time, sizeof(double)), 0) << what << ", time";
  EXPECT_EQ(std::memcmp(&a.time_step, &b.time_step, sizeof(double)), 0) << what << ", time step";
  ASSERT_EQ(a.removed.size(), b.removed.size()) << what;
  for (std::size_t k = 0; k < a.removed.size(); ++k) {
    const RemovedParticleN<2>& one = a.removed[k];
    const RemovedParticleN<2>& other = b.removed[k];
    EXPECT_EQ(std::tie(one.id, one.cause, one.step, one.time, one.position, one.velocity,
                       one.density_excess),
              std::tie(other.id, other.cause, other.step, other.time, other.position,
                       other.velocity, other.density_excess))
        << what << ", removed " << k;
  }
}

void expect_near(std::span<const double> a, std::span<const double> b, double tolerance,
                 const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  double worst = 0.0;
  std::size_t where = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double error = std::abs(a[i] - b[i]);
    if (error <= worst) continue;  // a NaN is worse than any number
    worst = error;
    where = i;
    if (std::isnan(error)) break;
  }
  EXPECT_LE(worst, tolerance) << what << ": particle " << where << " has " << a[where]
                              << ", expected " << b[where];
}

void expect_near(std::span<const Vec2> a, std::span<const Vec2> b, double tolerance,
                 const std::string& what) {
  const auto flat = [](std::span<const Vec2> vectors) {
    std::vector<double> numbers;
    for (const Vec2& v : vectors) numbers.insert(numbers.end(), {v.x(), v.y()});
    return numbers;
  };
  expect_near(flat(a), flat(b), tolerance, what + " (x0, y0, x1, ...)");
}

void run_steps(SolverN<2>& solver, int steps) {
  for (int n = 0; n < steps; ++n) solver.step();
}

FluidRates rates_at_start(TestMethod m, const Fluid& fluid, const std::vector<Vec2>& walls) {
  m.integrator = Integrator::modified_leap_frog;
  SolverN<2> solver = solver_for(m, start_from(fluid), walls, {});
  return rates_of_next_step(solver);
}

FluidRates rates_of_next_step(SolverN<2>& solver) {
  solver.step();
  const SolverStateN<2> state = solver.state();
  const Fluid full = fluid_of(state);
  const auto vx_half = by_id(state, {&ParticlesN<2>::velocity_half, 0});
  const auto vy_half = by_id(state, {&ParticlesN<2>::velocity_half, 1});
  const auto half = by_id(state, &ParticlesN<2>::density_excess_half);
  const double half_step = 0.5 * solver.time_step();
  FluidRates rates;
  for (std::size_t i = 0; i < full.size(); ++i) {
    rates.acceleration.emplace_back((full.v[i] - Vec2(vx_half[i], vy_half[i])) / half_step);
    rates.density.push_back((full.excess[i] - half[i]) / half_step);
  }
  return rates;
}

std::string name_of(Integrator integrator) {
  return integrator == Integrator::modified_leap_frog ? "leap-frog" : "kick-drift-kick";
}

std::string name_of(Precision precision) {
  return precision == Precision::mixed ? "mixed" : "double";
}

}  // namespace sluice

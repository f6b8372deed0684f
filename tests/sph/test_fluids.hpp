#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/sph/solver/solver.hpp"

namespace sluice {

/// Fluid particles in the order of their ids, SI units: what a test hands to a solver and reads
/// back.
struct Fluid {
  std::vector<Vec2> x;
  std::vector<Vec2> v;
  std::vector<double> excess;  ///< rho - rho_0, kg/m^3

  void add(const Vec2& position, const Vec2& velocity = Vec2::Zero(), double density_excess = 0.0) {
    x.push_back(position);
    v.push_back(velocity);
    excess.push_back(density_excess);
  }
  [[nodiscard]] std::size_t size() const { return x.size(); }
};

/// Uniform numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : bits_(seed) {}
  /// In [low, high).
  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * 0x1p-53 * static_cast<double>(bits_() >> 11U);
  }
  [[nodiscard]] Vec2 in_box(const Vec2& low, const Vec2& high) {
    const double x = between(low.x(), high.x());
    return {x, between(low.y(), high.y())};
  }
  [[nodiscard]] std::size_t below(std::size_t count) { return bits_() % count; }

 private:
  std::mt19937_64 bits_;
};

/// A method, and where the fluid of a test may be.
struct TestMethod : MethodN<2> {
  FlowDomainN<2> domain;
};
[[nodiscard]] SolverN<2> solver_for(const TestMethod& m, const SolverStateN<2>& state,
                                    const std::vector<Vec2>& walls, const Execution& execution);

/// dx = h = 0.1 m, rho_0 = 1000 kg/m^3, c = 20 m/s; a domain of +-2 m; no term, no gravity, no
/// walls. The numbers are chosen to differ from 1 and from each other.
[[nodiscard]] TestMethod plain_method();

/// plain_method() with every term, gravity (0.7, -9.81) m/s^2 and smoothing length 0.12 m.
[[nodiscard]] TestMethod full_method();

/// columns x rows particles at the cell centres of a lattice of spacing dx from `corner`, each
/// moved by up to `perturbation` dx, with velocities up to `speed` (m/s) and excesses up to
/// `excess` (kg/m^3) in size.
[[nodiscard]] Fluid random_block(Dice& dice, const Vec2& corner, int columns, int rows,
                                 double spacing, double perturbation, double speed, double excess);

/// Three layers of wall particles below and to both sides of a block that starts at `corner`.
[[nodiscard]] std::vector<Vec2> walls_around(const Vec2& corner, int columns, int rows,
                                             double spacing);

/// A state at rest in time with ids 0, 1, ... in the order of the fluid.
[[nodiscard]] SolverStateN<2> start_from(const Fluid& fluid);

/// The particles of a state in the order of their ids, which must be 0 ... N-1.
[[nodiscard]] Fluid fluid_of(const SolverStateN<2>& state);

/// A field of a state in the order of ids.
[[nodiscard]] std::vector<double> by_id(
    const SolverStateN<2>& state,
    const FieldMember<ParticlesN<2>, Values, ParticlesN<2>::Axes>& field);

/// Where kick-drift-kick sums eq. 4 in a step of length dt from `fluid`: half a kick by the
/// accelerations of `start`, the state of a solver that holds it, and half a drift later.
[[nodiscard]] Fluid middle_of_step(Fluid fluid, const SolverStateN<2>& start, double dt);

/// Fails the test unless both states hold the same bits.
void expect_same_bits(const SolverStateN<2>& a, const SolverStateN<2>& b, const std::string& what);

/// Fails the test unless all of a and b agree to `tolerance`, absolute.
void expect_near(std::span<const double> a, std::span<const double> b, double tolerance,
                 const std::string& what);
void expect_near(std::span<const Vec2> a, std::span<const Vec2> b, double tolerance,
                 const std::string& what);

void run_steps(SolverN<2>& solver, int steps);

/// Rates by id.
struct FluidRates {
  std::vector<Vec2> acceleration;  ///< m/s^2
  std::vector<double> density;     ///< kg/(m^3 s)
};

/// What the engine sums for this fluid at rest in time, out of one leap-frog step.
[[nodiscard]] FluidRates rates_at_start(TestMethod m, const Fluid& fluid,
                                        const std::vector<Vec2>& walls);

/// Makes one leap-frog step and returns the rates that it used: its last half kick is dt/2 times
/// the rate.
[[nodiscard]] FluidRates rates_of_next_step(SolverN<2>& solver);

[[nodiscard]] std::string name_of(Integrator integrator);
[[nodiscard]] std::string name_of(Precision precision);

inline constexpr Integrator kIntegrators[] = {Integrator::modified_leap_frog,
                                              Integrator::kick_drift_kick};
inline constexpr Precision kPrecisions[] = {Precision::mixed, Precision::double_precision};
inline constexpr KernelKind kKernels[] = {KernelKind::truncated_gaussian, KernelKind::wendland_c2};

}  // namespace sluice

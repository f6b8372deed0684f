#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/space/vec.hpp"
#include "engine/sph/method/flow_domain.hpp"
#include "engine/sph/method/method.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/pairs/list_paths.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/pairs/sum_blocks.hpp"

namespace sluice {

/// The state of the slots [begin, end) of one chunk, SI units; a field that the integrator does not
/// carry is null. Empty slots have id -1 and take part in the arithmetic, but in no result.
template <int Dim>
struct ParticleSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::array<double*, Dim> position{};
  std::array<double*, Dim> velocity{};
  double* density_excess = nullptr;
  std::array<double*, Dim> velocity_half{};
  double* density_excess_half = nullptr;
  std::array<double*, Dim> acceleration{};
  const double* id = nullptr;

  /// Position of a slot, m.
  [[nodiscard]] VecN<Dim> place(std::size_t slot) const {
    VecN<Dim> place;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      place[static_cast<Eigen::Index>(axis)] = position[axis][slot];
    }
    return place;
  }
};

/// Out of pair sums into rates: D rho/Dt = density_scale * sum, Dv/Dt = acceleration_scale * sum +
/// gravity.
template <typename T, int Dim>
struct Rates {
  const T* sums = nullptr;     ///< of the clusters of a chunk
  std::size_t first_slot = 0;  ///< of the chunk
  SumBlocks<Dim> blocks;
  double density_scale = 0.0;             ///< kg/(m^3 s)
  double acceleration_scale = 0.0;        ///< m/s^2
  VecN<Dim> gravity = VecN<Dim>::Zero();  ///< m/s^2
};

/// One shift of the particles.
template <int Dim>
struct Shift {
  double per_speed = 0.0;                     ///< A, its duration and the scale of the sums, s
  double trace_scale = 0.0;                   ///< out of the sums into the trace
  double most = 0.0;                          ///< no particle is shifted farther, m
  VecN<Dim> hydrostatic = VecN<Dim>::Zero();  ///< rho_0 f/c^2, kg/m^4: goes with the place
};

/// What a pass over a chunk saw. Maxima and minima do not depend on the order of chunks.
struct Motion {
  double speed_sq = 0.0;         ///< largest, m^2/s^2
  double acceleration_sq = 0.0;  ///< largest, m^2/s^4
  double min_density_excess = 1e300;
  double max_density_excess = -1e300;
  double max_x = -1e300;  ///< m
  bool expired = false;   ///< a particle is off its path by more than the leeway
  bool leaving = false;   ///< a particle is to be removed

  void merge(const Motion& other) {
    speed_sq = std::max(speed_sq, other.speed_sq);
    acceleration_sq = std::max(acceleration_sq, other.acceleration_sq);
    min_density_excess = std::min(min_density_excess, other.min_density_excess);
    max_density_excess = std::max(max_density_excess, other.max_density_excess);
    max_x = std::max(max_x, other.max_x);
    expired |= other.expired;
    leaving |= other.leaving;
  }
};

/// Scales from the state to PairArrays.
template <int Dim>
struct PairScales {
  double inverse_length = 0.0;                ///< 1/h
  double inverse_speed = 0.0;                 ///< 1/c
  double inverse_density = 0.0;               ///< 1/rho_0
  VecN<Dim> hydrostatic = VecN<Dim>::Zero();  ///< f/c^2, 1/m: psi = s - hydrostatic . x +
                                              ///< hydrostatic_middle; zero for Molteni-Colagrossi
  double hydrostatic_middle = 0.0;  ///< hydrostatic . x in the middle of the domain: taken off psi,
                                    ///< so that its size does not depend on where the scene lies
  const Grid<Dim>* grid = nullptr;
  /// Per cluster; its centre is the origin of the places.
  const typename Grid<Dim>::OriginCell* origin_cell = nullptr;
};

/// The numbers of the bits that are set in a byte, from the lowest on.
inline constexpr auto kBitsOfByte = [] {
  std::array<std::array<std::uint8_t, 8>, 256> numbers{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    std::size_t count = 0;
    for (std::uint8_t bit = 0; bit < 8; ++bit) {
      if ((byte >> bit & 1U) != 0) numbers[byte][count++] = bit;
    }
  }
  return numbers;
}();

/// A row, by its clusters, of which there are some, and the part of it that is near a point, in
/// smoothing lengths of the method.
struct RowPart {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  float left = 0.0F;
  float right = 0.0F;
};

/// A point to sum around.
template <int Dim>
struct Surroundings {
  VecN<Dim> point = VecN<Dim>::Zero();  ///< m
  double smoothing_length = 0.0;        ///< h of the kernel, m
  double reference_density = 0.0;       ///< kg/m^3
  BoxesView<Dim> boxes;
  std::span<const RowPart> rows;
};

/// Sums over the particles around a point, with the kernel's value but for its constant and 1/h^d.
struct PointSums {
  double kernel = 0.0;   ///< W
  double excess = 0.0;   ///< W (rho - rho_0), kg/m^3
  double volumes = 0.0;  ///< W/rho, m^3/kg
};

template <int Dim>
using SumAround = PointSums (*)(const ParticlesN<Dim>&, const Surroundings<Dim>&);

/// The loops over particles, one SIMD target; T is the type of the pair sums. All state is double.
template <typename T, int Dim>
struct Updates {
  /// eqs. 13-17: half step, drift, full step. `dt_mean` is the mean of this and the last step.
  void (*leap_frog)(const ParticleSpan<Dim>&, const Rates<T, Dim>&, double dt_mean,
                    double dt) = nullptr;
  /// v += dt/2 a, x += dt/2 v.
  void (*kick_drift)(const ParticleSpan<Dim>&, double dt) = nullptr;
  /// rho += dt Drho/Dt, x += dt/2 v.
  void (*density_drift)(const ParticleSpan<Dim>&, const Rates<T, Dim>&, double dt) = nullptr;
  /// Shifts particles inside the fluid towards where others lack, and their densities by the
  /// hydrostatic part of the way.
  void (*shift)(const ParticleSpan<Dim>&, const Rates<T, Dim>&, const Shift<Dim>&) = nullptr;
  /// a = rates, v += dt/2 a.
  void (*kick)(const ParticleSpan<Dim>&, const Rates<T, Dim>&, double dt) = nullptr;
  /// State to pair arrays: places (with psi where it is kept), velocities, densities.
  void (*write_places)(const ParticleSpan<Dim>&, const PairScales<Dim>&,
                       PairArrays<T, Dim>&) = nullptr;
  void (*write_velocities)(const ParticleSpan<Dim>&, const PairScales<Dim>&,
                           PairArrays<T, Dim>&) = nullptr;
  void (*write_densities)(const ParticleSpan<Dim>&, const PairScales<Dim>&,
                          PairArrays<T, Dim>&) = nullptr;
  /// Whether a particle, `elapsed` h/c after the paths began, is off its own.
  void (*compare)(const ParticleSpan<Dim>&, const PairArrays<T, Dim>&, const ListPathsView<T, Dim>&,
                  T elapsed, Motion&) = nullptr;
  /// Adds to a chunk's own sums those that others have for it, in this order.
  void (*gather)(std::span<const Contribution>, const T* const* sums_of_chunks, std::size_t stride,
                 T* own) = nullptr;
  /// eq. 10 into both time levels, by the same increment.
  void (*reinitialise)(const ParticleSpan<Dim>&, const Rates<T, Dim>&,
                       double reference_density) = nullptr;
  /// Speeds, densities, the front and who is to be removed.
  void (*measure)(const ParticleSpan<Dim>&, const MethodN<Dim>&, const FlowDomainN<Dim>&,
                  Motion&) = nullptr;
  /// Largest acceleration of the state.
  void (*measure_acceleration)(const ParticleSpan<Dim>&, Motion&) = nullptr;
  /// Largest acceleration of the rates.
  void (*measure_rates)(const ParticleSpan<Dim>&, const Rates<T, Dim>&, Motion&) = nullptr;
  /// Over the clusters of the rows that are near the point, in memory order.
  SumAround<Dim> sum_around = nullptr;
  /// Adds the energy of the particles.
  void (*sum_energy)(const ParticleSpan<Dim>&, const MethodN<Dim>&, Energy&) = nullptr;
};

}  // namespace sluice

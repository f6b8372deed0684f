#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "engine/space/lattice.hpp"
#include "engine/space/space_traits.hpp"
#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/method/method.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {

/// Small velocities and density excesses of the particles of a lattice at rest, and the steps of
/// both integrators in place: eqs. 4, 5, 7 and 8 made linear, summed over neighbours particle by
/// particle. No waves, no matrices. Units of h and c.
template <int Dim>
class LinearLattice {
 public:
  /// `size` particles along each axis, periodic but along one where `layers` is not 0: then so many
  /// particles along kUpAxis with a free surface on both sides. Starts from noise.
  LinearLattice(const MethodN<Dim>& method, int size, int layers) : method_(method) {
    last_.fill(size - 1);
    if (layers > 0) last_[kUpAxis] = layers - 1;
    is_sheet_ = layers > 0;
    count_ = index_between<Dim>({}, last_, last_) + 1;
    for_each_cell<Dim>({}, last_, [&](const CellN<Dim>& cell) { add_neighbours(cell); });
    Dice dice(3);
    state_.resize(count_ * kValues);
    for (double& value : state_) value = dice.between(-1.0, 1.0);
    half_ = state_;
  }

  void step(double courant) {
    if (method_.integrator == Integrator::modified_leap_frog) {
      const std::vector<double> rates = rates_of(state_);
      for (std::size_t n = 0; n < state_.size(); ++n) {
        half_[n] += courant * rates[n];
        state_[n] = half_[n] + 0.5 * courant * rates[n];
      }
      return;
    }
    const std::vector<double> before = rates_of(state_);
    const std::vector<double> old = state_;
    for (std::size_t n = Dim; n < state_.size(); n += kValues) state_[n] += courant * before[n];
    // Velocities are damped by themselves, and driven by the new densities.
    std::vector<double> mixed = old;
    for (std::size_t n = Dim; n < state_.size(); n += kValues) mixed[n] = state_[n];
    const std::vector<double> rates = rates_of(mixed);
    for (std::size_t n = 0; n < state_.size(); ++n) {
      if (n % kValues != Dim) state_[n] += courant * rates[n];
    }
  }

  /// Growth per step in the mean of so many, after as many in which the fastest wave outgrows the
  /// others.
  double growth(double courant, int steps) {
    for (int n = 0; n < steps; ++n) {
      step(courant);
      scale_to_one();
    }
    double logarithm = 0.0;
    for (int n = 0; n < steps; ++n) {
      step(courant);
      logarithm += std::log(scale_to_one());
    }
    return std::exp(logarithm / steps);
  }

 private:
  static constexpr std::size_t kValues = Dim + 1;  // velocity, density
  struct Neighbour {
    std::size_t i, j;
    VecN<Dim> distance;
    double weight;  ///< V_j slope
  };

  void add_neighbours(const CellN<Dim>& cell) {
    const double spacing = method_.spacing / method_.smoothing_length;
    const double support = method_.support_ratio();
    const auto reach = static_cast<std::int64_t>(support / spacing) + 1;
    for_each_cell<Dim>(
        shifted<Dim>({}, -reach), shifted<Dim>({}, reach), [&](const CellN<Dim>& offset) {
          const VecN<Dim> distance = -spacing * as_vector<Dim>(offset);
          const double r_sq = distance.squaredNorm();
          if (r_sq == 0.0 || r_sq >= support * support) return;
          CellN<Dim> other;
          for (std::size_t axis = 0; axis < other.size(); ++axis) {
            other[axis] = cell[axis] + offset[axis];
            const std::int64_t size = last_[axis] + 1;
            const bool outside = other[axis] < 0 || other[axis] >= size;
            if (outside && is_sheet_ && axis == kUpAxis) return;
            other[axis] = (other[axis] % size + size) % size;
          }
          neighbours_.push_back(
              {index_between<Dim>({}, last_, cell), index_between<Dim>({}, last_, other), distance,
               cell_measure<Dim>(spacing) * kernel_slope<Dim>(method_.kernel, r_sq)});
        });
  }

  [[nodiscard]] std::vector<double> rates_of(const std::vector<double>& state) const {
    // Of the pairs of a small motion half approach.
    const double alpha = method_.viscosity ? 0.5 * method_.viscosity->alpha : 0.0;
    const double epsilon = method_.viscosity ? method_.viscosity->epsilon : 1.0;
    const double delta = method_.diffusion ? method_.diffusion->delta : 0.0;
    std::vector<double> rates(state.size(), 0.0);
    for (const Neighbour& pair : neighbours_) {
      const double* i = &state[pair.i * kValues];
      const double* j = &state[pair.j * kValues];
      double* rate = &rates[pair.i * kValues];
      double approach = 0.0;  // v_ij . x_ij
      for (int a = 0; a < Dim; ++a) approach += (i[a] - j[a]) * pair.distance[a];
      const double drag = alpha * approach / (pair.distance.squaredNorm() + epsilon);
      for (int a = 0; a < Dim; ++a) {
        rate[a] += pair.weight * (i[Dim] + j[Dim] - drag) * pair.distance[a];
      }
      rate[Dim] -= pair.weight * (approach + 2.0 * delta * (i[Dim] - j[Dim]));
    }
    return rates;
  }

  /// Returns the norm that the state had.
  double scale_to_one() {
    double sum = 0.0;
    for (const double value : state_) sum += value * value;
    const double norm = std::sqrt(sum);
    for (double& value : state_) value /= norm;
    for (double& value : half_) value /= norm;
    return norm;
  }

  MethodN<Dim> method_;
  bool is_sheet_ = false;
  CellN<Dim> last_{};
  std::size_t count_ = 0;
  std::vector<Neighbour> neighbours_;
  std::vector<double> state_;
  std::vector<double> half_;  ///< of the paper's integrator
};

}  // namespace sluice

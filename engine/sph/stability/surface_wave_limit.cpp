#include "engine/sph/stability/surface_wave_limit.hpp"

#include <numbers>

#include "engine/space/lattice.hpp"
#include "engine/space/space_traits.hpp"
#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/stability/brillouin_zone.hpp"
#include "engine/sph/stability/eigenvalues.hpp"

namespace sluice {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;

/// Two more than the reach of the kernels at their usual smoothing lengths: the two surfaces do not
/// see one another.
constexpr Index kLayers = 6;
constexpr int kWaves = 12;

/// A particle of layer i and one of layer j.
template <int Dim>
struct LayerPair {
  Index i, j;
  VecN<Dim> distance;  ///< X_ij
  double weight;       ///< V_j slope
};

/// A vector along the sheet, which is normal to kUpAxis.
template <int Dim>
VecN<Dim> along_sheet(const CellN<Dim - 1>& cell) {
  VecN<Dim> vector = VecN<Dim>::Zero();
  for (std::size_t k = 0; k < cell.size(); ++k) {
    vector[SpaceTraits<Dim>::floor_axes[k]] = static_cast<double>(cell[k]);
  }
  return vector;
}

template <int Dim>
std::vector<LayerPair<Dim>> pairs_of_sheet(const MethodN<Dim>& m) {
  const double spacing = m.spacing / m.smoothing_length;
  const double support = m.support_ratio();
  const auto reach = static_cast<std::int64_t>(support / spacing) + 1;
  const auto first = shifted<Dim - 1>({}, -reach);
  const auto last = shifted<Dim - 1>({}, reach);
  std::vector<LayerPair<Dim>> pairs;
  for (Index i = 0; i < kLayers; ++i) {
    for (Index j = 0; j < kLayers; ++j) {
      for_each_cell_x_slowest<Dim - 1>(first, last, [&](const CellN<Dim - 1>& cell) {
        VecN<Dim> offset = along_sheet<Dim>(cell);
        offset[kUpAxis] = static_cast<double>(i - j);
        const VecN<Dim> distance = spacing * offset;
        const double r_sq = distance.squaredNorm();
        if (r_sq == 0.0 || r_sq >= support * support) return;
        pairs.push_back(
            {i, j, distance, cell_measure<Dim>(spacing) * kernel_slope<Dim>(m.kernel, r_sq)});
      });
    }
  }
  return pairs;
}

/// `phase` is the value of the wave at j over that at i.
template <int Dim>
void add(const LayerPair<Dim>& pair, std::complex<double> phase, const MethodN<Dim>& m,
         double approaching, SheetWave& w) {
  const Index i = pair.i;
  const Index j = pair.j;
  const double alpha = m.viscosity ? m.viscosity->alpha : 0.0;
  const double epsilon = m.viscosity ? m.viscosity->epsilon : 0.0;
  const double delta = m.diffusion ? m.diffusion->delta : 0.0;
  const double drag = approaching * alpha * pair.weight / (pair.distance.squaredNorm() + epsilon);
  const double shear = scaled_two_nu(m.laminar_viscosity, m) * pair.weight;
  for (Index a = 0; a < Dim; ++a) {
    w.damping(Dim * i + a, Dim * i + a) += shear;
    w.damping(Dim * i + a, Dim * j + a) -= shear * phase;
    const double slope = pair.weight * pair.distance(a);
    w.divergence(i, Dim * i + a) -= slope;
    w.divergence(i, Dim * j + a) += slope * phase;
    w.pressure(Dim * i + a, i) += slope;
    w.pressure(Dim * i + a, j) += slope * phase;
    for (Index b = 0; b < Dim; ++b) {
      const double tensor = drag * pair.distance(a) * pair.distance(b);
      w.damping(Dim * i + a, Dim * i + b) += tensor;
      w.damping(Dim * i + a, Dim * j + b) -= tensor * phase;
    }
  }
  w.diffusion(i, i) += 2.0 * delta * pair.weight;
  w.diffusion(i, j) -= 2.0 * delta * pair.weight * phase;
}

template <int Dim>
SheetWave sheet_wave(const MethodN<Dim>& m, const std::vector<LayerPair<Dim>>& pairs,
                     const VecN<Dim>& k, double approaching) {
  constexpr Index kVelocities = Dim * kLayers;
  SheetWave w{MatrixXcd::Zero(kLayers, kVelocities),
              MatrixXcd::Zero(kVelocities, kLayers),
              MatrixXcd::Zero(kVelocities, kVelocities),
              MatrixXcd::Zero(kLayers, kLayers),
              {}};
  for (const LayerPair<Dim>& pair : pairs) {
    add(pair, std::polar(1.0, -k.dot(pair.distance)), m, approaching, w);
  }
  return w;
}

void find_rates(SheetWave& w) {
  const Index size = w.damping.rows() + w.diffusion.rows();
  MatrixXcd all(size, size);
  all << -w.damping, w.pressure, w.divergence, -w.diffusion;
  w.rates = eigenvalues(all);
}

}  // namespace

double SheetWave::kick_drift_kick_radius(double courant) const {
  const Index layers = diffusion.rows();
  const Index velocities = damping.rows();
  const Index size = velocities + layers;
  MatrixXcd density(layers, size);
  density << courant * divergence, MatrixXcd::Identity(layers, layers) - courant * diffusion;
  MatrixXcd step = MatrixXcd::Zero(size, size);
  step.topLeftCorner(velocities, velocities) =
      MatrixXcd::Identity(velocities, velocities) - courant * damping;
  step.topRows(velocities) += courant * pressure * density;
  step.bottomRows(layers) = density;
  return spectral_radius(step);
}

template <int Dim>
std::vector<SheetWave> sheet_waves(const MethodN<Dim>& method, double approaching) {
  const std::vector<LayerPair<Dim>> pairs = pairs_of_sheet(method);
  std::vector<SheetWave> waves;
  const double shortest = std::numbers::pi * method.smoothing_length / method.spacing;
  for_each_wave<Dim - 1>(kWaves, [&](const CellN<Dim - 1>& cell) {
    const VecN<Dim> k = along_sheet<Dim>(cell) * shortest / kWaves;
    waves.push_back(sheet_wave(method, pairs, k, approaching));
    if (method.integrator == Integrator::modified_leap_frog) find_rates(waves.back());
  });
  return waves;
}

template std::vector<SheetWave> sheet_waves(const MethodN<2>&, double);
template std::vector<SheetWave> sheet_waves(const MethodN<3>&, double);

}  // namespace sluice

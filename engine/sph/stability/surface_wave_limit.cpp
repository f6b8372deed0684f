#include "engine/sph/stability/surface_wave_limit.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "engine/sph/kernel/kernel.hpp"

namespace sluice {
namespace {

using Eigen::MatrixXcd;

/// Two more than the reach of the kernels at their usual smoothing lengths: the two surfaces do not
/// see one another.
constexpr int kRows = 6;
constexpr int kWaves = 12;

/// What a pair of rows adds, for one distance along the sheet.
struct RowPair {
  Eigen::Index i, j;
  VecN<2> distance;            ///< X_ij
  double weight;               ///< V_j slope
  std::complex<double> phase;  ///< value of the wave at j over that at i
};

void add(const RowPair& pair, const Method& m, double approaching, SheetWave& w) {
  const Eigen::Index i = pair.i;
  const Eigen::Index j = pair.j;
  const double alpha = m.viscosity ? m.viscosity->alpha : 0.0;
  const double epsilon = m.viscosity ? m.viscosity->epsilon : 0.0;
  const double delta = m.diffusion ? m.diffusion->delta : 0.0;
  const double drag = approaching * alpha * pair.weight / (pair.distance.squaredNorm() + epsilon);
  const double shear = scaled_two_nu(m.laminar_viscosity, m) * pair.weight;
  for (Eigen::Index a = 0; a < 2; ++a) {
    w.damping(2 * i + a, 2 * i + a) += shear;
    w.damping(2 * i + a, 2 * j + a) -= shear * pair.phase;
    const double slope = pair.weight * pair.distance(a);
    w.divergence(i, 2 * i + a) -= slope;
    w.divergence(i, 2 * j + a) += slope * pair.phase;
    w.pressure(2 * i + a, i) += slope;
    w.pressure(2 * i + a, j) += slope * pair.phase;
    for (Eigen::Index b = 0; b < 2; ++b) {
      const double tensor = drag * pair.distance(a) * pair.distance(b);
      w.damping(2 * i + a, 2 * i + b) += tensor;
      w.damping(2 * i + a, 2 * j + b) -= tensor * pair.phase;
    }
  }
  w.diffusion(i, i) += 2.0 * delta * pair.weight;
  w.diffusion(i, j) -= 2.0 * delta * pair.weight * pair.phase;
}

SheetWave sheet_wave(const Method& m, double k, double approaching) {
  SheetWave w{MatrixXcd::Zero(kRows, 2 * kRows),
              MatrixXcd::Zero(2 * kRows, kRows),
              MatrixXcd::Zero(2 * kRows, 2 * kRows),
              MatrixXcd::Zero(kRows, kRows),
              {}};
  const double spacing = m.spacing / m.smoothing_length;
  const double support = m.support_ratio();
  const int reach = static_cast<int>(support / spacing) + 1;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kRows; ++j) {
      for (int n = -reach; n <= reach; ++n) {
        const VecN<2> distance = spacing * VecN<2>(n, i - j);
        const double r_sq = distance.squaredNorm();
        if (r_sq == 0.0 || r_sq >= support * support) continue;
        add({i, j, distance, spacing * spacing * kernel_slope<2>(m.kernel, r_sq),
             std::polar(1.0, -k * distance.x())},
            m, approaching, w);
      }
    }
  }
  return w;
}

void find_rates(SheetWave& w) {
  MatrixXcd all(3 * kRows, 3 * kRows);
  all << -w.damping, w.pressure, w.divergence, -w.diffusion;
  const Eigen::ComplexEigenSolver<MatrixXcd> solver(all, /*computeEigenvectors=*/false);
  w.rates.assign(solver.eigenvalues().begin(), solver.eigenvalues().end());
}

}  // namespace

double SheetWave::kick_drift_kick_radius(double courant) const {
  MatrixXcd density(kRows, 3 * kRows);
  density << courant * divergence, MatrixXcd::Identity(kRows, kRows) - courant * diffusion;
  MatrixXcd step = MatrixXcd::Zero(3 * kRows, 3 * kRows);
  step.topLeftCorner(2 * kRows, 2 * kRows) =
      MatrixXcd::Identity(2 * kRows, 2 * kRows) - courant * damping;
  step.topRows(2 * kRows) += courant * pressure * density;
  step.bottomRows(kRows) = density;
  const Eigen::ComplexEigenSolver<MatrixXcd> solver(step, /*computeEigenvectors=*/false);
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

std::vector<SheetWave> sheet_waves(const Method& method, double approaching) {
  std::vector<SheetWave> waves;
  const double shortest = std::numbers::pi * method.smoothing_length / method.spacing;
  for (int n = 0; n <= kWaves; ++n) {
    waves.push_back(sheet_wave(method, n * shortest / kWaves, approaching));
    if (method.integrator == Integrator::modified_leap_frog) find_rates(waves.back());
  }
  return waves;
}

}  // namespace sluice

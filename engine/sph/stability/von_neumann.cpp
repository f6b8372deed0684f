#include "engine/sph/stability/von_neumann.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "engine/space/lattice.hpp"
#include "engine/space/space_traits.hpp"
#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/stability/brillouin_zone.hpp"
#include "engine/sph/stability/eigenvalues.hpp"

namespace sluice {
namespace {

/// Waves along an edge of the part of the Brillouin zone that symmetry leaves over.
constexpr int kWaves = 16;
constexpr double kLeastCourant = 0.01;
constexpr double kAccuracy = 1e-4;
/// Share of the pairs of a wave that eq. 8 acts between.
constexpr double kApproaching = 0.5;

/// Of velocity and density together.
template <int Dim>
using StateMatrix = Eigen::Matrix<double, Dim + 1, Dim + 1>;

template <int Dim>
StateMatrix<Dim> rate_matrix(const LatticeWaveN<Dim>& w) {
  StateMatrix<Dim> rates;
  rates << -w.damping, w.gradient, -w.gradient.transpose(), -w.diffusion;
  return rates;
}

/// eqs. 13-17: y_half += dt f(y), y = y_half + dt/2 f(y). For an eigenvalue lambda of the rates, mu
/// = C lambda: z^2 - (1 + 3/2 mu) z + mu/2 = 0.
double leap_frog_radius(std::span<const std::complex<double>> rates, double courant) {
  double most = 0.0;
  for (const std::complex<double>& rate : rates) {
    const std::complex<double> mu = courant * rate;
    const std::complex<double> b = 1.0 + 1.5 * mu;
    const std::complex<double> root = std::sqrt(b * b - 2.0 * mu);
    most = std::max({most, std::abs(0.5 * (b + root)), std::abs(0.5 * (b - root))});
  }
  return most;
}

/// From one half step to the next, U is the velocity of the half step: sigma += dt dsigma(U,
/// sigma), then U += dt dU(U, sigma).
template <int Dim>
double kick_drift_kick_radius(const LatticeWaveN<Dim>& w, double courant) {
  Eigen::Matrix<double, 1, Dim + 1> density;
  density << -courant * w.gradient.transpose(), 1.0 - courant * w.diffusion;
  StateMatrix<Dim> step = StateMatrix<Dim>::Zero();
  step.template topLeftCorner<Dim, Dim>() =
      LatticeWaveN<Dim>::Tensor::Identity() - courant * w.damping;
  step.template topRows<Dim>() += courant * w.gradient * density;
  step.row(Dim) = density;
  return spectral_radius(WaveMatrix(step));
}

/// What only decays, at `rate` c/h, is stable up to dt = 2/rate in a forward Euler step, which is
/// what a kick or a drift is, and to 1/rate with Adams-Bashforth 2.
double decay_limit(Integrator integrator, double rate) {
  const double real_axis = integrator == Integrator::modified_leap_frog ? 1.0 : 2.0;
  return std::min(real_axis / rate, LatticeStability::kMostCourant);
}

}  // namespace

template <int Dim>
LatticeStabilityN<Dim>::LatticeStabilityN(const MethodN<Dim>& method, Surface surface)
    : integrator_(method.integrator), spacing_(method.spacing / method.smoothing_length) {
  if (method.viscosity) {
    alpha_ = method.viscosity->alpha;
    epsilon_ = method.viscosity->epsilon;
  }
  if (method.diffusion) delta_ = method.diffusion->delta;
  two_nu_ = scaled_two_nu(method.laminar_viscosity, method);

  const double support = method.support_ratio();
  const auto reach = static_cast<std::int64_t>(support / spacing_) + 1;
  for_each_cell_x_slowest<Dim>(
      shifted<Dim>({}, -reach), shifted<Dim>({}, reach), [&](const CellN<Dim>& cell) {
        const VecN<Dim> distance = spacing_ * as_vector<Dim>(cell);
        if (cell == CellN<Dim>{} || distance.norm() >= support) return;
        neighbours_.push_back(
            {distance, cell_measure<Dim>(spacing_) *
                           kernel_slope<Dim>(method.kernel, distance.squaredNorm())});
      });
  const double step = std::numbers::pi / spacing_ / kWaves;
  for_each_wave<Dim>(kWaves, [&](const CellN<Dim>& cell) {
    if (cell != CellN<Dim>{}) waves_.push_back(wave(step * as_vector<Dim>(cell)));
  });
  if (surface == Surface::free) sheets_ = sheet_waves(method, kApproaching);
}

template <int Dim>
LatticeWaveN<Dim> LatticeStabilityN<Dim>::wave(const VecN<Dim>& k) const {
  LatticeWave w;
  w.wave_vector = k;
  for (const Neighbour& n : neighbours_) {
    const double phase = k.dot(n.distance);
    const double difference = n.weight * (1.0 - std::cos(phase));
    w.gradient += n.weight * std::sin(phase) * n.distance;
    w.diffusion += 2.0 * delta_ * difference;
    w.damping += kApproaching * alpha_ * difference / (n.distance.squaredNorm() + epsilon_) *
                 n.distance * n.distance.transpose();
    w.damping += two_nu_ * difference * LatticeWave::Tensor::Identity();
  }
  if (integrator_ == Integrator::modified_leap_frog) {
    w.rates = eigenvalues(WaveMatrix(rate_matrix(w)));
  }
  return w;
}

template <int Dim>
double LatticeStabilityN<Dim>::radius(const LatticeWave& wave, double courant) const {
  return integrator_ == Integrator::modified_leap_frog ? leap_frog_radius(wave.rates, courant)
                                                       : kick_drift_kick_radius(wave, courant);
}

template <int Dim>
double LatticeStabilityN<Dim>::radius(const SheetWave& wave, double courant) const {
  return integrator_ == Integrator::modified_leap_frog ? leap_frog_radius(wave.rates, courant)
                                                       : wave.kick_drift_kick_radius(courant);
}

template <int Dim>
double LatticeStabilityN<Dim>::spectral_radius(double courant) const {
  double most = 0.0;
  for (const LatticeWave& w : waves_) most = std::max(most, radius(w, courant));
  for (const SheetWave& w : sheets_) most = std::max(most, radius(w, courant));
  return most;
}

template <int Dim>
template <class Wave>
bool LatticeStabilityN<Dim>::lower(const Wave& wave, double& limit) const {
  const auto grows = [&](double courant) { return radius(wave, courant) > 1.0 + kTolerance; };
  if (!grows(limit)) return false;
  double stable = 0.0;
  while (limit - stable > 0.1 * kAccuracy * limit && limit > kLeastCourant) {
    const double middle = 0.5 * (stable + limit);
    (grows(middle) ? limit : stable) = middle;
  }
  return true;
}

template <int Dim>
double LatticeStabilityN<Dim>::courant_limit() const {
  double limit = kMostCourant;
  VecN<Dim> worst = VecN<Dim>::Zero();
  for (const LatticeWave& w : waves_) {
    if (lower(w, limit)) worst = w.wave_vector;
  }
  // The worst wave lies between those looked at: search around it, closer each time.
  for (double step = std::numbers::pi / spacing_ / kWaves / 2; step > 1e-3; step /= 2) {
    const VecN<Dim> center = worst;
    for_each_cell_x_slowest<Dim>(shifted<Dim>({}, -1), shifted<Dim>({}, 1),
                                 [&](const CellN<Dim>& cell) {
                                   const LatticeWave w = wave(center + step * as_vector<Dim>(cell));
                                   if (lower(w, limit)) worst = w.wave_vector;
                                 });
  }
  for (const SheetWave& w : sheets_) lower(w, limit);
  return limit > kLeastCourant ? limit : 0.0;
}

template <int Dim>
double LatticeStabilityN<Dim>::viscosity_limit() const {
  double fastest = 0.0;
  for (const LatticeWave& w : waves_) {
    fastest = std::max(fastest, largest_eigenvalue(WaveMatrix(w.damping)));
  }
  return decay_limit(integrator_, fastest);
}

template <int Dim>
double LatticeStabilityN<Dim>::diffusion_limit() const {
  double fastest = 0.0;
  for (const LatticeWave& w : waves_) fastest = std::max(fastest, w.diffusion);
  return decay_limit(integrator_, fastest);
}

template <int Dim>
CourantLimits courant_limits(const MethodN<Dim>& method, Surface surface) {
  const LatticeStabilityN<Dim> all(method, surface);
  MethodN<Dim> bare = method;
  bare.viscosity.reset();
  bare.laminar_viscosity.reset();
  bare.diffusion.reset();
  return {.scheme = all.courant_limit(),
          .sound = LatticeStabilityN<Dim>(bare, surface).courant_limit(),
          .viscosity = all.viscosity_limit(),
          .diffusion = all.diffusion_limit()};
}

template class LatticeStabilityN<2>;
template class LatticeStabilityN<3>;
template CourantLimits courant_limits(const MethodN<2>&, Surface);
template CourantLimits courant_limits(const MethodN<3>&, Surface);

}  // namespace sluice

#include "engine/sph/stability/von_neumann.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "engine/sph/kernel/kernel.hpp"

namespace sluice {
namespace {

/// Waves along an edge of the part of the Brillouin zone that symmetry leaves over.
constexpr int kWaves = 16;
constexpr double kLeastCourant = 0.01;
constexpr double kAccuracy = 1e-4;
/// Share of the pairs of a wave that eq. 8 acts between.
constexpr double kApproaching = 0.5;

Eigen::Matrix3d rate_matrix(const LatticeWave& w) {
  Eigen::Matrix3d rates;
  rates << -w.damping, w.gradient, -w.gradient.transpose(), -w.diffusion;
  return rates;
}

double largest_modulus(const Eigen::Matrix3d& matrix) {
  const Eigen::EigenSolver<Eigen::Matrix3d> solver(matrix, /*computeEigenvectors=*/false);
  return solver.eigenvalues().cwiseAbs().maxCoeff();
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
double kick_drift_kick_radius(const LatticeWave& w, double courant) {
  const Eigen::RowVector3d density(-courant * w.gradient.x(), -courant * w.gradient.y(),
                                   1.0 - courant * w.diffusion);
  Eigen::Matrix3d step;
  step.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() - courant * w.damping;
  step.topRightCorner<2, 1>().setZero();
  step.topRows<2>() += courant * w.gradient * density;
  step.row(2) = density;
  return largest_modulus(step);
}

/// What only decays, at `rate` c/h, is stable up to dt = 2/rate in a forward Euler step, which is
/// what a kick or a drift is, and to 1/rate with Adams-Bashforth 2.
double decay_limit(Integrator integrator, double rate) {
  const double real_axis = integrator == Integrator::modified_leap_frog ? 1.0 : 2.0;
  return std::min(real_axis / rate, LatticeStability::kMostCourant);
}

}  // namespace

LatticeStability::LatticeStability(const Method& method, Surface surface)
    : integrator_(method.integrator), spacing_(method.spacing / method.smoothing_length) {
  if (method.viscosity) {
    alpha_ = method.viscosity->alpha;
    epsilon_ = method.viscosity->epsilon;
  }
  if (method.diffusion) delta_ = method.diffusion->delta;
  two_nu_ = scaled_two_nu(method.laminar_viscosity, method);

  const double support = method.support_ratio();
  const int reach = static_cast<int>(support / spacing_) + 1;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const VecN<2> distance = spacing_ * VecN<2>(i, j);
      if ((i == 0 && j == 0) || distance.norm() >= support) continue;
      neighbours_.push_back(
          {distance, spacing_ * spacing_ * kernel_slope<2>(method.kernel, distance.squaredNorm())});
    }
  }
  const double step = std::numbers::pi / spacing_ / kWaves;
  for (int i = 1; i <= kWaves; ++i) {
    for (int j = 0; j <= i; ++j) waves_.push_back(wave(step * VecN<2>(i, j)));
  }
  if (surface == Surface::free) sheets_ = sheet_waves(method, kApproaching);
}

LatticeWave LatticeStability::wave(const VecN<2>& k) const {
  LatticeWave w;
  w.wave_vector = k;
  for (const Neighbour& n : neighbours_) {
    const double phase = k.dot(n.distance);
    const double difference = n.weight * (1.0 - std::cos(phase));
    w.gradient += n.weight * std::sin(phase) * n.distance;
    w.diffusion += 2.0 * delta_ * difference;
    w.damping += kApproaching * alpha_ * difference / (n.distance.squaredNorm() + epsilon_) *
                 n.distance * n.distance.transpose();
    w.damping += two_nu_ * difference * Eigen::Matrix2d::Identity();
  }
  if (integrator_ == Integrator::modified_leap_frog) {
    const Eigen::EigenSolver<Eigen::Matrix3d> solver(rate_matrix(w), /*computeEigenvectors=*/false);
    std::copy_n(solver.eigenvalues().data(), 3, w.rates.begin());
  }
  return w;
}

double LatticeStability::radius(const LatticeWave& wave, double courant) const {
  return integrator_ == Integrator::modified_leap_frog ? leap_frog_radius(wave.rates, courant)
                                                       : kick_drift_kick_radius(wave, courant);
}

double LatticeStability::radius(const SheetWave& wave, double courant) const {
  return integrator_ == Integrator::modified_leap_frog ? leap_frog_radius(wave.rates, courant)
                                                       : wave.kick_drift_kick_radius(courant);
}

double LatticeStability::spectral_radius(double courant) const {
  double most = 0.0;
  for (const LatticeWave& w : waves_) most = std::max(most, radius(w, courant));
  for (const SheetWave& w : sheets_) most = std::max(most, radius(w, courant));
  return most;
}

template <class Wave>
bool LatticeStability::lower(const Wave& wave, double& limit) const {
  const auto grows = [&](double courant) { return radius(wave, courant) > 1.0 + kTolerance; };
  if (!grows(limit)) return false;
  double stable = 0.0;
  while (limit - stable > 0.1 * kAccuracy * limit && limit > kLeastCourant) {
    const double middle = 0.5 * (stable + limit);
    (grows(middle) ? limit : stable) = middle;
  }
  return true;
}

double LatticeStability::courant_limit() const {
  double limit = kMostCourant;
  VecN<2> worst = VecN<2>::Zero();
  for (const LatticeWave& w : waves_) {
    if (lower(w, limit)) worst = w.wave_vector;
  }
  // The worst wave lies between those looked at: search around it, closer each time.
  for (double step = std::numbers::pi / spacing_ / kWaves / 2; step > 1e-3; step /= 2) {
    const VecN<2> center = worst;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const LatticeWave w = wave(center + step * VecN<2>(i, j));
        if (lower(w, limit)) worst = w.wave_vector;
      }
    }
  }
  for (const SheetWave& w : sheets_) lower(w, limit);
  return limit > kLeastCourant ? limit : 0.0;
}

double LatticeStability::viscosity_limit() const {
  double fastest = 0.0;
  for (const LatticeWave& w : waves_) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(w.damping, Eigen::EigenvaluesOnly);
    fastest = std::max(fastest, solver.eigenvalues().maxCoeff());
  }
  return decay_limit(integrator_, fastest);
}

double LatticeStability::diffusion_limit() const {
  double fastest = 0.0;
  for (const LatticeWave& w : waves_) fastest = std::max(fastest, w.diffusion);
  return decay_limit(integrator_, fastest);
}

CourantLimits courant_limits(const Method& method, Surface surface) {
  const LatticeStability all(method, surface);
  Method bare = method;
  bare.viscosity.reset();
  bare.laminar_viscosity.reset();
  bare.diffusion.reset();
  return {.scheme = all.courant_limit(),
          .sound = LatticeStability(bare, surface).courant_limit(),
          .viscosity = all.viscosity_limit(),
          .diffusion = all.diffusion_limit()};
}

}  // namespace sluice

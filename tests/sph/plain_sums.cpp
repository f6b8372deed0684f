#include "tests/sph/plain_sums.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sluice {
namespace {

constexpr double kPi = std::numbers::pi;

double wall_density(const MethodN<2>& m, double pressure) {
  return m.reference_density + pressure / (m.sound_speed * m.sound_speed);  // eq. 3
}

/// eq. 8 for one pair, with its quadratic part.
double viscous_pressure(const ArtificialViscosity& term, const MethodN<2>& m, double rho_i,
                        double rho_j, const Vec2& v_ij, const Vec2& x_ij) {
  const double h = m.smoothing_length;
  const double rho_mean = 0.5 * (rho_i + rho_j);
  const double mu = h * v_ij.dot(x_ij) / (x_ij.squaredNorm() + term.epsilon * h * h);
  return mu < 0.0 ? (-term.alpha * m.sound_speed * mu + term.beta * mu * mu) / rho_mean : 0.0;
}

/// What is diffused between i and j (eq. 7): the density difference, less its hydrostatic part
/// rho_0 f . x_ji / c^2 with Fourtakas' term.
double diffused_difference(const MethodN<2>& m, double rho_i, double rho_j, const Vec2& x_ij) {
  if (m.diffusion->kind == DiffusionKind::molteni_colagrossi) return rho_j - rho_i;
  const double c_sq = m.sound_speed * m.sound_speed;
  return rho_j - rho_i + m.reference_density * m.gravity.dot(x_ij) / c_sq;
}

/// The nu with which the viscous stress between a lattice of fluid that slides at `speed` and the
/// lattice of the wall below is Cf/2 rho_0 speed^2: each row of fluid against each of the wall.
double wall_law_nu(const MethodN<2>& m, double speed) {
  const double dx = m.spacing;
  double sum = 0.0;
  for (int row = 0; row < 6; ++row) {
    for (int wall_row = 1; wall_row <= 6; ++wall_row) {
      for (int along = -6; along <= 6; ++along) {
        sum += smoothing_slope(m, dx * std::hypot(row + wall_row, along));
      }
    }
  }
  return m.wall_shear->coefficient * speed / (4.0 * dx * dx * dx * sum);
}

}  // namespace

double smoothing(const MethodN<2>& m, double r) {
  const double h = m.smoothing_length;
  const double R = r / h;
  if (m.kernel == KernelKind::truncated_gaussian) {
    return R < 3.0 ? std::exp(-R * R) / (kPi * h * h) : 0.0;
  }
  return R < 2.0 ? 7.0 / (4.0 * kPi * h * h) * std::pow(1.0 - R / 2.0, 4) * (2.0 * R + 1.0) : 0.0;
}

double smoothing_slope(const MethodN<2>& m, double r) {
  const double h = m.smoothing_length;
  const double R = r / h;
  if (m.kernel == KernelKind::truncated_gaussian) return 2.0 / (h * h) * smoothing(m, r);
  // d/dR (1 - R/2)^4 (2R + 1) = -5 R (1 - R/2)^3
  return R < 2.0 ? 35.0 / (4.0 * kPi * std::pow(h, 4)) * std::pow(1.0 - R / 2.0, 3) : 0.0;
}

std::vector<double> plain_wall_pressures(const MethodN<2>& m, const Fluid& fluid,
                                         const std::vector<Vec2>& walls) {
  const double c_sq = m.sound_speed * m.sound_speed;
  std::vector<double> pressures;
  for (const Vec2& wall : walls) {
    double numerator = 0.0;
    double weight = 0.0;
    for (std::size_t f = 0; f < fluid.size(); ++f) {
      const double w = smoothing(m, (wall - fluid.x[f]).norm());
      const double rho = m.reference_density + fluid.excess[f];
      numerator += (c_sq * fluid.excess[f] + rho * m.gravity.dot(wall - fluid.x[f])) * w;
      weight += w;
    }
    double p = weight > 0.0 ? numerator / weight : 0.0;
    if (m.wall_pressure == WallPressure::clamped) p = std::max(p, 0.0);
    pressures.push_back(p);
  }
  return pressures;
}

PlainRates plain_rates(const MethodN<2>& m, const Fluid& fluid, const std::vector<Vec2>& walls,
                       const std::vector<double>& wall_pressure) {
  const double mass = m.reference_density * m.spacing * m.spacing;
  const double c = m.sound_speed;
  const double h = m.smoothing_length;
  PlainRates out;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    const double rho_i = m.reference_density + fluid.excess[i];
    const double p_i = c * c * fluid.excess[i];
    Vec2 a = m.gravity;
    double a_size = m.gravity.norm();
    double d_rho = 0.0;
    double d_rho_size = 0.0;
    // mu_i = mu_j = rho_0 nu, and the volumes of the viscous stress are those at rho_0.
    const double rest_volume = m.spacing * m.spacing;
    const auto add = [&](const Vec2& x_j, const Vec2& v_j, double rho_j, double p_j, double pi_ij,
                         bool diffuses, double nu) {
      const Vec2 x_ij = fluid.x[i] - x_j;
      const Vec2 grad_W = -smoothing_slope(m, x_ij.norm()) * x_ij;
      const double volume_j = mass / rho_j;
      const Vec2 force = -mass * (p_i / (rho_i * rho_i) + p_j / (rho_j * rho_j) + pi_ij) * grad_W;
      double rate = rho_i * volume_j * (fluid.v[i] - v_j).dot(grad_W);
      d_rho_size += std::abs(rate);
      if (m.diffusion && diffuses) {
        // x_ji . grad W / |x_ij|^2 = slope, also where x_ij = 0.
        const double diffusion = 2.0 * m.diffusion->delta * h * c *
                                 diffused_difference(m, rho_i, rho_j, x_ij) *
                                 smoothing_slope(m, x_ij.norm()) * volume_j;
        rate += diffusion;
        d_rho_size += std::abs(diffusion);
      }
      a += force;
      a_size += force.norm();
      // x_ij . grad W / |x_ij|^2 = -slope, also where x_ij = 0.
      const Vec2 drag =
          -2.0 * nu * rest_volume * smoothing_slope(m, x_ij.norm()) * (fluid.v[i] - v_j);
      a += drag;
      a_size += drag.norm();
      d_rho += rate;
    };
    const double nu = m.laminar_viscosity ? m.laminar_viscosity->nu : 0.0;
    const double wall_nu = m.wall_shear ? wall_law_nu(m, fluid.v[i].norm()) : nu;
    for (std::size_t j = 0; j < fluid.size(); ++j) {
      if (j == i) continue;
      const double rho_j = m.reference_density + fluid.excess[j];
      const double pi_ij = m.viscosity
                               ? viscous_pressure(*m.viscosity, m, rho_i, rho_j,
                                                  fluid.v[i] - fluid.v[j], fluid.x[i] - fluid.x[j])
                               : 0.0;
      add(fluid.x[j], fluid.v[j], rho_j, c * c * fluid.excess[j], pi_ij, true, nu);
    }
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const double rho_w = wall_density(m, wall_pressure[w]);
      const double pi_iw =
          m.wall_artificial_viscosity
              ? viscous_pressure(
                    {m.wall_artificial_viscosity->alpha, m.wall_artificial_viscosity->epsilon}, m,
                    rho_i, rho_w, fluid.v[i], fluid.x[i] - walls[w])
              : 0.0;
      const bool diffuses = m.diffusion && m.diffusion->kind == DiffusionKind::molteni_colagrossi;
      add(walls[w], Vec2::Zero(), rho_w, wall_pressure[w], pi_iw, diffuses, wall_nu);
    }
    out.acceleration.push_back(a);
    out.density.push_back(d_rho);
    out.acceleration_size = std::max(out.acceleration_size, a_size);
    out.density_size = std::max(out.density_size, d_rho_size);
  }
  return out;
}

std::vector<double> plain_reinitialisation(const MethodN<2>& m, const Fluid& fluid,
                                           const std::vector<Vec2>& walls,
                                           const std::vector<double>& wall_pressure) {
  const double mass = m.reference_density * m.spacing * m.spacing;
  std::vector<double> fresh;
  for (std::size_t i = 0; i < fluid.size(); ++i) {
    double masses = 0.0;
    double volumes = 0.0;
    const auto add = [&](const Vec2& x_j, double rho_j) {
      const double w = smoothing(m, (fluid.x[i] - x_j).norm());
      masses += mass * w;
      volumes += mass / rho_j * w;
    };
    for (std::size_t j = 0; j < fluid.size(); ++j) {
      add(fluid.x[j], m.reference_density + fluid.excess[j]);
    }
    for (std::size_t w = 0; w < walls.size(); ++w) add(walls[w], wall_density(m, wall_pressure[w]));
    fresh.push_back(masses / volumes - m.reference_density);
  }
  return fresh;
}

}  // namespace sluice

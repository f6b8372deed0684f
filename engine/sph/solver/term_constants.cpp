#include "engine/sph/solver/term_constants.hpp"

#include "engine/sph/method/kernel.hpp"

namespace sluice {
namespace {

/// The density of a wall follows from eq. 9 and is not kept: an exchange with it is a source, which
/// lifts still water for ever. Only where the hydrostatic part is diffused as well must the walls
/// hold against it.
bool diffuses_with_walls(const DensityDiffusion& term) {
  return term.kind == DiffusionKind::molteni_colagrossi;
}

/// The stress that a viscous stress puts on fluid sliding along a wall, over 2 rho_0 nu |v|/h, on a
/// lattice that goes on in the wall: (dx/h)^3 sum n slope(R^2), for in n rows of fluid there is a
/// row of the wall n dx below.
double stress_across_wall(const Method& m) {
  const double dx = m.spacing / m.smoothing_length;
  const int reach = static_cast<int>(m.support_ratio() / dx) + 1;
  double sum = 0.0;
  for (int n = 1; n <= reach; ++n) {
    for (int along = -reach; along <= reach; ++along) {
      const double r_sq = dx * dx * static_cast<double>(n * n + along * along);
      if (r_sq < m.support_ratio() * m.support_ratio()) sum += n * kernel_slope(m.kernel, r_sq);
    }
  }
  return dx * dx * dx * sum;
}

}  // namespace

bool keeps_diffused(const Method& method) {
  return method.diffusion && method.diffusion->kind == DiffusionKind::fourtakas;
}

double scale_of_sums(const Method& m) {
  const double ratio = m.spacing / m.smoothing_length;
  return ratio * ratio * kernel_slope_scale(m.kernel);
}

template <typename T>
TermConstants<T> term_constants(const Method& m, double origin_cell_size) {
  TermConstants<T> k;
  k.origin_cell_size = static_cast<T>(origin_cell_size / m.smoothing_length);
  if (m.diffusion) {
    k.two_delta = static_cast<T>(2.0 * m.diffusion->delta);
    k.two_delta_wall = diffuses_with_walls(*m.diffusion) ? k.two_delta : T{0};
  }
  if (m.viscosity) {
    k.viscosity_alpha = static_cast<T>(m.viscosity->alpha);
    k.viscosity_epsilon = static_cast<T>(m.viscosity->epsilon);
    k.viscosity_beta = static_cast<T>(m.viscosity->beta);
  }
  if (m.wall_artificial_viscosity) {
    k.friction_alpha = static_cast<T>(m.wall_artificial_viscosity->alpha);
    k.friction_epsilon = static_cast<T>(m.wall_artificial_viscosity->epsilon);
  }
  k.two_nu = static_cast<T>(m.scaled_two_nu());
  if (m.wall_shear) {
    k.wall_two_nu_by_speed =
        static_cast<T>(m.wall_shear->coefficient / (2.0 * stress_across_wall(m)));
  }
  const Vec gravity = m.gravity * m.smoothing_length / (m.sound_speed * m.sound_speed);
  k.gravity_x = static_cast<T>(gravity.x());
  k.gravity_y = static_cast<T>(gravity.y());
  return k;
}

template TermConstants<float> term_constants<float>(const Method&, double);
template TermConstants<double> term_constants<double>(const Method&, double);

}  // namespace sluice

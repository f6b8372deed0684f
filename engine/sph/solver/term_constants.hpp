#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "engine/space/space_traits.hpp"
#include "engine/sph/kernel/kernel.hpp"
#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/method/method.hpp"

namespace sluice {

/// Whether what is diffused is a field of its own: Molteni and Colagrossi diffuse the excess
/// itself.
template <int Dim>
[[nodiscard]] bool keeps_diffused(const MethodN<Dim>& method) {
  return method.diffusion && method.diffusion->keeps_field();
}

/// What the sums over pairs leave out: the volume of a particle in h^d times the constant of grad
/// W.
template <int Dim>
[[nodiscard]] double scale_of_sums(const MethodN<Dim>& m) {
  return cell_measure<Dim>(m.spacing / m.smoothing_length) * kernel_slope_scale<Dim>(m.kernel);
}

/// The constants of the terms that a method has. `origin_cell_size` in m.
template <typename T, int Dim>
[[nodiscard]] TermConstants<T, Dim> term_constants(const MethodN<Dim>& m, double origin_cell_size) {
  TermConstants<T, Dim> k;
  for_each_term(RateTerms{}, [&]<class Term>() {
    using Constants = typename Term::template Constants<T>;
    const auto& term = m.template term<Term>();
    if (!term) return;
    std::get<Constants>(k.in_fluid) = term->template constants<T>(m, Neighbours::fluid);
    std::get<Constants>(k.at_walls) = term->template constants<T>(m, Neighbours::walls);
  });
  const VecN<Dim> gravity = m.gravity * m.smoothing_length / (m.sound_speed * m.sound_speed);
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    k.gravity[axis] = static_cast<T>(gravity[static_cast<Eigen::Index>(axis)]);
  }
  k.origin_shift = OriginShift<T, Dim>(static_cast<T>(origin_cell_size / m.smoothing_length));
  return k;
}

}  // namespace sluice

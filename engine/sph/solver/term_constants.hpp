#pragma once

#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/method/method.hpp"

namespace sluice {

/// Whether what is diffused is a field of its own: Molteni and Colagrossi diffuse the excess
/// itself.
[[nodiscard]] bool keeps_diffused(const Method& method);

/// What the sums over pairs leave out: the volume of a particle in h^2 times the constant of grad
/// W.
[[nodiscard]] double scale_of_sums(const Method& method);

/// The constants of the terms that a method has. `origin_cell_size` in m.
template <typename T>
[[nodiscard]] TermConstants<T> term_constants(const Method& method, double origin_cell_size);
extern template TermConstants<float> term_constants<float>(const Method&, double);
extern template TermConstants<double> term_constants<double>(const Method&, double);

}  // namespace sluice

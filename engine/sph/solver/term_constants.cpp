#include "engine/sph/solver/term_constants.hpp"

#include "engine/sph/kernel/kernel.hpp"

namespace sluice {

bool keeps_diffused(const Method& method) {
  return method.diffusion && method.diffusion->keeps_field();
}

double scale_of_sums(const Method& m) {
  const double ratio = m.spacing / m.smoothing_length;
  return ratio * ratio * kernel_slope_scale(m.kernel);
}

template <typename T>
TermConstants<T> term_constants(const Method& m, double origin_cell_size) {
  TermConstants<T> k;
  for_each_term(RateTerms{}, [&]<class Term>() {
    using Constants = typename Term::template Constants<T>;
    const auto& term = m.term<Term>();
    if (!term) return;
    std::get<Constants>(k.in_fluid) = term->template constants<T>(m, Neighbours::fluid);
    std::get<Constants>(k.at_walls) = term->template constants<T>(m, Neighbours::walls);
  });
  const Vec gravity = m.gravity * m.smoothing_length / (m.sound_speed * m.sound_speed);
  k.gravity_x = static_cast<T>(gravity.x());
  k.gravity_y = static_cast<T>(gravity.y());
  k.origin_cell_size = static_cast<T>(origin_cell_size / m.smoothing_length);
  return k;
}

template TermConstants<float> term_constants<float>(const Method&, double);
template TermConstants<double> term_constants<double>(const Method&, double);

}  // namespace sluice

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/space/vec.hpp"
#include "engine/sph/loops/sweeps.hpp"
#include "engine/sph/method/flow_domain.hpp"
#include "engine/sph/method/method.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/pairs/pair_arrays.hpp"
#include "engine/sph/solver/neighbours.hpp"
#include "engine/sph/threads/thread_team.hpp"

namespace sluice {

/// The dummy particles of the walls (Adami et al. 2012): at rest, in an order of their own, their
/// pressures summed from the fluid at every use.
template <typename T>
class DummyParticles {
 public:
  /// `places` in m.
  DummyParticles(ThreadTeam& team, const Grid& grid, const Method& method,
                 const std::optional<GateMotion>& gate, const std::vector<Vec>& places);

  [[nodiscard]] bool empty() const { return layout_.slots() == 0; }
  [[nodiscard]] PairView<T> view() const { return arrays_.view(); }
  [[nodiscard]] PairSet<T> set() const {
    return {
        layout_, bounds_, {arrays_.x.data(), arrays_.y.data(), arrays_.u.data(), arrays_.v.data()}};
  }

  /// eq. 9 over `list`, of this set and the fluid, and from it the density, volume and stress of
  /// every particle (eq. 3).
  void sum_pressures(ThreadTeam& team, const Method& method, const Sweeps<T>& sweeps,
                     const TermConstants<T>& constants, const PairView<T>& fluid,
                     const PairList& list);

  /// Takes out what the lower edge of the lifted wall has passed at `time`, s: out of the kernel's
  /// reach, without pressure.
  void lift(const std::optional<GateMotion>& gate, double time);

  /// Pa, in the order of `places`, as they were summed last.
  [[nodiscard]] std::vector<double> pressures(const Method& method) const;
  [[nodiscard]] std::size_t bytes() const { return arrays_.bytes() + excess_.bytes(); }

 private:
  struct GateParticle {
    Vec place;
    std::size_t slot;
  };

  std::size_t count_;
  Layout layout_;
  std::vector<std::uint32_t> source_;  // of the layout
  ClusterBounds bounds_;
  PairArrays<T> arrays_;
  AlignedArray<T> excess_;            // sums of eq. 9
  std::vector<GateParticle> lifted_;  // those of the lifted wall that still stand
};

extern template class DummyParticles<float>;
extern template class DummyParticles<double>;

}  // namespace sluice

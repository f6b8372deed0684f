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
template <typename T, int Dim>
class DummyParticles {
 public:
  /// `places` in m.
  DummyParticles(ThreadTeam& team, const Grid<Dim>& grid, const MethodN<Dim>& method,
                 const std::optional<GateMotionN<Dim>>& gate, const std::vector<VecN<Dim>>& places);

  [[nodiscard]] bool empty() const { return layout_.slots() == 0; }
  [[nodiscard]] PairView<T, Dim> view() const { return arrays_.view(); }
  [[nodiscard]] PairSet<T, Dim> set() const { return {layout_, bounds_, paths_.view()}; }

  /// eq. 9 over `list`, of this set and the fluid, and from it the density, volume and stress of
  /// every particle (eq. 3).
  void sum_pressures(ThreadTeam& team, const MethodN<Dim>& method, const Sweeps<T, Dim>& sweeps,
                     const TermConstants<T, Dim>& constants, const PairView<T, Dim>& fluid,
                     const PairList& list);

  /// Takes out what the lower edge of the lifted wall has passed at `time`, s: out of the kernel's
  /// reach, without pressure.
  void lift(const std::optional<GateMotionN<Dim>>& gate, double time);

  /// Pa, in the order of `places`, as they were summed last.
  [[nodiscard]] std::vector<double> pressures(const MethodN<Dim>& method) const;
  [[nodiscard]] std::size_t bytes() const {
    return arrays_.bytes() + paths_.bytes() + excess_.bytes();
  }

 private:
  struct GateParticle {
    VecN<Dim> place;
    std::size_t slot;
  };

  std::size_t count_;
  Layout layout_;
  std::vector<std::uint32_t> source_;  // of the layout
  ClusterBounds<Dim> bounds_;
  PairArrays<T, Dim> arrays_;
  ListPaths<T, Dim> paths_;           // at rest
  AlignedArray<T> excess_;            // sums of eq. 9
  std::vector<GateParticle> lifted_;  // those of the lifted wall that still stand
};

}  // namespace sluice

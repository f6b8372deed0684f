#pragma once

#include "engine/sph/loops/updates.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/solver/neighbours.hpp"
#include "engine/sph/solver/solver.hpp"

namespace sluice {

/// Values of the fluid at a point, from the particles around it. Finds them by the order in memory.
template <int Dim>
class FluidProbe {
 public:
  FluidProbe(const MethodN<Dim>& method, const FlowDomainN<Dim>& domain,
             const ParticlesN<Dim>& particles, const Layout& layout,
             const ClusterBounds<Dim>& bounds, SumAround<Dim> sum_around)
      : method_(method),
        domain_(domain),
        particles_(particles),
        layout_(layout),
        bounds_(bounds),
        sum_around_(sum_around) {}

  /// eq. 11 with smoothing length h, Pa; the weight is sum W V.
  [[nodiscard]] Probe pressure(const VecN<Dim>& point, double h) const;
  /// Highest point straight above or below `place` where sum W V reaches a half, m.
  [[nodiscard]] Probe surface_height(const VecN<Dim>& place) const;
  /// To the nearest particle, m; infinity when none is within the support.
  [[nodiscard]] double distance(const VecN<Dim>& point) const;

 private:
  /// Calls body(row) for those that may hold particles of a box in h.
  template <class Body>
  void for_rows_in(const BoxN<Dim>& box, const Body& body) const;
  /// Calls body(slot) for at least all particles in the box.
  template <class Body>
  void for_each_in(const BoxN<Dim>& box, const Body& body) const;

  const MethodN<Dim>& method_;
  const FlowDomainN<Dim>& domain_;
  const ParticlesN<Dim>& particles_;
  const Layout& layout_;
  const ClusterBounds<Dim>& bounds_;
  SumAround<Dim> sum_around_;
};

}  // namespace sluice

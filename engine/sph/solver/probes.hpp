#pragma once

#include "engine/sph/loops/updates.hpp"
#include "engine/sph/method/particles.hpp"
#include "engine/sph/pairs/layout.hpp"
#include "engine/sph/solver/neighbours.hpp"
#include "engine/sph/solver/solver.hpp"

namespace sluice {

/// Values of the fluid at a point, from the particles around it. Finds them by the order in memory.
class FluidProbe {
 public:
  FluidProbe(const Method& method, const FlowDomain& domain, const Particles& particles,
             const Layout& layout, const ClusterBounds& bounds, SumAround sum_around)
      : method_(method),
        domain_(domain),
        particles_(particles),
        layout_(layout),
        bounds_(bounds),
        sum_around_(sum_around) {}

  /// eq. 11 with smoothing length h, Pa; the weight is sum W V.
  [[nodiscard]] Probe pressure(const Vec& point, double h) const;
  /// Highest point at x where sum W V reaches a half, m.
  [[nodiscard]] Probe surface_height(double x) const;
  /// To the nearest particle, m; infinity when none is within the support.
  [[nodiscard]] double distance(const Vec& point) const;

 private:
  /// Calls body(row) for those that may hold particles from `low` to `high`, in h.
  template <class Body>
  void for_rows_in(float low, float high, const Body& body) const;
  /// Calls body(slot) for at least all particles in the box.
  template <class Body>
  void for_each_in(const Box& box, const Body& body) const;

  const Method& method_;
  const FlowDomain& domain_;
  const Particles& particles_;
  const Layout& layout_;
  const ClusterBounds& bounds_;
  SumAround sum_around_;
};

}  // namespace sluice

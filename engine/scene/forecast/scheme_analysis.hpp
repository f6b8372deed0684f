#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>

#include "engine/sph/stability/von_neumann.hpp"

namespace sluice {

using AnyLattice = std::variant<LatticeStabilityN<2>, LatticeStabilityN<3>>;

/// Von Neumann analysis of one scheme with a free surface, each answer computed once: limits take
/// some ten milliseconds. Thread-safe.
class SchemeAnalysis {
 public:
  explicit SchemeAnalysis(const Method& method);

  /// As LatticeStabilityN::spectral_radius.
  [[nodiscard]] double spectral_radius(double courant) const;
  /// As courant_limits(method, Surface::free).
  [[nodiscard]] CourantLimits limits() const;

 private:
  Method method_;
  AnyLattice lattice_;
  mutable std::mutex mutex_;
  mutable std::map<double, double> radii_;  ///< by Courant number
  mutable std::optional<CourantLimits> limits_;
};

/// The analysis of a method's scheme, one of the last few kept: it depends on the scheme's
/// dimensionless numbers alone, so the many scenes of a study or of a service's users share one.
/// Thread-safe.
[[nodiscard]] std::shared_ptr<const SchemeAnalysis> analyse_scheme(const Method& method);

}  // namespace sluice

#include "engine/scene/forecast/scheme_analysis.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace sluice {
namespace {

constexpr std::size_t kSchemes = 16;  // of about 100 KiB each
constexpr std::size_t kRadii = 64;

/// All that LatticeStabilityN and courant_limits look at: a term that they learn belongs in here.
/// The wall law and beta do not: they are of second order for small waves in water at rest.
struct SchemeNumbers {
  int dimensions;
  Integrator integrator;
  KernelKind kernel;
  double spacing;                                      // dx/h
  std::optional<std::pair<double, double>> viscosity;  // alpha, epsilon
  std::optional<double> delta;
  double two_nu;  // of the physical viscosity, which alone makes a scheme depend on c and h

  explicit SchemeNumbers(const Method& m)
      : dimensions(m.dimensions()),
        integrator(m.integrator),
        kernel(m.kernel),
        spacing(m.spacing / m.smoothing_length),
        two_nu(scaled_two_nu(m.laminar_viscosity, m)) {
    if (m.viscosity) viscosity.emplace(m.viscosity->alpha, m.viscosity->epsilon);
    if (m.diffusion) delta = m.diffusion->delta;
  }
  friend bool operator==(const SchemeNumbers&, const SchemeNumbers&) = default;
};

struct Kept {
  SchemeNumbers scheme;
  std::shared_ptr<const SchemeAnalysis> analysis;
};

AnyLattice lattice_of(const Method& method) {
  return in_dimensions(method.dimensions(), [&]<int Dim>() -> AnyLattice {
    return LatticeStabilityN<Dim>(method_as<Dim>(method), Surface::free);
  });
}

}  // namespace

SchemeAnalysis::SchemeAnalysis(const Method& method)
    : method_(method), lattice_(lattice_of(method)) {}

double SchemeAnalysis::spectral_radius(double courant) const {
  const std::scoped_lock lock(mutex_);
  const auto known = radii_.find(courant);
  if (known != radii_.end()) return known->second;
  if (radii_.size() == kRadii) radii_.clear();
  return radii_[courant] = std::visit(
             [&](const auto& lattice) { return lattice.spectral_radius(courant); }, lattice_);
}

CourantLimits SchemeAnalysis::limits() const {
  const std::scoped_lock lock(mutex_);
  if (!limits_) {
    limits_ = in_dimensions(method_.dimensions(), [&]<int Dim>() {
      return courant_limits(method_as<Dim>(method_), Surface::free);
    });
  }
  return *limits_;
}

std::shared_ptr<const SchemeAnalysis> analyse_scheme(const Method& method) {
  static std::mutex mutex;
  static std::vector<Kept> kept;  // the one used last stands at the end
  const SchemeNumbers scheme(method);
  const std::scoped_lock lock(mutex);
  const auto found = std::ranges::find(kept, scheme, &Kept::scheme);
  if (found != kept.end()) {
    std::rotate(found, found + 1, kept.end());
    return kept.back().analysis;
  }
  auto analysis = std::make_shared<const SchemeAnalysis>(method);
  if (kept.size() == kSchemes) kept.erase(kept.begin());
  kept.push_back({scheme, analysis});
  return analysis;
}

}  // namespace sluice

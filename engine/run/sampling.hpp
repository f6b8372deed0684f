#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/sph/solver.hpp"
#include "engine/store/series.hpp"

namespace sluice {

/// What one sensor measures. One small type per kind (sampling.cpp); a new kind is a new type and
/// one line in make_sampler().
class Sampler {
 public:
  virtual ~Sampler() = default;
  [[nodiscard]] virtual std::vector<Series::Column> columns() const = 0;
  /// Fills `values` (one per column) and returns the kernel weight that carried them: 0 is dry,
  /// and no value but the air's, where a scene names it.
  [[nodiscard]] virtual double sample(const Solver& solver, std::span<double> values) const = 0;
  /// A sampler that looks for an event ends at its first sample and stores no dry ones.
  [[nodiscard]] virtual bool is_event() const { return false; }
};

[[nodiscard]] std::unique_ptr<Sampler> make_sampler(const Sensor& sensor, const Scene& scene);

/// All sensors of a scene with their samplers. The samples and the schedule's state live in the
/// `Series`, which go into the checkpoint; a SensorArray itself has nothing to save.
class SensorArray {
 public:
  explicit SensorArray(const Scene& scene);

  /// One empty series per sensor, in the scene's order.
  [[nodiscard]] std::vector<Series> empty_series() const;

  /// Appends to each series that is due at the solver's time. `series` must be in the scene's
  /// order.
  void sample(const Solver& solver, std::vector<Series>& series) const;

 private:
  std::vector<Sensor> sensors_;
  std::vector<std::unique_ptr<Sampler>> samplers_;
};

}  // namespace sluice

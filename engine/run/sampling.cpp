#include "engine/run/sampling.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "engine/run/schedule.hpp"
#include "engine/scene/open_share.hpp"

namespace sluice {
namespace {

constexpr double kDry = std::numeric_limits<double>::quiet_NaN();

double store_probe(const Probe& probe, std::span<double> values) {
  const bool wet = probe.weight > 0.0;
  values[0] = wet ? probe.value : kDry;
  return wet ? probe.weight : 0.0;
}

double smoothing_length_of(const Sensor& sensor, const Scene& scene) {
  return sensor.smoothing_length > 0.0 ? sensor.smoothing_length : scene.method.smoothing_length;
}

/// eq. 11 at a point, Pa.
class PressureSampler : public Sampler {
 public:
  PressureSampler(const Sensor& sensor, const Scene& scene)
      : position_(sensor.position), smoothing_length_(smoothing_length_of(sensor, scene)) {}
  std::vector<Series::Column> columns() const override { return {{"value", "Pa"}}; }
  double sample(const Solver& solver, std::span<double> values) const override {
    return store_probe(solver.pressure_at(position_, smoothing_length_), values);
  }

 private:
  Vec position_;
  double smoothing_length_;
};

/// The mean over fluid and air around a point, Pa: the fluid's by eq. 11, the air's in the rest of
/// what is open there. A jet of a particle's width that hits the middle of a sensor presses on a
/// part of its face; eq. 11 takes the jet's pressure for that of all of it. Where no fluid is, the
/// air's pressure has weight 0.
class FacePressureSampler final : public PressureSampler {
 public:
  FacePressureSampler(const Sensor& sensor, const Scene& scene)
      : PressureSampler(sensor, scene),
        open_(scene, sensor.position, smoothing_length_of(sensor, scene)),
        air_(*sensor.air_pressure) {}
  double sample(const Solver& solver, std::span<double> values) const override {
    const double filled = PressureSampler::sample(solver, values);
    const double open = open_.at(solver.time());
    if (filled == 0.0) {
      values[0] = air_;
    } else if (filled < open) {
      values[0] = air_ + (values[0] - air_) * filled / open;
    }
    return filled;
  }

 private:
  OpenShare open_;
  double air_;
};

/// `x` moved half a support away from the tank's walls. On the wall itself half of the kernel lies
/// outside the fluid, and no height is half full; here 0.98 of it lies inside.
double clear_of_walls(double x, const Scene& scene) {
  if (!scene.tank) return x;
  const double margin = std::min(0.5 * scene.method.support(), 0.5 * scene.tank->width);
  return std::clamp(x, margin, scene.tank->width - margin);
}

/// Height of the surface over a given x, m: h of eq. 21. Also the column height, at the column's
/// wall.
class SurfaceHeightSampler final : public Sampler {
 public:
  explicit SurfaceHeightSampler(double x) : x_(x) {}
  std::vector<Series::Column> columns() const override { return {{"value", "m"}}; }
  double sample(const Solver& solver, std::span<double> values) const override {
    return store_probe(solver.surface_height_at(x_), values);
  }

 private:
  double x_;
};

/// Position of the surge front, m: w of eq. 20. The front ends at the tank's right wall: what
/// splashed over it and falls behind it is no front.
class SurgeFrontSampler final : public Sampler {
 public:
  explicit SurgeFrontSampler(const Scene& scene)
      : end_(scene.tank ? scene.tank->width : std::numeric_limits<double>::infinity()) {}
  std::vector<Series::Column> columns() const override { return {{"value", "m"}}; }
  double sample(const Solver& solver, std::span<double> values) const override {
    Probe front = solver.surge_front();
    front.value = std::min(front.value, end_);
    return store_probe(front, values);
  }

 private:
  double end_;
};

/// Kinetic, potential and internal energy of the fluid, J per metre of depth.
class EnergySampler final : public Sampler {
 public:
  std::vector<Series::Column> columns() const override {
    return {{"kinetic", "J/m"}, {"potential", "J/m"}, {"internal", "J/m"}};
  }
  double sample(const Solver& solver, std::span<double> values) const override {
    const Energy energy = solver.energy();
    values[0] = energy.kinetic;
    values[1] = energy.potential;
    values[2] = energy.internal;
    return 1.0;
  }
};

/// The time, s, at which fluid is first seen within 1.5 spacings of a point: one particle diameter
/// plus half, so that a particle resting against the point's wall counts.
class ArrivalSampler final : public Sampler {
 public:
  ArrivalSampler(const Vec& position, double spacing)
      : position_(position), reach_(1.5 * spacing) {}
  std::vector<Series::Column> columns() const override { return {{"value", "s"}}; }
  bool is_event() const override { return true; }
  double sample(const Solver& solver, std::span<double> values) const override {
    const bool arrived = solver.distance_to_fluid(position_) <= reach_;
    values[0] = arrived ? solver.time() : kDry;
    return arrived ? 1.0 : 0.0;
  }

 private:
  Vec position_;
  double reach_;
};

void append(Series& series, double time, std::span<const double> values, double weight) {
  series.duration.push_back(series.time.empty() ? 0.0 : time - series.time.back());
  series.time.push_back(time);
  series.values.insert(series.values.end(), values.begin(), values.end());
  series.weight.push_back(weight);
}

std::string_view kind_name(SensorKind kind) {
  switch (kind) {
    case SensorKind::pressure:
      return "pressure";
    case SensorKind::surface_height:
      return "surface_height";
    case SensorKind::surge_front:
      return "surge_front";
    case SensorKind::column_height:
      return "column_height";
    case SensorKind::energy:
      return "energy";
    case SensorKind::arrival:
      return "arrival";
  }
  throw std::logic_error("unknown sensor kind");
}

}  // namespace

std::unique_ptr<Sampler> make_sampler(const Sensor& sensor, const Scene& scene) {
  const Method& method = scene.method;
  switch (sensor.kind) {
    case SensorKind::pressure:
      if (sensor.air_pressure) return std::make_unique<FacePressureSampler>(sensor, scene);
      return std::make_unique<PressureSampler>(sensor, scene);
    case SensorKind::surface_height:
    case SensorKind::column_height:
      return std::make_unique<SurfaceHeightSampler>(clear_of_walls(sensor.position.x(), scene));
    case SensorKind::surge_front:
      return std::make_unique<SurgeFrontSampler>(scene);
    case SensorKind::energy:
      return std::make_unique<EnergySampler>();
    case SensorKind::arrival:
      return std::make_unique<ArrivalSampler>(sensor.position, method.spacing);
  }
  throw std::logic_error("unknown sensor kind");
}

SensorArray::SensorArray(const Scene& scene) : sensors_(scene.sensors) {
  for (const Sensor& sensor : sensors_) samplers_.push_back(make_sampler(sensor, scene));
}

std::vector<Series> SensorArray::empty_series() const {
  std::vector<Series> all;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    Series series;
    series.name = sensors_[i].name;
    series.kind = kind_name(sensors_[i].kind);
    series.columns = samplers_[i]->columns();
    all.push_back(std::move(series));
  }
  return all;
}

void SensorArray::sample(const Solver& solver, std::vector<Series>& series) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    Series& target = series[i];
    const Sampler& sampler = *samplers_[i];
    if (!is_due(solver.time(), sensors_[i].interval, target.next_index)) continue;
    if (sampler.is_event() && target.size() > 0) continue;
    target.next_index = next_index_after(solver.time(), sensors_[i].interval, target.next_index);
    values.assign(target.columns.size(), kDry);
    const double weight = sampler.sample(solver, values);
    if (sampler.is_event() && weight == 0.0) continue;
    append(target, solver.time(), values, weight);
  }
}

}  // namespace sluice

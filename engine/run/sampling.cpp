#include "engine/run/sampling.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "engine/run/schedule.hpp"
#include "engine/scene/geometry/open_fraction.hpp"
#include "engine/space/axes.hpp"

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
  OpenFraction open_;
  double air_;
};

/// `place` moved half a support away from the tank's side walls. On the wall itself half of the
/// kernel lies outside the fluid, and no height is half full; here 0.98 of it lies inside.
Vec clear_of_walls(Vec place, const Scene& scene) {
  if (!scene.tank) return place;
  const Box interior = scene.tank->interior();
  for (const int axis : floor_axes(scene.dimensions())) {
    const double length = interior.size()[axis];
    const double margin = std::min(0.5 * scene.method.support(), 0.5 * length);
    place[axis] = std::clamp(place[axis], margin, length - margin);
  }
  return place;
}

/// Height of the surface over a place, m: h of eq. 21. Also the column height, at the column's
/// wall.
class SurfaceHeightSampler final : public Sampler {
 public:
  explicit SurfaceHeightSampler(const Vec& place) : place_(place) {}
  std::vector<Series::Column> columns() const override { return {{"value", "m"}}; }
  double sample(const Solver& solver, std::span<double> values) const override {
    return store_probe(solver.surface_height_at(place_), values);
  }

 private:
  Vec place_;
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

/// Kinetic, potential and internal energy of the fluid, J, in the plane per metre of depth.
class EnergySampler final : public Sampler {
 public:
  explicit EnergySampler(int dimensions) : unit_(energy_unit(dimensions)) {}
  bool uses_all_threads() const override { return true; }
  std::vector<Series::Column> columns() const override {
    return {{"kinetic", unit_}, {"potential", unit_}, {"internal", unit_}};
  }
  double sample(const Solver& solver, std::span<double> values) const override {
    const Energy energy = solver.energy();
    values[0] = energy.kinetic;
    values[1] = energy.potential;
    values[2] = energy.internal;
    return 1.0;
  }

 private:
  std::string unit_;
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

/// Most sensors that a thread asks at once: some microseconds of work.
constexpr std::size_t kMostAtOnce = 16;
constexpr std::size_t kPieces = 64;  // of a table: few sensors go one by one

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
      return std::make_unique<SurfaceHeightSampler>(clear_of_walls(sensor.position, scene));
    case SensorKind::surge_front:
      return std::make_unique<SurgeFrontSampler>(scene);
    case SensorKind::energy:
      return std::make_unique<EnergySampler>(scene.dimensions());
    case SensorKind::arrival:
      return std::make_unique<ArrivalSampler>(sensor.position, method.spacing);
  }
  throw std::logic_error("unknown sensor kind");
}

SensorArray::SensorArray(const Scene& scene) {
  for (std::size_t place = 0; place < scene.sensors.size(); ++place) {
    const Sensor& sensor = scene.sensors[place];
    std::unique_ptr<Sampler> sampler = make_sampler(sensor, scene);
    Group& group = group_for(sensor, *sampler);
    SampleTable& table = empty_[static_cast<std::size_t>(&group - groups_.data())];
    table.kind = kind_name(sensor.kind);
    table.columns = sampler->columns();
    table.names.push_back(sensor.name);
    table.places.push_back(place);
    group.samplers.push_back(std::move(sampler));
  }
}

SensorArray::Group& SensorArray::group_for(const Sensor& sensor, const Sampler& sampler) {
  const auto same = std::find_if(groups_.begin(), groups_.end(), [&](const Group& group) {
    return group.kind == sensor.kind && group.interval == sensor.interval;
  });
  // An event ends its sensor and no other.
  if (same != groups_.end() && !sampler.is_event()) return *same;
  empty_.emplace_back();
  return groups_.emplace_back(Group{sensor.kind, sensor.interval, {}});
}

SensorArray::Row SensorArray::begin_row(const Group& group, SampleTable& table) {
  const Row row{&group, &table, table.values.size(), table.weight.size()};
  table.values.resize(row.values_from + table.width(), kDry);
  table.weight.resize(row.weight_from + table.sensors());
  return row;
}

void SensorArray::fill(const Row& row, const Solver& solver, std::size_t begin, std::size_t end) {
  const std::size_t columns = row.table->columns.size();
  for (std::size_t i = begin; i < end; ++i) {
    double* values = row.table->values.data() + row.values_from + i * columns;
    row.table->weight[row.weight_from + i] =
        row.group->samplers[i]->sample(solver, {values, columns});
  }
}

void SensorArray::end_row(const Row& row, double time) {
  SampleTable& table = *row.table;
  if (row.group->samplers.front()->is_event() && table.weight.back() == 0.0) {
    table.values.resize(row.values_from);
    table.weight.resize(row.weight_from);
    return;
  }
  table.duration.push_back(table.time.empty() ? 0.0 : time - table.time.back());
  table.time.push_back(time);
}

void SensorArray::sample(const Solver& solver, std::vector<SampleTable>& tables) const {
  struct Piece {
    std::size_t row, begin, end;
  };
  const double time = solver.time();
  std::vector<Row> rows;
  std::vector<Piece> pieces;
  for (std::size_t n = 0; n < groups_.size(); ++n) {
    const Group& group = groups_[n];
    SampleTable& table = tables[n];
    if (!is_due(time, group.interval, table.next_index)) continue;
    if (group.samplers.front()->is_event() && table.size() > 0) continue;
    table.next_index = next_index_after(time, group.interval, table.next_index);
    rows.push_back(begin_row(group, table));
    const std::size_t count = table.sensors();
    if (group.samplers.front()->uses_all_threads()) {
      fill(rows.back(), solver, 0, count);
      continue;
    }
    const std::size_t at_once = std::clamp(count / kPieces, std::size_t{1}, kMostAtOnce);
    for (std::size_t i = 0; i < count; i += at_once) {
      pieces.push_back({rows.size() - 1, i, std::min(i + at_once, count)});
    }
  }
  if (rows.empty()) return;
  solver.for_each(pieces.size(), [&](std::size_t n) {
    fill(rows[pieces[n].row], solver, pieces[n].begin, pieces[n].end);
  });
  for (const Row& row : rows) end_row(row, time);
}

}  // namespace sluice

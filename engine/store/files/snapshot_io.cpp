#include "engine/store/files/snapshot_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/layout.hpp"

namespace sluice {
namespace {

template <int Dim>
struct SnapshotFieldList;
template <>
struct SnapshotFieldList<2> {
  static constexpr std::array fields{
      SnapshotField{"x", "m", "position from the origin, horizontal", {&Snapshot::position, 0}},
      SnapshotField{"y", "m", "position from the origin, vertical", {&Snapshot::position, 1}},
      SnapshotField{"vx", "m/s", "velocity, horizontal", {&Snapshot::velocity, 0}},
      SnapshotField{"vy", "m/s", "velocity, vertical", {&Snapshot::velocity, 1}},
      SnapshotField{"pressure", "Pa", "pressure, eq. 3", &Snapshot::pressure},
  };
};
template <>
struct SnapshotFieldList<3> {
  static constexpr std::array fields{
      SnapshotField{"x", "m", "position from the origin along x", {&Snapshot::position, 0}},
      SnapshotField{"y", "m", "position from the origin along y, up", {&Snapshot::position, 1}},
      SnapshotField{"z", "m", "position from the origin along z", {&Snapshot::position, 2}},
      SnapshotField{"vx", "m/s", "velocity along x", {&Snapshot::velocity, 0}},
      SnapshotField{"vy", "m/s", "velocity along y", {&Snapshot::velocity, 1}},
      SnapshotField{"vz", "m/s", "velocity along z", {&Snapshot::velocity, 2}},
      SnapshotField{"pressure", "Pa", "pressure, eq. 3", &Snapshot::pressure},
  };
};

std::vector<float> single(const std::vector<double>& values, double origin = 0.0) {
  std::vector<float> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(),
                 [origin](double value) { return static_cast<float>(value - origin); });
  return result;
}

double origin_of(const std::vector<double>& positions) {
  double low = INFINITY;
  double high = -INFINITY;
  for (const double position : positions) {
    if (!std::isfinite(position)) continue;
    low = std::min(low, position);
    high = std::max(high, position);
  }
  const double middle = low + 0.5 * (high - low);
  return low <= high && std::abs(middle) > high - low ? middle : 0.0;
}

Bytes encode(const Snapshot& frame) {
  WriteArchive archive(
      frame.size() *
      (snapshot_fields_in(frame.position.size()).size() * sizeof(float) + sizeof(std::uint64_t)));
  walk_format(archive, kSnapshotFormat);
  walk_snapshot(archive, frame);
  return archive.image();
}

Snapshot decode_snapshot(ByteSpan image) {
  ReadArchive archive(image);
  Snapshot frame;
  const std::uint64_t version = walk_format(archive, kSnapshotFormat);
  walk_snapshot(archive, frame, version);
  archive.require_all_met();
  return frame;
}

}  // namespace

Snapshot empty_snapshot(std::uint64_t step, double time, std::size_t dimensions) {
  Snapshot frame;
  frame.step = step;
  frame.time = time;
  frame.position = PerAxis<std::vector<float>>(dimensions);
  frame.velocity = PerAxis<std::vector<float>>(dimensions);
  frame.origin = filled_vec<kAnyDim>(0.0, static_cast<int>(dimensions));
  return frame;
}

std::span<const SnapshotField> snapshot_fields_in(std::size_t dimensions) {
  if (dimensions == 2) return SnapshotFieldList<2>::fields;
  return SnapshotFieldList<3>::fields;
}

std::string snapshot_name(std::uint64_t index) { return fmt::format("frame-{:06}.h5", index); }

Snapshot make_snapshot(const SolverState& state, const Method& method) {
  const Particles& particles = state.particles;
  Snapshot frame = empty_snapshot(state.step, state.time, particles.position.size());
  for (std::size_t axis = 0; axis < particles.position.size(); ++axis) {
    double& origin = frame.origin[static_cast<Eigen::Index>(axis)];
    origin = origin_of(particles.position[axis]);
    frame.position[axis] = single(particles.position[axis], origin);
    frame.velocity[axis] = single(particles.velocity[axis]);
  }
  const double c_squared = method.sound_speed * method.sound_speed;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    frame.pressure.push_back(static_cast<float>(c_squared * particles.density_excess[i]));
    frame.id.push_back(static_cast<std::uint64_t>(particles.id[i]));
  }
  return frame;
}

void write_snapshot(const std::filesystem::path& path, const Snapshot& frame, Durability durability,
                    FileSystem& system) {
  const Bytes image = naming(path, [&] { return encode(frame); });
  publish(path, image, durability, system);
}

Snapshot read_snapshot(const std::filesystem::path& path) {
  const Bytes image = read_verified(path);
  return naming(path, [&] { return decode_snapshot(image); });
}

}  // namespace sluice

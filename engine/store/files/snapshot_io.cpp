#include "engine/store/files/snapshot_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/store/disk/errors.hpp"
#include "engine/store/files/layout.hpp"

namespace sluice {
namespace {

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
  WriteArchive archive(frame.size() *
                       (kSnapshotFields.size() * sizeof(float) + sizeof(std::uint64_t)));
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

std::string snapshot_name(std::uint64_t index) { return fmt::format("frame-{:06}.h5", index); }

Snapshot make_snapshot(const SolverState& state, const Method& method) {
  const Particles& particles = state.particles;
  Snapshot frame;
  frame.step = state.step;
  frame.time = state.time;
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

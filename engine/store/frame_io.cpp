#include "engine/store/frame_io.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/store/errors.hpp"
#include "engine/store/layout.hpp"

namespace sluice {
namespace {

std::vector<float> single(const std::vector<double>& values) {
  std::vector<float> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(),
                 [](double value) { return static_cast<float>(value); });
  return result;
}

Bytes encode(const Frame& frame) {
  WriteArchive archive(frame.x.size() * (5 * sizeof(float) + sizeof(std::uint64_t)));
  walk_format(archive, kFrameFormat);
  walk_frame(archive, frame);
  return archive.image();
}

Frame decode(ByteSpan image) {
  ReadArchive archive(image);
  Frame frame;
  walk_format(archive, kFrameFormat);
  walk_frame(archive, frame);
  archive.require_all_met();
  return frame;
}

}  // namespace

std::string frame_name(std::uint64_t index) { return fmt::format("frame-{:06}.h5", index); }

Frame make_frame(const SolverState& state, const Method& method) {
  const Particles& particles = state.particles;
  Frame frame{state.step,
              state.time,
              single(particles.x),
              single(particles.y),
              single(particles.vx),
              single(particles.vy),
              {},
              {}};
  const double c_squared = method.sound_speed * method.sound_speed;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    frame.pressure.push_back(static_cast<float>(c_squared * particles.density_excess[i]));
    frame.id.push_back(static_cast<std::uint64_t>(particles.id[i]));
  }
  return frame;
}

void write_frame(const std::filesystem::path& path, const Frame& frame, Durability durability,
                 FileSystem& system) {
  const Bytes image = naming(path, [&] { return encode(frame); });
  publish(path, image, durability, system);
}

Frame read_frame(const std::filesystem::path& path) {
  const Bytes image = read_verified(path);
  return naming(path, [&] { return decode(image); });
}

}  // namespace sluice

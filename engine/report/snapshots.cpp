#include "engine/report/snapshots.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string>

#include "engine/scene/geometry/geometry.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/job_folder.hpp"

namespace sluice {
namespace {

namespace fs = std::filesystem;

std::optional<double> time_of_highest_pressure(const Report& report) {
  std::optional<double> at;
  double highest = 0.0;
  for (const SensorSummary& sensor : report.sensors) {
    if (sensor.kind != "pressure" || !sensor.highest || !(*sensor.highest > highest)) continue;
    highest = *sensor.highest;
    at = sensor.highest_at;
  }
  return at;
}

/// The number in a frame's name.
std::uint64_t index_in(const fs::path& path) {
  const std::string name = path.filename().string();
  std::uint64_t index = 0;
  const auto digits = std::min(name.find_first_of("0123456789"), name.size());
  std::from_chars(name.data() + digits, name.data() + name.size(), index);
  return index;
}

}  // namespace

std::vector<double> picture_times(const Report& report, double last) {
  if (!report.scene.pictures.empty()) return report.scene.pictures;
  if (report.comparison) {
    std::vector<double> times;
    for (const double time : report.comparison->reference->measures.pictures) {
      times.push_back(time * report.comparison->time_unit);
    }
    // A snapshot counts for a time that it comes a little before.
    if (!times.empty() && times.back() <= last + 0.1 * report.comparison->time_unit) return times;
  }
  std::vector<double> times{0.0, last / 3.0, last * 2.0 / 3.0, last};
  const auto impact = time_of_highest_pressure(report);
  if (impact && *impact <= last) times.push_back(*impact);
  std::sort(times.begin(), times.end());
  return times;
}

std::vector<fs::path> picture_files(const fs::path& folder, const Report& report) {
  const std::vector<fs::path> all = JobPaths(folder).snapshot_files();
  if (all.empty() || !report.scene.frames) return {};
  const double interval = report.scene.frames->interval;
  const auto distance = [&](const fs::path& path, double time) {
    return std::abs(static_cast<double>(index_in(path)) * interval - time);
  };
  std::set<fs::path> chosen;
  for (const double time :
       picture_times(report, static_cast<double>(index_in(all.back())) * interval)) {
    chosen.insert(*std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
      return distance(a, time) < distance(b, time);
    }));
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<fs::path> spread_files(const fs::path& folder, std::size_t most) {
  const std::vector<fs::path> all = JobPaths(folder).snapshot_files();
  if (all.size() <= most) return all;
  std::vector<fs::path> files;
  for (std::size_t k = 0; k < most; ++k) files.push_back(all[k * (all.size() - 1) / (most - 1)]);
  return files;
}

std::optional<Snapshot> try_snapshot(const fs::path& path) {
  try {
    return read_snapshot(path);
  } catch (const StorageError&) {
    return std::nullopt;
  }
}

std::optional<Box> particle_box(std::span<const Snapshot> frames) {
  std::optional<Box> box;
  for (const Snapshot& frame : frames) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const Vec place = frame.position_of(i);
      if (!place.allFinite()) continue;
      if (!box) box = Box{place, place};
      box->take_in(place);
    }
  }
  return box;
}

Box picture_room(const Scene& scene, const std::optional<Box>& particles) {
  if (scene.tank) return scene.tank->interior();
  const int dimensions = scene.dimensions();
  if (!particles) {
    return {filled_vec<kAnyDim>(0.0, dimensions), filled_vec<kAnyDim>(1.0, dimensions)};
  }
  Box box = *particles;
  // Of ground that goes on for ever as much as lies about the fluid.
  const Box near = grown(box, box.size().maxCoeff());
  for (const Shape& obstacle : scene.obstacles) {
    const Box whole = bounds(obstacle);
    if (!overlap(whole, near)) continue;
    box.take_in(whole.min.cwiseMax(near.min));
    box.take_in(whole.max.cwiseMin(near.max));
  }
  return grown(box, std::max(scene.method.spacing, 0.03 * box.size().maxCoeff()));
}

Box2 picture_view(const Scene& scene, const std::optional<Box>& particles) {
  const Box room = picture_room(scene, particles);
  Box2 view{room.min.head<2>(), room.max.head<2>()};
  if (!scene.tank) return view;
  const double wall = std::max(scene.method.support(), 0.008 * view.size().maxCoeff());
  const double above = scene.tank->open_top ? 0.0 : wall;
  return {view.min - Vec2::Constant(wall), view.max + Vec2(wall, above)};
}

double picture_section(const Scene& scene) {
  if (scene.dimensions() == 2) return 0.0;
  return (scene.tank ? scene.tank->interior() : bounds(scene.fluid.front().shape)).middle()[2];
}

double colour_end(const std::vector<Snapshot>& frames, Quantity quantity) {
  std::vector<float> all;
  for (const Snapshot& frame : frames) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const float value = coloured_value(frame, i, quantity);
      if (std::isfinite(value)) all.push_back(value);
    }
  }
  if (all.empty()) return 1.0;
  const auto place = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) * 199 / 200);
  std::nth_element(all.begin(), place, all.end());
  return std::max(static_cast<double>(*place), 1e-9);
}

}  // namespace sluice

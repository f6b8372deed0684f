#include "engine/export/vtk_file.hpp"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/store/hdf5/hdf5_writer.hpp"

namespace sluice {
namespace {

constexpr std::uint8_t kVertex = 1;  ///< VTK_VERTEX
constexpr std::array<std::int64_t, 2> kVersion{1, 0};
const std::string kRoot = "/VTKHDF";

std::vector<std::int64_t> count_up_to(std::size_t end) {
  std::vector<std::int64_t> numbers(end);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Parts that a file may have been made in: always one here.
void write_count(Hdf5Writer& writer, const std::string& name, std::size_t count) {
  const std::array<std::int64_t, 1> value{static_cast<std::int64_t>(count)};
  writer.write(kRoot + "/" + name, std::span<const std::int64_t>(value), {1});
}

void write_cells(Hdf5Writer& writer, std::size_t count) {
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
    write_count(writer, name, count);
  }
  writer.write(kRoot + "/Connectivity", std::span<const std::int64_t>(count_up_to(count)), {count});
  writer.write(kRoot + "/Offsets", std::span<const std::int64_t>(count_up_to(count + 1)),
               {count + 1});
  const std::vector<std::uint8_t> types(count, kVertex);
  writer.write(kRoot + "/Types", std::span<const std::uint8_t>(types), {count});
}

/// VTK's points and vectors have three components in the plane as well.
template <class Vector, class Scalar>
void append_padded(std::vector<Scalar>& to, const Vector& vector) {
  to.insert(to.end(), vector.begin(), vector.end());
  to.insert(to.end(), static_cast<std::size_t>(3 - vector.size()), Scalar{0});
}

void write_points(Hdf5Writer& writer, const Snapshot& frame) {
  const std::size_t count = frame.size();
  std::vector<double> points;
  std::vector<float> velocities;
  std::vector<std::int64_t> ids;
  points.reserve(3 * count);
  velocities.reserve(3 * count);
  ids.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    append_padded(points, frame.position_of(i));
    append_padded(velocities, frame.velocity_of(i));
    ids.push_back(static_cast<std::int64_t>(frame.id[i]));
  }
  writer.write(kRoot + "/Points", std::span<const double>(points), {count, 3});
  const std::string data = kRoot + "/PointData";
  writer.create_group(data);
  writer.write(data + "/pressure", std::span<const float>(frame.pressure), {count});
  writer.write(data + "/velocity", std::span<const float>(velocities), {count, 3});
  writer.write(data + "/id", std::span<const std::int64_t>(ids), {count});
}

}  // namespace

std::string vtk_name(const std::filesystem::path& frame) {
  return frame.filename().replace_extension(".hdf").string();
}

void write_vtk(const std::filesystem::path& path, const Snapshot& frame) {
  constexpr std::uint64_t kBytesPerParticle = 73;
  Hdf5Writer writer(frame.size() * kBytesPerParticle);
  writer.create_group(kRoot);
  writer.set_attribute(kRoot, "Version", std::span<const std::int64_t>(kVersion));
  writer.set_ascii(kRoot, "Type", "UnstructuredGrid");
  write_cells(writer, frame.size());
  write_points(writer, frame);
  const Bytes image = writer.image();
  publish_text(path, {reinterpret_cast<const char*>(image.data()), image.size()});
}

std::string vtk_series_text(const std::vector<std::pair<std::string, double>>& files) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [name, time] : files) list.push_back({{"name", name}, {"time", time}});
  const nlohmann::ordered_json series{{"file-series-version", "1.0"}, {"files", std::move(list)}};
  return series.dump(1) + "\n";
}

}  // namespace sluice

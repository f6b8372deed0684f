#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/scene/format/mesh_file.hpp"
#include "engine/scene/geometry/mesh_faults.hpp"
#include "tests/fuzz/require.hpp"

// Any bytes as a mesh file: they are triangles whose corners are there, or refused with a reason.
// Of closed ones every line is in the body between its ends.

namespace sluice::fuzz {
namespace {

constexpr std::size_t kMost = 10'000;

void try_lines(const TriangleMesh& mesh) {
  const Vec3 middle = mesh.bounds().middle();
  for (int axis = 0; axis < 3; ++axis) {
    const auto ends = mesh.ends_of_chords(middle, Vec3::Unit(axis));
    require(ends.size() % 2 == 0, "a line leaves what it enters");
  }
  (void)mesh.contains(middle);
  require(mesh.nearest(middle).distance >= 0.0, "something is nearest");
}

void try_mesh(std::string_view name, std::string_view bytes) {
  try {
    const Triangles triangles = read_mesh_file(name, bytes, kMost);
    require(!triangles.corners.empty() && triangles.corners.size() <= kMost, "they are bounded");
    for (const auto& corners : triangles.corners) {
      for (const std::uint32_t each : corners) {
        require(each < triangles.points.size(), "a corner is there");
      }
    }
    if (!mesh_fault(triangles)) try_lines(TriangleMesh(triangles));
  } catch (const MeshFileError& error) {
    require(!std::string_view(error.what()).empty(), "a refusal says why");
  }
}

}  // namespace
}  // namespace sluice::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  sluice::fuzz::try_mesh("a.stl", bytes);
  sluice::fuzz::try_mesh("a.obj", bytes);
  return 0;
}

#include "engine/scene/checks/surfaces.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/scene/format/describe_ranges.hpp"
#include "engine/scene/format/mesh_file.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/mesh_faults.hpp"
#include "engine/space/space_traits.hpp"

namespace sluice {
namespace {

class SurfaceMaker {
 public:
  SurfaceMaker(const SceneParts& parts, Problems& problems, Problems& warnings)
      : parts_(parts), problems_(problems), warnings_(warnings) {}

  void make(const std::string& pointer, Shape& shape) {
    if (!problems_.clean({pointer})) return;
    if (auto* heights = std::get_if<Heights>(&shape)) make(pointer, *heights);
    if (auto* mesh = std::get_if<Mesh>(&shape)) make(pointer, *mesh);
  }

 private:
  void make(const std::string& pointer, Heights& shape) {
    for (std::size_t j = 0; j < shape.heights.size(); ++j) {
      for (std::size_t i = 0; i < shape.heights[j].size(); ++i) {
        if (shape.heights[j][i] > shape.corner[kUpAxis]) continue;
        problems_.add(at(at(at(pointer, "heights"), j), i),
                      fmt::format("is {:.6g} m; must be above the base, corner/1, {:.6g} m",
                                  shape.heights[j][i], shape.corner[kUpAxis]));
        return;
      }
    }
    shape.surface = std::make_shared<const TriangleMesh>(triangles_of(shape));
  }

  void make(const std::string& pointer, Mesh& shape) {
    if (shape.rotation && shape.rotation->axis.norm() <= 0.0) {
      problems_.add(at(at(pointer, "rotation"), "axis"),
                    "has no length; give a direction, such as y's");
      return;
    }
    const std::string where = at(pointer, "file");
    const ScenePart part = parts_(shape.file);
    if (!part.why_none.empty()) {
      problems_.add(where, fmt::format("is \"{}\", but {}", shape.file, part.why_none));
    } else if (!shape.sha256.empty() && shape.sha256 != part.sha256) {
      problems_.add(at(pointer, "sha256"),
                    fmt::format("is {}, but that of {} is {}: the file was changed; put the former "
                                "one back, or start a new run",
                                shape.sha256, shape.file, part.sha256));
    } else if (part.bytes.size() > kMaxMeshBytes) {
      problems_.add(where, fmt::format("is \"{}\", which has {} bytes; at most {}: make it coarser",
                                       shape.file, part.bytes.size(), kMaxMeshBytes));
    } else if (auto triangles = read(where, shape, part.bytes)) {
      shape.sha256 = part.sha256;
      shape.surface = closed(where, shape, *std::move(triangles));
    }
  }

  std::optional<Triangles> read(const std::string& where, const Mesh& shape,
                                const std::string& bytes) {
    try {
      Triangles triangles = read_mesh_file(shape.file, bytes, kMaxMeshTriangles - triangles_);
      triangles_ += triangles.corners.size();
      return placed(std::move(triangles), shape);
    } catch (const MeshFileError& error) {
      problems_.add(where, fmt::format("is \"{}\", which {}", shape.file, error.what()));
      return std::nullopt;
    }
  }

  std::shared_ptr<const TriangleMesh> closed(const std::string& where, const Mesh& shape,
                                             Triangles triangles) {
    for (const Vec3& point : triangles.points) {
      if (point.cwiseAbs().maxCoeff() <= kCoordinate.high) continue;
      problems_.add(where,
                    fmt::format("is \"{}\", which reaches to ({:.6g}) m; every coordinate "
                                "must be {}: lower the scale",
                                shape.file, fmt::join(point, ", "), to_text(kCoordinate, "m")));
      return nullptr;
    }
    if (const auto fault = mesh_fault(triangles)) {
      problems_.add(where, fmt::format("is \"{}\", which {}", shape.file, *fault));
      return nullptr;
    }
    auto mesh = std::make_shared<const TriangleMesh>(triangles);
    if (mesh->volume() < 0.0) {
      warnings_.add(where, fmt::format("is \"{}\", whose triangles all face inwards; they are "
                                       "turned round",
                                       shape.file));
      for (auto& corners : triangles.corners) std::swap(corners[1], corners[2]);
      mesh = std::make_shared<const TriangleMesh>(std::move(triangles));
    }
    if (mesh->volume() > 0.0) return mesh;
    problems_.add(where, fmt::format("is \"{}\", which encloses nothing; give it a closed surface "
                                     "around a body",
                                     shape.file));
    return nullptr;
  }

  const SceneParts& parts_;
  Problems& problems_;
  Problems& warnings_;
  std::size_t triangles_ = 0;  // so far
};

}  // namespace

void make_surfaces(Scene& scene, const SceneParts& parts, Problems& problems, Problems& warnings) {
  SurfaceMaker maker(parts, problems, warnings);
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    maker.make(at("/fluid", i), scene.fluid[i].shape);
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    maker.make(at("/obstacles", i), scene.obstacles[i]);
  }
}

}  // namespace sluice

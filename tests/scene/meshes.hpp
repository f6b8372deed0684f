#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/geometry/surfaces.hpp"
#include "engine/scene/model/parts.hpp"

namespace sluice::testing {

/// An axis-aligned box, two triangles a face, facing outwards.
inline Triangles box_mesh(const Vec3& corner, const Vec3& size) {
  Triangles box;
  for (int i = 0; i < 8; ++i) {
    const Vec3 part(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    box.points.push_back(corner + part.cwiseProduct(size));
  }
  box.corners = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

/// A ball of triangles: an octahedron whose triangles were cut in four so often, corners on the
/// ball.
inline Triangles ball_mesh(const Vec3& center, double radius, int cuts) {
  Triangles ball;
  ball.points = {Vec3(1, 0, 0),  Vec3(0, 1, 0),  Vec3(0, 0, 1),
                 Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)};
  ball.corners = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                  {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middles.try_emplace(
          {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(ball.points.size()));
      if (is_new) ball.points.push_back((ball.points[a] + ball.points[b]).normalized());
      return found->second;
    };
    std::vector<Triangles::Corners> finer;
    for (const auto& [a, b, c] : ball.corners) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    ball.corners = std::move(finer);
  }
  for (Vec3& point : ball.points) point = center + radius * point;
  return ball;
}

inline Triangles flipped(Triangles triangles) {
  for (auto& corners : triangles.corners) std::swap(corners[1], corners[2]);
  return triangles;
}

/// As a shape, without the way through a file.
inline Mesh as_shape(Triangles triangles) {
  Mesh mesh;
  mesh.file = "test.stl";
  mesh.surface = std::make_shared<const TriangleMesh>(std::move(triangles));
  return mesh;
}

inline std::string as_binary_stl(const Triangles& triangles) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(static_cast<std::uint32_t>(triangles.corners.size()));
  for (const auto& corners : triangles.corners) {
    for (int k = 0; k < 3; ++k) put(0.0F);
    for (const std::uint32_t corner : corners) {
      for (const double each : triangles.points[corner]) put(static_cast<float>(each));
    }
    put(std::uint16_t{0});
  }
  return bytes;
}

inline std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}
inline std::string place_text(const Vec3& p) {
  return number_text(p.x()) + " " + number_text(p.y()) + " " + number_text(p.z());
}

inline std::string as_ascii_stl(const Triangles& triangles) {
  std::string text = "solid test\n";
  for (const auto& corners : triangles.corners) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t each : corners) {
      text += "   vertex " + place_text(triangles.points[each]) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid test\n";
}

inline std::string as_obj(const Triangles& triangles) {
  std::string text = "# test\no body\n";
  for (const Vec3& point : triangles.points) text += "v " + place_text(point) + "\n";
  for (const auto& [a, b, c] : triangles.corners) {
    text += "f " + std::to_string(a + 1) + "/1 " + std::to_string(b + 1) + "//2 " +
            std::to_string(c + 1) + "\n";
  }
  return text;
}

/// Files of a scene by their names. Their SHA-256 is made up, another for each text.
inline SceneParts parts_with(std::map<std::string, std::string> files) {
  return [files = std::move(files)](const std::string& name) -> ScenePart {
    const auto found = files.find(name);
    if (found == files.end()) return no_parts(name);
    std::string digits = std::to_string(std::hash<std::string>{}(found->second));
    return {found->second, digits + std::string(64 - digits.size(), '0'), {}};
  };
}

}  // namespace sluice::testing

#include "engine/scene/format/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <tuple>

#include "engine/scene/format/mesh_lines.hpp"

namespace sluice {
namespace {

constexpr std::size_t kHead = 84;      // of a binary STL: a text of 80 bytes and the count
constexpr std::size_t kTriangle = 50;  // a normal, three corners of floats, two bytes more
constexpr double kFarthest = 1e12;     // in the file's units: squares of it are exact enough

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

bool is_place(const Vec3& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= kFarthest;
}

void require_count(double count, std::size_t most) {
  if (count <= static_cast<double>(most)) return;
  throw MeshFileError(
      fmt::format("has {:.0f} triangles; at most {} in all meshes of a scene: make "
                  "it coarser",
                  count, most));
}

/// Three corners for each triangle, in order.
Triangles read_binary(std::string_view bytes) {
  Triangles result;
  for (std::size_t at = kHead; at < bytes.size(); at += kTriangle) {
    Triangles::Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t place = at + 12 * (k + 1);
      const Vec3 point(value_at<float>(bytes, place), value_at<float>(bytes, place + 4),
                       value_at<float>(bytes, place + 8));
      if (!is_place(point)) {
        throw MeshFileError(
            fmt::format("has a corner at byte {} that is no place; all coordinates "
                        "must be numbers, at most {:.0e}",
                        place, kFarthest));
      }
      corners[k] = static_cast<std::uint32_t>(result.points.size());
      result.points.push_back(point);
    }
    result.corners.push_back(corners);
  }
  return result;
}

Vec3 read_place(MeshLines& lines) {
  Vec3 point;
  for (double& each : point) each = lines.number();
  if (!is_place(point)) lines.fail(fmt::format("a coordinate above {:.0e}", kFarthest));
  return point;
}

Triangles read_ascii(std::string_view bytes, std::size_t most) {
  MeshLines lines(bytes);
  Triangles result;
  while (lines.next()) {
    const std::string word = lines.word();
    if (word == "solid" || word == "endsolid") continue;
    if (word != "facet") lines.fail("no facet, where one must begin");
    require_count(static_cast<double>(result.corners.size() + 1), most);
    lines.require({"outer", "loop"});
    Triangles::Corners corners;
    for (std::uint32_t& each : corners) {
      lines.require({"vertex"});
      each = static_cast<std::uint32_t>(result.points.size());
      result.points.push_back(read_place(lines));
    }
    lines.require({"endloop"});
    lines.require({"endfacet"});
    result.corners.push_back(corners);
  }
  return result;
}

Triangles read_stl(std::string_view bytes, std::size_t most) {
  if (bytes.size() >= kHead) {
    const auto count = value_at<std::uint32_t>(bytes, kHead - 4);
    const double whole = static_cast<double>(kHead) + static_cast<double>(kTriangle) * count;
    if (static_cast<double>(bytes.size()) == whole) {
      require_count(count, most);
      return read_binary(bytes);
    }
    if (!MeshLines::begins_with(bytes, "solid")) {
      throw MeshFileError(
          fmt::format("has {} bytes, but as a binary STL of {} triangles (bytes 80 to 83) it must "
                      "have {:.0f}, and an ascii one begins with \"solid\": it was cut off, or is "
                      "another kind of file",
                      bytes.size(), count, whole));
    }
  } else if (!MeshLines::begins_with(bytes, "solid")) {
    throw MeshFileError(
        fmt::format("has {} bytes and does not begin with \"solid\": it was cut "
                    "off, or is another kind of file",
                    bytes.size()));
  }
  return read_ascii(bytes, most);
}

Triangles read_obj(std::string_view bytes, std::size_t most) {
  MeshLines lines(bytes);
  Triangles result;
  std::vector<std::uint32_t> face;
  while (lines.next()) {
    const std::string word = lines.word();
    if (word == "v") {
      result.points.push_back(read_place(lines));
    } else if (word == "f") {
      face.clear();
      while (!lines.at_end()) face.push_back(lines.corner(result.points.size()));
      if (face.size() < 3) lines.fail("a face of less than three corners");
      require_count(static_cast<double>(result.corners.size() + face.size() - 2), most);
      for (std::size_t k = 2; k < face.size(); ++k) {
        result.corners.push_back({face[0], face[k - 1], face[k]});
      }
    }
  }
  return result;
}

/// One point for each place, in the order of their first corners.
Triangles welded(const Triangles& given) {
  std::vector<std::uint32_t> order(given.points.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto place = [&](std::uint32_t i) {
    const Vec3& p = given.points[i];
    return std::make_tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t one, std::uint32_t other) { return place(one) < place(other); });
  std::vector<std::uint32_t> first(given.points.size());  // of those at the same place
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && given.points[order[k]] == given.points[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  constexpr std::uint32_t kNone = ~0U;
  std::vector<std::uint32_t> number(given.points.size(), kNone);
  Triangles result;
  for (const auto& corners : given.corners) {
    Triangles::Corners joined;
    for (std::size_t k = 0; k < 3; ++k) joined[k] = first[corners[k]];
    if (joined[0] == joined[1] || joined[1] == joined[2] || joined[2] == joined[0]) continue;
    for (std::uint32_t& each : joined) {
      if (number[each] == kNone) {
        number[each] = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(given.points[each]);
      }
      each = number[each];
    }
    result.corners.push_back(joined);
  }
  return result;
}

}  // namespace

Triangles read_mesh_file(std::string_view name, std::string_view bytes, std::size_t most) {
  const char kind = name.size() < 3 ? 's' : name[name.size() - 3];
  const bool obj = kind == 'o' || kind == 'O';
  Triangles result = welded(obj ? read_obj(bytes, most) : read_stl(bytes, most));
  if (result.corners.empty()) {
    throw MeshFileError("has no triangle with an area; give it a closed surface");
  }
  return result;
}

}  // namespace sluice

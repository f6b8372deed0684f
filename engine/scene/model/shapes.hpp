#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/space/vec.hpp"

namespace sluice {

class TriangleMesh;  // engine/scene/geometry/triangle_mesh.hpp

// Shapes. Lengths in m, x to the right, y up.

/// An axis-aligned box by its corner of lowest coordinates: in the plane a rectangle.
template <int Dim>
struct Cuboid {
  static constexpr int dimensions = Dim;
  VecN<Dim> corner = VecN<Dim>::Zero();  ///< in the plane the lower left one
  VecN<Dim> size = VecN<Dim>::Zero();
};

template <int Dim>
struct Ball {
  static constexpr int dimensions = Dim;
  VecN<Dim> center = VecN<Dim>::Zero();
  double radius = 0.0;
};

/// Its axes are those of space.
template <int Dim>
struct Ellipsoid {
  static constexpr int dimensions = Dim;
  VecN<Dim> center = VecN<Dim>::Zero();
  VecN<Dim> semi_axes = VecN<Dim>::Zero();
};

using Rectangle = Cuboid<2>;
using Circle = Ball<2>;
using Ellipse = Ellipsoid<2>;

/// Of the plane only.
struct Polygon {
  static constexpr int dimensions = 2;
  std::vector<VecN<2>> points;  ///< simple, not closed by repetition
};

/// Of space only: a right circular one, whose axis may point anywhere.
struct Cylinder {
  static constexpr int dimensions = 3;
  VecN<3> base = VecN<3>::Zero();  ///< middle of one end
  VecN<3> axis = VecN<3>::Zero();  ///< from there to the middle of the other end; not zero
  double radius = 0.0;
};

/// Of space only: a polygon of the plane of x and y, drawn out along z.
struct Prism {
  static constexpr int dimensions = 3;
  Polygon section;
  double z = 0.0;      ///< where it begins
  double depth = 0.0;  ///< along z
};

/// Of space only: what lies between a level base and a surface over it, such as a bed. The surface
/// is told by heights on a grid, and straight between them: each cell is cut from its node of
/// lowest x and z to that of highest.
struct Heights {
  static constexpr int dimensions = 3;
  VecN<3> corner = VecN<3>::Zero();          ///< lowest x and z of the grid, and y of the base
  VecN<2> step = VecN<2>::Zero();            ///< from node to node along x and z
  std::vector<std::vector<double>> heights;  ///< y of the surface: rows along x, by z; above base
  std::shared_ptr<const TriangleMesh> surface = {};  ///< made of the above when a scene is read
};

struct Rotation {
  VecN<3> axis = VecN<3>::Zero();  ///< of any length but 0
  double angle = 0.0;              ///< degrees, anticlockwise as seen from the axis' tip
};

/// Of space only: the inside of a closed surface of triangles, from a file beside the scene.
struct Mesh {
  static constexpr int dimensions = 3;
  std::string file;                                  ///< its bare name
  std::string sha256;                                ///< of the file, in hexadecimal digits
  double scale = 1.0;                                ///< m in a unit of the file
  std::optional<Rotation> rotation;                  ///< about the file's origin, after the scale
  VecN<3> place = VecN<3>::Zero();                   ///< where the file's origin comes to lie
  std::shared_ptr<const TriangleMesh> surface = {};  ///< read from the file when a scene is read
};

/// Every shape that there is in `Dim` dimensions.
template <int Dim>
struct ShapesOf;
template <>
struct ShapesOf<2> {
  using Any = std::variant<Rectangle, Circle, Ellipse, Polygon>;
};
template <>
struct ShapesOf<3> {
  using Any = std::variant<Cuboid<3>, Ball<3>, Ellipsoid<3>, Cylinder, Prism, Heights, Mesh>;
};
template <int Dim>
using ShapeN = typename ShapesOf<Dim>::Any;

/// A shape of any number of dimensions. All of a scene are of the scene's.
using Shape = std::variant<Rectangle, Circle, Ellipse, Polygon, Cuboid<3>, Ball<3>, Ellipsoid<3>,
                           Cylinder, Prism, Heights, Mesh>;

[[nodiscard]] inline int dimensions_of(const Shape& shape) {
  return std::visit([]<class S>(const S&) { return S::dimensions; }, shape);
}

/// The shape among those of its dimensions. Throws std::bad_variant_access where it has others.
template <int Dim>
[[nodiscard]] ShapeN<Dim> shape_as(const Shape& shape) {
  return std::visit(
      []<class S>(const S& s) -> ShapeN<Dim> {
        if constexpr (S::dimensions == Dim) return s;
        throw std::bad_variant_access();
      },
      shape);
}
template <int Dim>
[[nodiscard]] std::vector<ShapeN<Dim>> shapes_as(const std::vector<Shape>& shapes) {
  std::vector<ShapeN<Dim>> result;
  result.reserve(shapes.size());
  for (const Shape& shape : shapes) result.push_back(shape_as<Dim>(shape));
  return result;
}

}  // namespace sluice

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/space/vec.hpp"

namespace sluice {

/// Triangles by the numbers of their corners, anticlockwise as seen from outside. Lengths in m.
struct Triangles {
  using Corners = std::array<std::uint32_t, 3>;
  std::vector<Vec3> points;
  std::vector<Corners> corners;
};

/// A closed surface of triangles, with a tree of boxes about them, and what a shape is asked. Every
/// answer is plain double arithmetic, so that it has the same bits on every machine, and none
/// depends on the order of the triangles but by rounding of sums.
///
/// What is inside is told by lines: each crosses a closed surface inwards as often as outwards, and
/// is inside where it has not. One through an edge or a corner is taken to pass beside it, the same
/// side for all triangles there: signs of areas are exact, so none is missed or met twice
/// (Edelsbrunner and Muecke 1990, "Simulation of simplicity"). Bodies that overlap are one.
class TriangleMesh {
 public:
  /// Of closed triangles (mesh_faults.hpp). Those that are not have answers too, of no use.
  explicit TriangleMesh(Triangles triangles);

  [[nodiscard]] const Triangles& triangles() const { return triangles_; }
  [[nodiscard]] std::size_t size() const { return triangles_.corners.size(); }
  [[nodiscard]] const BoxN<3>& bounds() const { return bounds_; }
  /// m^3; negative where the triangles face inwards.
  [[nodiscard]] double volume() const { return volume_; }
  [[nodiscard]] double area() const { return area_; }

  /// The corners of a triangle.
  [[nodiscard]] std::array<Vec3, 3> triangle(std::size_t i) const;
  /// Of length 1, out of the body; zero where a triangle has no area.
  [[nodiscard]] Vec3 normal(std::size_t i) const;

  [[nodiscard]] bool contains(const Vec3& point) const;
  /// The nearest point of the surface, if it is nearer than `within`.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  ///< m; infinite where there is none
    Vec3 place = Vec3::Zero();
  };
  [[nodiscard]] Nearest nearest(const Vec3& point,
                                double within = std::numeric_limits<double>::infinity()) const;

  /// Where a line origin + t direction enters the body and leaves it, by increasing t, in pairs.
  struct Crossing {
    double t = 0.0;
    int turn = 0;  ///< 1 or -1, opposite for ways in and out
    std::size_t triangle = 0;
  };
  [[nodiscard]] std::vector<Crossing> ends_of_chords(const Vec3& origin,
                                                     const Vec3& direction) const;

  /// Calls f(i) for each triangle whose box meets another.
  template <class F>
  void for_each_in(const BoxN<3>& box, const F& f) const {
    walk([&](const Node& node) { return overlap(node.box, box); },
         [&](std::size_t i) {
           if (overlap(box_of(i), box)) f(i);
         });
  }

 private:
  /// Triangles from `first` on in `order_`, or, with none, two nodes: the next and `other`.
  struct Node {
    BoxN<3> box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t other = 0;
  };

  [[nodiscard]] BoxN<3> box_of(std::size_t i) const;
  void build(const std::vector<Vec3>& middles, std::uint32_t first, std::uint32_t last);
  template <class F>
  void for_each_crossing(const Vec3& origin, const Vec3& direction, const F& f) const;

  /// Calls leaf(i) for the triangles of each node that `wanted` accepts with all nodes above it.
  template <class Wanted, class Leaf>
  void walk(const Wanted& wanted, const Leaf& leaf) const {
    std::array<std::uint32_t, kDeepest> open;
    std::size_t depth = 0;
    if (!nodes_.empty()) open[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t at = open[--depth];
      const Node& node = nodes_[at];
      if (!wanted(node)) continue;
      for (std::uint32_t k = 0; k < node.count; ++k) leaf(order_[node.first + k]);
      if (node.count > 0) continue;
      open[depth++] = node.other;
      open[depth++] = at + 1;
    }
  }

  // Halves of halves: as many as a number of triangles has bits, each with one node to come back
  // to.
  static constexpr std::size_t kDeepest = 64;

  Triangles triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  BoxN<3> bounds_;
  double volume_ = 0.0;
  double area_ = 0.0;
};

/// The point of a triangle that is nearest to another (Ericson 2004, "Real-time collision
/// detection", section 5.1.5).
[[nodiscard]] Vec3 nearest_point(const std::array<Vec3, 3>& triangle, const Vec3& point);

}  // namespace sluice

#pragma once

#include <vector>

#include "engine/scene/model/shapes.hpp"

namespace sluice {

/// Straight through a body of space, from one face to another.
struct Chord {
  Vec3 from, to;          ///< on the faces, m
  Vec3 out_from, out_to;  ///< out of the body there, of length 1

  /// Between faces that stand across it.
  Chord(const Vec3& a, const Vec3& b) : Chord(a, b, (a - b).normalized(), (b - a).normalized()) {}
  Chord(const Vec3& a, const Vec3& b, const Vec3& out_a, const Vec3& out_b)
      : from(a), to(b), out_from(out_a), out_to(out_b) {}

  [[nodiscard]] double length() const { return (to - from).norm(); }
  [[nodiscard]] Vec3 middle() const { return 0.5 * (from + to); }
  /// Whether the body is thinner or thicker just beside it: its faces are more than ten degrees
  /// from parallel.
  [[nodiscard]] bool tapers() const { return out_from.dot(out_to) > -0.985; }
};

/// Chords of a body where it may be thin for particles `spacing` apart, m: across a box and a
/// cylinder, through the middle of a ball, through the section of a prism from its outline.
[[nodiscard]] std::vector<Chord> ways_through(const ShapeN<3>& body, double spacing);

}  // namespace sluice

#include "engine/scene/checks/check_solids_in_space.hpp"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "engine/scene/checks/check_solids.hpp"
#include "engine/scene/geometry/directions.hpp"
#include "engine/scene/geometry/geometry.hpp"
#include "engine/scene/geometry/solids.hpp"
#include "engine/scene/geometry/too_thin.hpp"

namespace sluice {
namespace {

constexpr int kPerSide = 3;            // places along each side of a face
constexpr int kChordsOfBall = 24;      // through the middle of a round body
constexpr double kRounded = 1 - 1e-6;  // two spacings that rounding made less are two

/// Straight through a body, from one face to the opposite one.
struct Chord {
  Vec3 from, to;  ///< on the faces, m

  [[nodiscard]] double length() const { return (to - from).norm(); }
  [[nodiscard]] Vec3 middle() const { return 0.5 * (from + to); }
};

std::vector<Chord> chords_of(const Cuboid<3>& s) {
  std::vector<Chord> result;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < kPerSide; ++i) {
      for (int j = 0; j < kPerSide; ++j) {
        Vec3 from = s.corner;
        from[u] += s.size[u] * (i + 0.5) / kPerSide;
        from[v] += s.size[v] * (j + 0.5) / kPerSide;
        Vec3 to = from;
        to[axis] += s.size[axis];
        result.push_back({from, to});
      }
    }
  }
  return result;
}
std::vector<Chord> chords_of(const Ellipsoid<3>& s) {
  std::vector<Chord> result;
  for (const Vec3& way : half_of_directions<3>(kChordsOfBall)) {
    const Vec3 reach = way.cwiseProduct(s.semi_axes);
    result.push_back({s.center - reach, s.center + reach});
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 reach = s.semi_axes[axis] * Vec3::Unit(axis);
    result.push_back({s.center - reach, s.center + reach});
  }
  return result;
}
std::vector<Chord> chords_of(const Ball<3>& s) {
  return chords_of(Ellipsoid<3>{s.center, Vec3::Constant(s.radius)});
}

/// The two places beyond the ends of a chord where a particle lies against the faces, if both are
/// in the open.
std::optional<Chord> open_ends(const Chord& chord, const SolidsN<3>& solids, double dx) {
  const Vec3 way = (chord.to - chord.from).normalized();
  const Chord ends{chord.from - kRoom * dx * way, chord.to + kRoom * dx * way};
  const double room = kRoom * dx * kRounded;
  if (!solids.leaves_room(ends.from, room) || !solids.leaves_room(ends.to, room)) return {};
  return ends;
}

std::string size_text(const Chord& chord, double dx) {
  return fmt::format("{:.3g} m, {:.2g} spacings, at ({:.4g}) m", chord.length(),
                     chord.length() / dx, fmt::join(chord.middle(), ", "));
}

void check_obstacle(const Scene& scene, const SolidsN<3>& solids, std::size_t i, Problems& problems,
                    Problems& warnings) {
  const double dx = scene.method.spacing;
  const auto all =
      std::visit([](const auto& s) { return chords_of(s); }, shape_as<3>(scene.obstacles[i]));
  std::optional<Chord> thinnest;  // of those between two open places
  for (const Chord& chord : all) {
    if (thinnest && chord.length() >= thinnest->length()) continue;
    if (chord.length() < kFewAcross * dx && open_ends(chord, solids, dx)) thinnest = chord;
  }
  if (!thinnest) return;
  const Chord ends = *open_ends(*thinnest, solids, dx);
  const bool thin = thinnest->length() < kThinnestSolid * dx * kRounded &&
                    keeps_apart<3>(solids, ends.from, ends.to, thinnest->length(), dx);
  if (thin) {
    problems.add(
        at("/obstacles", i),
        fmt::format("is only {} thick; must be at least {} spacings, or fluid gets through "
                    "it; make it {:.3g} m thick or lower /resolution/spacing to {:.3g} m",
                    size_text(*thinnest, dx), kThinnestSolid, kThinnestSolid * dx,
                    0.995 * thinnest->length() / kThinnestSolid));
  } else {
    warnings.add(
        at("/obstacles", i),
        fmt::format("is {} across; pressures on a body that fluid flows round want at "
                    "least {}; for them lower /resolution/spacing to {:.3g} m",
                    size_text(*thinnest, dx), kFewAcross, 0.995 * thinnest->length() / kFewAcross));
  }
}

}  // namespace

void check_solids_in_space(const Scene& scene, Problems& problems, Problems& warnings) {
  const SolidsN<3> solids = solids_of<3>(scene);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    check_obstacle(scene, solids, i, problems, warnings);
  }
}

}  // namespace sluice

#include "engine/scene/checks/check_solids_in_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/scene/checks/check_solids.hpp"
#include "engine/scene/geometry/solids.hpp"
#include "engine/scene/geometry/too_thin.hpp"
#include "engine/scene/geometry/ways_through.hpp"

namespace sluice {
namespace {

constexpr double kRounded = 1 - 1e-6;    // two spacings that rounding made less are two
constexpr std::size_t kMostWays = 1024;  // of ways round solids, for all obstacles together

/// The two places beyond the ends of a chord where a particle lies against the faces, if both are
/// in the open.
std::optional<std::pair<Vec3, Vec3>> open_ends(const Chord& chord, const SolidsN<3>& solids,
                                               double dx) {
  const std::pair<Vec3, Vec3> ends{chord.from + kRoom * dx * chord.out_from,
                                   chord.to + kRoom * dx * chord.out_to};
  const double room = kRoom * dx * kRounded;
  if (!solids.leaves_room(ends.first, room) || !solids.leaves_room(ends.second, room)) return {};
  return ends;
}

std::string size_text(const Chord& chord, double dx) {
  return fmt::format("{:.3g} m, {:.2g} spacings, at ({:.4g}) m", chord.length(),
                     chord.length() / dx, fmt::join(chord.middle(), ", "));
}

std::string thin_text(const Chord& chord, double dx) {
  return fmt::format(
      "is only {} thick; must be at least {} spacings, or fluid gets through it; make it {:.3g} m "
      "thick{}",
      size_text(chord, dx), kThinnestSolid, kThinnestSolid * dx,
      chord.tapers() ? " there, also where it tapers: a lower /resolution/spacing does not mend it"
                     : fmt::format(" or lower /resolution/spacing to {:.3g} m",
                                   0.995 * chord.length() / kThinnestSolid));
}

std::string few_across_text(const Chord& chord, double dx) {
  return fmt::format(
      "is {} across; pressures on a body that fluid flows round want at least {}; for them lower "
      "/resolution/spacing to {:.3g} m",
      size_text(chord, dx), kFewAcross, 0.995 * chord.length() / kFewAcross);
}

void check_obstacle(const Scene& scene, const SolidsN<3>& solids, std::size_t i, Problems& problems,
                    Problems& warnings) {
  const double dx = scene.method.spacing;
  std::vector<Chord> chords = ways_through(shape_as<3>(scene.obstacles[i]), dx);
  std::erase_if(chords,
                [&](const Chord& each) { return each.length() >= kFewAcross * dx * kRounded; });
  std::stable_sort(chords.begin(), chords.end(),
                   [](const Chord& a, const Chord& b) { return a.length() < b.length(); });
  const Chord* few = nullptr;
  std::size_t tries = kMostWays / scene.obstacles.size();
  for (const Chord& chord : chords) {
    const auto ends = open_ends(chord, solids, dx);
    if (!ends) continue;
    const bool thin = chord.length() < kThinnestSolid * dx * kRounded;
    if (thin && tries > 0) {
      --tries;
      if (keeps_apart<3>(solids, ends->first, ends->second, chord.length(), dx)) {
        problems.add(at("/obstacles", i), thin_text(chord, dx));
        return;
      }
    }
    if (few == nullptr && !chord.tapers()) few = &chord;
  }
  if (few != nullptr) warnings.add(at("/obstacles", i), few_across_text(*few, dx));
}

}  // namespace

void check_solids_in_space(const Scene& scene, Problems& problems, Problems& warnings) {
  const SolidsN<3> solids = solids_of<3>(scene);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    check_obstacle(scene, solids, i, problems, warnings);
  }
}

}  // namespace sluice

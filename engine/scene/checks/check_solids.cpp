#include "engine/scene/checks/check_solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "engine/scene/checks/check_solids_in_space.hpp"
#include "engine/scene/geometry/narrow_part.hpp"
#include "engine/scene/geometry/solids.hpp"
#include "engine/scene/geometry/thin_solids.hpp"
#include "engine/space/axes.hpp"

namespace sluice {
namespace {

// Points on all outlines together; the sides of polygons have a few each beyond that.
constexpr std::size_t kMostPoints = 4096;
constexpr double kAlike = 1 - 1e-6;  // two spacings that rounding made less are two
constexpr double kOnFace = 0.5;      // spacings
constexpr double kDeepest = 16;      // spacings
constexpr int kMostTries = 8;
constexpr double kFinest = 20;  // of this part of a spacing none is advised
constexpr int kLinePoints = 256;

using Solids = SolidsN<2>;

/// A length in m and in spacings, with its place.
std::string size_text(const Narrow& narrow, double spacing) {
  return fmt::format("{:.3g} m, {:.2g} spacings, at ({:.4g}) m", narrow.width,
                     narrow.width / spacing, fmt::join(narrow.place, ", "));
}

/// A spacing of which `count` fit into a width, with the digits that keep it below.
std::string spacing_text(double width, double count) {
  return fmt::format("{:.3g}", 0.995 * width / count);
}

std::optional<Narrow> thin_part(const Scene& scene, const Solids& solids, std::size_t i,
                                double dx) {
  return thin_part(
      solids,
      outline(shape_as<2>(scene.obstacles[i]), dx / 4, kMostPoints / scene.obstacles.size()), dx);
}

/// The spacing at which an obstacle that is too thin would be thick enough, as text; "" if there is
/// none near: whatever the spacing, the end of a sharp wedge is thinner than two.
std::string mending_spacing(const Scene& scene, const Solids& solids, std::size_t i, Narrow thin) {
  for (int tries = 0; tries < kMostTries && thin.width > 0.0; ++tries) {
    const std::string text = spacing_text(thin.width, kThinnestSolid);
    const double dx = std::stod(text);
    if (dx < scene.method.spacing / kFinest) break;
    const auto still = thin_part(scene, solids, i, dx);
    if (!still) return text;
    thin = *still;
  }
  return "";
}

std::string thin_text(const Scene& scene, const Solids& solids, std::size_t i, Narrow thin) {
  const double dx = scene.method.spacing;
  thin.width = std::max(0.0, thin.width);
  const std::string mending = mending_spacing(scene, solids, i, thin);
  return fmt::format(
      "is only {} thick; must be at least {} spacings, or fluid gets through it; make it {:.3g} m "
      "thick{}",
      size_text(thin, dx), kThinnestSolid, kThinnestSolid * dx,
      mending.empty() ? " there, also where it tapers or touches other solids: a lower "
                        "/resolution/spacing does not mend it"
                      : fmt::format(" or lower /resolution/spacing to {} m", mending));
}

void check_obstacle(const Scene& scene, const Solids& solids, std::size_t i, Problems& problems,
                    Problems& warnings) {
  const double dx = scene.method.spacing;
  const std::string pointer = at("/obstacles", i);
  const auto points =
      outline(shape_as<2>(scene.obstacles[i]), dx / 4, kMostPoints / scene.obstacles.size());
  const auto narrow = [&](Across across, double spacings) {
    return narrow_part(solids, points, across, spacings * kAlike * dx, dx);
  };
  if (const auto thin = thin_part(scene, solids, i, dx)) {
    problems.add(pointer, thin_text(scene, solids, i, *thin));
  } else if (const auto few = narrow(Across::solid, kFewAcross)) {
    warnings.add(pointer, fmt::format("is {} across; pressures on a body that fluid flows round "
                                      "want at least {}; for them lower /resolution/spacing to {} "
                                      "m",
                                      size_text(*few, dx), kFewAcross,
                                      spacing_text(few->width, kFewAcross)));
  }
  if (const auto gap = narrow(Across::gap, kNarrowestSlit)) {
    warnings.add(pointer, fmt::format("leaves a slit of {}; below {} spacings fewer than two "
                                      "particles fit side by side, and what passes is no flow of "
                                      "the fluid; close it, widen it or lower "
                                      "/resolution/spacing to {} m",
                                      size_text(*gap, dx), kNarrowestSlit,
                                      spacing_text(gap->width, kNarrowestSlit)));
  }
}

template <int Dim>
void check_point(const Sensor& sensor, const Scene& scene, const SolidsN<Dim>& solids,
                 const std::string& pointer, Problems& warnings) {
  const double half = kOnFace * scene.method.spacing;
  // One at a seam looks as deep as it is, but not endlessly far.
  if (solids.depth(sensor.position, 1.01 * half) <= half) return;
  const double depth = solids.depth(sensor.position, kDeepest * scene.method.spacing);
  warnings.add(at(pointer, "position"),
               fmt::format("is ({:.6g}) m, {:.3g} m deep in {}, where no fluid can be; put it on "
                           "the face that the fluid touches, or in the fluid",
                           fmt::join(sensor.position, ", "), depth,
                           solids.depth_in_walls(sensor.position) > 0.0 ? "a wall of the tank"
                                                                        : "an obstacle"));
}

/// Whether some point over a place on the floor is in no solid. On a face, the open is on one side.
template <int Dim>
bool is_open_somewhere_over(VecN<Dim> place, const BoxN<Dim>& interior, const SolidsN<Dim>& solids,
                            double half) {
  for (int k = 0; k < kLinePoints; ++k) {
    place[kUpAxis] = (k + 0.5) / kLinePoints * interior.max[kUpAxis];
    for (const int axis : floor_axes(Dim)) {
      for (const double aside : {-half, half}) {
        VecN<Dim> beside = place;
        beside[axis] += aside;
        if (!solids.holds(beside)) return true;
      }
    }
  }
  return false;
}

template <int Dim>
void check_line(const Sensor& sensor, const Scene& scene, const SolidsN<Dim>& solids,
                const std::string& pointer, Problems& warnings) {
  if (!scene.tank) return;
  const double half = kOnFace * scene.method.spacing;
  const BoxN<Dim> interior = scene.tank->interior();
  for (const int axis : floor_axes(Dim)) {
    const double along = sensor.position[axis];
    const double length = interior.max[axis];
    if (along >= -half && along <= length + half) continue;
    warnings.add(at(pointer, axis_name(axis)),
                 fmt::format("is {:.6g} m, outside the tank, where no fluid can be; must be from 0 "
                             "to {:.6g} m to measure anything",
                             along, length));
    return;
  }
  if (is_open_somewhere_over<Dim>(sensor.position, interior, solids, half)) return;
  warnings.add(at(pointer, axis_name(floor_axes(Dim).front())),
               fmt::format("is {:.6g} m, where obstacles fill the tank from the floor to the rim: "
                           "no surface is there; move it",
                           sensor.position[floor_axes(Dim).front()]));
}

template <int Dim>
void check_places(const Scene& scene, Problems& warnings) {
  const SolidsN<Dim> solids = solids_of<Dim>(scene);
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const Sensor& sensor = scene.sensors[i];
    const std::string pointer = at("/sensors", i);
    switch (sensor.kind) {
      case SensorKind::pressure:
      case SensorKind::arrival:
        check_point<Dim>(sensor, scene, solids, pointer, warnings);
        break;
      case SensorKind::surface_height:
      case SensorKind::column_height:
        check_line<Dim>(sensor, scene, solids, pointer, warnings);
        break;
      case SensorKind::surge_front:
      case SensorKind::energy:
        break;
    }
  }
}

}  // namespace

void check_solids(const Scene& scene, Problems& problems, Problems& warnings) {
  if (scene.dimensions() == 3) return check_solids_in_space(scene, problems, warnings);
  const Solids solids = solids_of<2>(scene);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    check_obstacle(scene, solids, i, problems, warnings);
  }
}

void check_sensor_places(const Scene& scene, Problems& warnings) {
  in_dimensions(scene.dimensions(), [&]<int Dim>() { check_places<Dim>(scene, warnings); });
}

}  // namespace sluice

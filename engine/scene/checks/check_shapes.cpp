#include "engine/scene/checks/check_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/scene/filling/walls.hpp"
#include "engine/scene/format/describe.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

// Sides of the domain and distance from the origin, in spacings: rows of cells are kept in memory,
// and positions must stay exact to a small part of dx.
constexpr double kMaxDomainCells = 1e6;
constexpr double kMaxOffsetCells = 1e9;
// Lengths that are meant to be equal may differ by rounding: 0.1 + 0.2 against 0.3.
constexpr double kSlack = 1e-9;
// The files of meshes have seven digits.
constexpr double kSlackOfMeshes = 1e-6;

bool within(const Box& inner, const Box& outer, double of_size = kSlack) {
  const double slack = of_size * outer.size().maxCoeff();
  return (inner.min.array() >= outer.min.array() - slack).all() &&
         (inner.max.array() <= outer.max.array() + slack).all();
}

/// Calls f(pointer, shape) for each region and obstacle that reads well.
template <class F>
void for_each_shape(const Scene& scene, const Problems& problems, const F& f) {
  const auto visit = [&](std::string pointer, const Shape& shape) {
    if (problems.clean({pointer})) f(pointer, shape);
  };
  for (std::size_t i = 0; i < scene.fluid.size(); ++i) {
    visit(at("/fluid", i), scene.fluid[i].shape);
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    visit(at("/obstacles", i), scene.obstacles[i]);
  }
}

/// The corners that a shape is told by, if it is.
const Polygon* polygon_of(const Shape& shape) {
  if (const auto* prism = std::get_if<Prism>(&shape)) return &prism->section;
  return std::get_if<Polygon>(&shape);
}

/// Along the axes of space, but those of a cylinder along and across its own, m.
Vec size_of(const Shape& shape) {
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return Vec2(cylinder->axis.norm(), 2 * cylinder->radius);
  }
  return bounds(shape).size();
}

bool within(const Shape& inner, const Box& outer) {
  return within(bounds(inner), outer,
                std::holds_alternative<Mesh>(inner) ? kSlackOfMeshes : kSlack);
}

/// Everything that must lie in the domain: the tank with its walls, else the fluid and obstacles.
void check_domain_holds(const Scene& scene, const WrittenScene& written, Problems& problems) {
  const Box& domain = scene.domain.box;
  if (scene.tank) {
    const double walls = static_cast<double>(wall_layers(scene.method)) * scene.method.spacing;
    const double lid = scene.tank->open_top ? 0.0 : walls;
    Box solid = grown(scene.tank->interior(), walls);
    solid.max[kUpAxis] = scene.tank->height + lid;
    if (!within(solid, domain)) {
      problems.add("/domain", fmt::format("is {}; must hold the tank and its walls, {}",
                                          show(domain), show(solid)));
    }
    return;
  }
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    if (within(shape, domain)) return;
    problems.add(pointer,
                 fmt::format("reaches from {}; must lie in /domain, {}{}", show(bounds(shape)),
                             show(domain), written.domain ? "" : " (the default)"));
  });
}

}  // namespace

std::string show(const Box& box) {
  return fmt::format("({:.6g}) to ({:.6g}) m", fmt::join(box.min, ", "), fmt::join(box.max, ", "));
}

void check_insides(const Scene& scene, Problems& problems) {
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    const Polygon* polygon = polygon_of(shape);
    if (polygon != nullptr && (!is_simple(*polygon) || measure(*polygon) <= 0)) {
      problems.add(at(pointer, "points"),
                   "the outline crosses, touches or folds back on itself; give the corners in "
                   "order around an area, each once");
    }
    const auto* cylinder = std::get_if<Cylinder>(&shape);
    if (cylinder != nullptr && cylinder->axis.norm() <= 0) {
      problems.add(at(pointer, "axis"),
                   "has no length; give the way from the middle of one end to that of the other");
    }
  });
}

void check_sizes(const Scene& scene, Problems& problems) {
  if (!problems.clean({"/resolution"})) return;
  const double dx = scene.method.spacing;
  const auto check_size = [&](std::string pointer, const Vec& size) {
    if (size.minCoeff() >= dx * (1 - kSlack)) return;
    problems.add(std::move(pointer),
                 fmt::format("is {:.6g} m; must be at least one /resolution/spacing, "
                             "{:.6g} m, either way",
                             fmt::join(size, " m x "), dx));
  };
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    check_size(pointer, size_of(shape));
  });
  if (scene.tank && problems.clean({"/tank"})) {
    check_size("/tank", scene.tank->size());
  }
}

void check_tank(const Scene& scene, Problems& problems) {
  if (!scene.tank || !problems.clean({"/tank"})) return;
  if (dimensions_of(scene.tank->size()) != scene.dimensions()) {
    problems.add("/tank/depth", scene.tank->depth
                                    ? "is given; must be left out in a scene of 2 dimensions"
                                    : "is missing; must be given in a scene of 3 dimensions");
    return;
  }
  const Box inside = scene.tank->interior();
  for_each_shape(scene, problems, [&](const std::string& pointer, const Shape& shape) {
    if (within(shape, inside)) return;
    problems.add(pointer, fmt::format("reaches from {}; must lie inside /tank, {}",
                                      show(bounds(shape)), show(inside)));
  });
}

void check_gate(const Scene& scene, Problems& problems) {
  if (!scene.gate || !problems.clean({"/gate"})) return;
  if (!scene.tank) {
    problems.add("/gate", "stands in no tank; add the key tank or remove the gate");
    return;
  }
  const Box place = bounds(gate_body(scene));
  const Box inside = scene.tank->interior();
  if (!within(place, inside)) {
    problems.add("/gate", fmt::format("reaches from {}; must lie inside /tank, {}", show(place),
                                      show(inside)));
  }
  if (scene.gate->height < scene.method.spacing * (1 - kSlack)) {
    problems.add("/gate/height", fmt::format("is {:.6g} m; must be at least one "
                                             "/resolution/spacing, {:.6g} m",
                                             scene.gate->height, scene.method.spacing));
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const Box other = bounds(scene.obstacles[i]);
    if ((other.min.array() >= place.max.array()).any() ||
        (other.max.array() <= place.min.array()).any()) {
      continue;
    }
    problems.add("/gate", fmt::format("reaches from {}, into the box around /obstacles/{}, {}; "
                                      "move one of them",
                                      show(place), i, show(other)));
  }
}

void check_domain(const Scene& scene, const WrittenScene& written, Problems& problems) {
  const Box& domain = scene.domain.box;
  const double dx = scene.method.spacing;
  if ((domain.min.array() >= domain.max.array()).any()) {
    problems.add("/domain", fmt::format("is {}; min must be below max both ways", show(domain)));
    return;
  }
  if (const Vec reach = domain.min.cwiseAbs().cwiseMax(domain.max.cwiseAbs());
      reach.maxCoeff() > kCoordinate.high) {
    problems.add("/domain", fmt::format("is {} (the default); every coordinate must be {}; give a "
                                        "smaller one or move the scene nearer to the origin",
                                        show(domain), to_text(kCoordinate, "m")));
    return;
  }
  const double sides = domain.size().maxCoeff() / dx;
  const double offset =
      std::max(domain.min.cwiseAbs().maxCoeff(), domain.max.cwiseAbs().maxCoeff()) / dx;
  if (!(sides <= kMaxDomainCells && offset <= kMaxOffsetCells)) {
    problems.add("/domain",
                 fmt::format("is {}{}; each side may be at most {:.0e} and each corner at most "
                             "{:.0e} spacings of {:.6g} m from the origin",
                             show(domain), written.domain ? "" : " (the default)", kMaxDomainCells,
                             kMaxOffsetCells, dx));
    return;
  }
  check_domain_holds(scene, written, problems);
}

}  // namespace sluice

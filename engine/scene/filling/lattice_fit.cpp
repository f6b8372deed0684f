#include "engine/scene/filling/lattice_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/filling/body_fill.hpp"
#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/faces_seen.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

template <int Dim>
class FitCheck {
 public:
  using Point = VecN<Dim>;

  FitCheck(const Scene& scene, const Body& body)
      : scene_(scene),
        body_(body),
        dx_(scene.method.spacing),
        tank_(room_of<Dim>(scene)),
        solids_(shapes_as<Dim>(solid_bodies(scene))) {
    for (const ShapeN<Dim>& solid : solids_) boxes_.push_back(grown(bounds(solid), dx_));
  }

  std::optional<std::string> misfit() {
    for (const std::size_t region : body_) {
      const CellSetN<Dim> cells(shape_as<Dim>(scene_.fluid[region].shape), dx_,
                                CellFit::exact_spacing);
      cells.for_each([&](const Point& point, const auto&) {
        if (!reason_) visit(point);
      });
      if (reason_) return reason_;
    }
    if (!touches_) return std::nullopt;
    if (auto reason = steps_apart()) return reason;
    return wrong_area();
  }

 private:
  void visit(const Point& point) {
    if (tank_) judge(faces_seen(*tank_, point, dx_), point);
    bool inside = false;
    std::vector<SeenFace> found;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      if (!boxes_[i].contains(point)) continue;
      // As an obstacle displaces fluid: what is inside is not made.
      inside = inside || signed_distance(solids_[i], point) < 0.0;
      const std::vector<SeenFace> seen = faces_seen(solids_[i], point, dx_);
      found.insert(found.end(), seen.begin(), seen.end());
    }
    if (inside) return;
    ++count_;
    judge(found, point);
  }

  void judge(const std::vector<SeenFace>& faces, const Point& point) {
    for (const SeenFace& face : faces) judge(face, point);
  }

  void judge(const SeenFace& face, const Point& point) {
    if (face.distance > 1.0 + kOffLattice) return;
    touches_ = true;
    if (reason_) return;
    const bool met = face.along_lattice && std::abs(face.distance - 0.5) < kOffLattice;
    if (met && face.backed) return;
    reason_ = fmt::format("the lattice does not fit {}{} at ({:.6g}) m",
                          met ? "the particles in " : "", face.of, fmt::join(point, ", "));
  }

  [[nodiscard]] Point phase(std::size_t region) const {
    const auto* cuboid = std::get_if<Cuboid<Dim>>(&scene_.fluid[region].shape);
    return cuboid != nullptr ? Point(cuboid->corner / dx_) : Point(Point::Zero());
  }

  [[nodiscard]] std::optional<std::string> steps_apart() const {
    for (const std::size_t region : body_) {
      const Point apart = phase(region) - phase(body_.front());
      const Point off = apart - apart.array().round().matrix();
      if (off.cwiseAbs().maxCoeff() < kOffLattice) continue;
      return fmt::format("/fluid/{} does not meet /fluid/{} on its lattice", region, body_.front());
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::string> wrong_area() const {
    const BodyFillN<Dim> fill = body_fill_of<Dim>(scene_);
    std::size_t wanted = 0;
    for (const std::size_t region : body_) wanted += fill.count(region);
    const double share = static_cast<double>(count_) / static_cast<double>(wanted) - 1.0;
    if (std::abs(share) <= kOffArea) return std::nullopt;
    return fmt::format("/fluid/{} would hold {:+.1f} % on the lattice", body_.front(), 100 * share);
  }

  const Scene& scene_;
  const Body& body_;
  double dx_;
  std::optional<TankRoomN<Dim>> tank_;
  std::vector<ShapeN<Dim>> solids_;
  std::vector<BoxN<Dim>> boxes_;
  std::size_t count_ = 0;
  bool touches_ = false;
  std::optional<std::string> reason_;
};

}  // namespace

std::optional<std::string> lattice_misfit(const Scene& scene, const Body& body) {
  return in_dimensions(scene.dimensions(),
                       [&]<int Dim>() { return FitCheck<Dim>(scene, body).misfit(); });
}

std::vector<bool> beside_misfits(const Scene& scene) {
  if (scene.obstacles.empty()) return {};
  const double reach = 1.5 * scene.method.spacing;
  std::vector<bool> beside(scene.obstacles.size());
  const std::vector<ShapeN<2>> obstacles = shapes_as<2>(scene.obstacles);
  for (const Body& body : bodies(scene)) {
    if (!lattice_misfit(scene, body)) continue;
    for (const std::size_t region : body) {
      const ShapeN<2> fluid = shape_as<2>(scene.fluid[region].shape);
      const CellSetN<2> cells(fluid, scene.method.spacing, CellFit::exact_spacing);
      for (std::size_t i = 0; i < beside.size(); ++i) {
        if (beside[i]) continue;
        const Box2 box = grown(bounds(obstacles[i]), reach);
        if (!overlap(bounds(fluid), box)) continue;
        cells.for_each([&](const Vec2& point, const auto&) {
          if (beside[i] || !box.contains(point)) return;
          beside[i] = std::abs(signed_distance(obstacles[i], point)) < reach;
        });
      }
    }
  }
  return beside;
}

}  // namespace sluice

#include "engine/scene/filling/lattice_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/filling/body_fill.hpp"
#include "engine/scene/filling/cells.hpp"
#include "engine/scene/filling/walls.hpp"
#include "engine/scene/geometry/geometry.hpp"

namespace sluice {
namespace {

// In dx: off half a spacing by less is a fit.
constexpr double kOff = 0.02;
constexpr double kAreaOff = 0.005;

/// Distance of a point from a solid's face in spacings, where it faces one within a spacing.
struct Facing {
  double distance;
  bool along_lattice;  ///< the face is horizontal or vertical
  bool backed = true;  ///< dummy particles stand dx/2 behind it and dx apart
};

bool is_whole(double cells) { return std::abs(cells - std::round(cells)) < kOff; }

/// Whether a rectangle's cells, stretched to fit, are about as large as the fluid's. Each of its
/// dummy particles has a full mass, whatever the size of its cell.
bool has_full_cells(const Rectangle& solid, double dx) {
  const auto fits = [dx](double length) {
    const double cells = static_cast<double>(whole_cells(length, dx));
    return std::abs(cells * dx / length - 1.0) <= kAreaOff;
  };
  return fits(solid.size.x()) && fits(solid.size.y());
}

void face_outline(const std::vector<Vec>& points, const Vec& point, double dx,
                  std::vector<Facing>& found) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec& a = points[i];
    const Vec edge = points[i + 1 < points.size() ? i + 1 : 0] - a;
    const double length = edge.norm();
    const double along = (point - a).dot(edge) / length;
    // One beside a corner faces none of its edges.
    if (along < 0.0 || along > length) continue;
    const Vec apart = point - a - along / length * edge;
    const bool upright = std::abs(edge.x()) < 1e-9 * length;
    const bool level = std::abs(edge.y()) < 1e-9 * length;
    // A polygon's dummy particles lie on the origin's lattice.
    const bool backed = (upright && is_whole(a.x() / dx)) || (level && is_whole(a.y() / dx));
    found.push_back({apart.norm() / dx, upright || level, backed});
  }
}

/// The faces of a solid that a point faces. A shape without a line of its own does not compile.
struct FacesSeenFrom {
  const Vec& point;
  double dx;

  std::vector<Facing> operator()(const Rectangle& s) const {
    std::vector<Facing> found = outline(as_polygon(s).points);
    for (Facing& face : found) face.backed = has_full_cells(s, dx);
    return found;
  }
  std::vector<Facing> operator()(const Polygon& s) const { return outline(s.points); }
  std::vector<Facing> operator()(const Circle& s) const { return round(s); }
  std::vector<Facing> operator()(const Ellipse& s) const { return round(s); }

  [[nodiscard]] std::vector<Facing> outline(const std::vector<Vec>& points) const {
    std::vector<Facing> found;
    face_outline(points, point, dx, found);
    return found;
  }
  [[nodiscard]] std::vector<Facing> round(const Shape& solid) const {
    return {{std::abs(signed_distance(solid, point)) / dx, false}};
  }
};

class FitCheck {
 public:
  FitCheck(const Scene& scene, const Body& body)
      : scene_(scene), body_(body), dx_(scene.method.spacing), solids_(solid_bodies(scene)) {
    for (const Shape& solid : solids_) boxes_.push_back(grown(bounds(solid), dx_));
  }

  std::optional<std::string> misfit() {
    for (const std::size_t region : body_) {
      const CellSet cells(scene_.fluid[region].shape, dx_, CellFit::exact_spacing);
      cells.for_each([&](const Vec& point, const auto&) {
        if (!reason_) visit(point);
      });
      if (reason_) return reason_;
    }
    if (!touches_) return std::nullopt;
    if (auto reason = steps_apart()) return reason;
    return wrong_area();
  }

 private:
  void visit(const Vec& point) {
    if (scene_.tank) visit_tank(point);
    bool inside = false;
    std::vector<Facing> found;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      if (!boxes_[i].contains(point)) continue;
      // As an obstacle displaces fluid: what is inside is not made.
      inside = inside || signed_distance(solids_[i], point) < 0.0;
      for (const Facing& face : std::visit(FacesSeenFrom{point, dx_}, solids_[i])) {
        found.push_back(face);
      }
    }
    if (inside) return;
    ++count_;
    for (const Facing& face : found) judge(face, point, "an obstacle or the gate");
  }

  void visit_tank(const Vec& point) {
    judge({point.x() / dx_, true}, point, "the tank's left wall");
    judge({(scene_.tank->width - point.x()) / dx_, true}, point, "the tank's right wall");
    judge({point.y() / dx_, true}, point, "the tank's floor");
    if (!scene_.tank->open_top) {
      judge({(scene_.tank->height - point.y()) / dx_, true}, point, "the tank's lid");
    }
  }

  void judge(const Facing& face, const Vec& point, std::string_view what) {
    if (face.distance > 1.0 + kOff) return;
    touches_ = true;
    if (reason_) return;
    const bool met = face.along_lattice && std::abs(face.distance - 0.5) < kOff;
    if (met && face.backed) return;
    reason_ = fmt::format("the lattice does not fit {}{} at ({:.6g}, {:.6g}) m",
                          met ? "the particles in " : "", what, point.x(), point.y());
  }

  [[nodiscard]] Vec phase(std::size_t region) const {
    const auto* rectangle = std::get_if<Rectangle>(&scene_.fluid[region].shape);
    return rectangle != nullptr ? Vec(rectangle->corner / dx_) : Vec(Vec::Zero());
  }

  [[nodiscard]] std::optional<std::string> steps_apart() const {
    for (const std::size_t region : body_) {
      const Vec apart = phase(region) - phase(body_.front());
      const Vec off = apart - apart.array().round().matrix();
      if (off.cwiseAbs().maxCoeff() < kOff) continue;
      return fmt::format("/fluid/{} does not meet /fluid/{} on its lattice", region, body_.front());
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::string> wrong_area() const {
    const BodyFill fill = body_fill_of(scene_);
    std::size_t wanted = 0;
    for (const std::size_t region : body_) wanted += fill.count(region);
    const double share = static_cast<double>(count_) / static_cast<double>(wanted) - 1.0;
    if (std::abs(share) <= kAreaOff) return std::nullopt;
    return fmt::format("/fluid/{} would hold {:+.1f} % on the lattice", body_.front(), 100 * share);
  }

  const Scene& scene_;
  const Body& body_;
  double dx_;
  std::vector<Shape> solids_;
  std::vector<Box> boxes_;
  std::size_t count_ = 0;
  bool touches_ = false;
  std::optional<std::string> reason_;
};

}  // namespace

std::vector<Body> bodies(const Scene& scene) {
  const std::size_t count = scene.fluid.size();
  std::vector<std::size_t> owner(count);
  for (std::size_t i = 0; i < count; ++i) {
    owner[i] = i;
    const Box box = grown(bounds(scene.fluid[i].shape), 1.001 * scene.method.spacing);
    for (std::size_t other = 0; other < i; ++other) {
      const bool apart = !overlap(bounds(scene.fluid[other].shape), box);
      if (apart || owner[other] == owner[i]) continue;
      std::replace(owner.begin(), owner.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   std::max(owner[other], owner[i]), std::min(owner[other], owner[i]));
    }
  }
  std::vector<Body> result;
  for (std::size_t first = 0; first < count; ++first) {
    Body body;
    for (std::size_t i = 0; i < count; ++i) {
      if (owner[i] == first) body.push_back(i);
    }
    if (!body.empty()) result.push_back(std::move(body));
  }
  return result;
}

std::optional<std::string> lattice_misfit(const Scene& scene, const Body& body) {
  return FitCheck(scene, body).misfit();
}

std::vector<bool> beside_misfits(const Scene& scene) {
  const double reach = 1.5 * scene.method.spacing;
  std::vector<bool> beside(scene.obstacles.size());
  if (beside.empty()) return beside;
  for (const Body& body : bodies(scene)) {
    if (!lattice_misfit(scene, body)) continue;
    for (const std::size_t region : body) {
      const CellSet cells(scene.fluid[region].shape, scene.method.spacing, CellFit::exact_spacing);
      for (std::size_t i = 0; i < beside.size(); ++i) {
        if (beside[i]) continue;
        const Box box = grown(bounds(scene.obstacles[i]), reach);
        if (!overlap(bounds(scene.fluid[region].shape), box)) continue;
        cells.for_each([&](const Vec& point, const auto&) {
          if (beside[i] || !box.contains(point)) return;
          beside[i] = std::abs(signed_distance(scene.obstacles[i], point)) < reach;
        });
      }
    }
  }
  return beside;
}

}  // namespace sluice

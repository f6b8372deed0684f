#include "engine/scene/solids.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/geometry.hpp"

namespace sluice {
namespace {

constexpr double kTiny = 1e-9;        // of the spacing: gaps and depths of rounding
constexpr double kOffOutline = 1e-3;  // of the spacing: a point on the side of the outline
constexpr std::size_t kStepsAcross =
    64;                              // of a search; nothing thinner than a part of it is missed
constexpr std::size_t kFewest = 32;  // points of a curved outline
constexpr std::size_t kFewestOnSide = 4;
constexpr double kSteep = 0.18;  // the tangent of ten degrees

void add_side(std::vector<OutlinePoint>& points, const Vec& a, const Vec& b, bool left_is_out,
              std::size_t count) {
  const Vec along = (b - a).normalized();
  const Vec left(-along.y(), along.x());
  for (std::size_t k = 0; k < count; ++k) {
    const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    points.push_back({a + part * (b - a), left_is_out ? left : Vec(-left)});
  }
}

std::vector<OutlinePoint> round_outline(const Vec& center, const Vec& axes, std::size_t count) {
  std::vector<OutlinePoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const Vec unit(std::cos(angle), std::sin(angle));
    points.push_back({center + axes.cwiseProduct(unit), unit.cwiseQuotient(axes).normalized()});
  }
  return points;
}

std::vector<OutlinePoint> straight_outline(const std::vector<Vec>& corners, double step) {
  double twice_area = 0.0;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec a = corners[i] - corners[0];
    const Vec b = corners[(i + 1) % n] - corners[0];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  std::vector<OutlinePoint> points;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec& a = corners[i];
    const Vec& b = corners[(i + 1) % n];
    const double wanted = std::ceil((b - a).norm() / step);
    add_side(points, a, b, twice_area < 0,
             std::max(kFewestOnSide, static_cast<std::size_t>(wanted)));
  }
  return points;
}

struct OutlineOf {
  double step;

  std::vector<OutlinePoint> operator()(const Circle& s) const {
    return (*this)(Ellipse{s.center, Vec::Constant(s.radius)});
  }
  std::vector<OutlinePoint> operator()(const Ellipse& s) const {
    const auto wanted = static_cast<std::size_t>(std::ceil(perimeter(s) / step));
    return round_outline(s.center, s.semi_axes, std::max(kFewest, wanted));
  }
  std::vector<OutlinePoint> operator()(const Rectangle& s) const {
    return straight_outline(
        {s.corner, s.corner + Vec(s.size.x(), 0), s.corner + s.size, s.corner + Vec(0, s.size.y())},
        step);
  }
  std::vector<OutlinePoint> operator()(const Polygon& s) const {
    return straight_outline(s.points, step);
  }
};

/// How narrow a part is along its length, unless it tapers: between the quartiles a wedge grows by
/// 3 and the gap under a circle by 9, and the rounded edge of a body grows steeply.
std::optional<Narrow> narrow_run(std::vector<Narrow> run) {
  double length = 0.0;
  for (std::size_t k = 1; k < run.size(); ++k) length += (run[k].place - run[k - 1].place).norm();
  std::sort(run.begin(), run.end(),
            [](const Narrow& a, const Narrow& b) { return a.width < b.width; });
  const Narrow& lower = run[run.size() / 4];
  const Narrow& upper = run[(3 * run.size()) / 4];
  const bool wedge = lower.width < 0.5 * upper.width;
  const bool edge = upper.width - lower.width > kSteep * 0.5 * length;
  if (wedge || edge) return std::nullopt;
  return lower;
}

/// The narrowest of the runs of neighbours that have a width; `widths` goes round.
std::optional<Narrow> narrowest(const std::vector<std::optional<Narrow>>& widths) {
  const auto wide = std::find(widths.begin(), widths.end(), std::nullopt);
  const auto start = static_cast<std::size_t>(wide - widths.begin());
  std::optional<Narrow> best;
  std::vector<Narrow> run;
  const auto end_run = [&] {
    const auto found = run.empty() ? std::nullopt : narrow_run(run);
    if (found && (!best || found->width < best->width)) best = found;
    run.clear();
  };
  for (std::size_t k = 0; k < widths.size(); ++k) {
    const auto& each = widths[(start + k) % widths.size()];
    if (each) {
      run.push_back(*each);
    } else {
      end_run();
    }
  }
  end_run();
  return best;
}

}  // namespace

Solids::Solids(const Scene& scene) : tank_(scene.tank), slack_(kTiny * scene.method.spacing) {
  for (const Shape& shape : scene.obstacles) {
    Box box = bounds(shape);
    box.min.array() -= slack_;
    box.max.array() += slack_;
    bodies_.push_back({&shape, box});
  }
}

double Solids::depth_in_walls(const Vec& p) const {
  if (!tank_) return 0.0;
  const double aside = std::max(-p.x(), p.x() - tank_->width);
  const double over = p.y() - tank_->height;
  // Over the rim of an open tank is the air; a wall is left upwards too.
  if (tank_->open_top) {
    if (over >= 0) return 0.0;
    return std::max({0.0, -p.y(), std::min(aside, -over)});
  }
  return std::max({0.0, -p.y(), aside, over});
}

bool Solids::holds(const Vec& p) const {
  if (depth_in_walls(p) > 0.0) return true;
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    return body.box.contains(p) &&
           (contains(*body.shape, p) || signed_distance(*body.shape, p) <= slack_);
  });
}

double Solids::depth(const Vec& p) const {
  double most = depth_in_walls(p);
  for (const Body& body : bodies_) {
    if (body.box.contains(p)) most = std::max(most, -signed_distance(*body.shape, p));
  }
  return most;
}

std::optional<double> Solids::reach(const Vec& from, const Vec& direction, double most,
                                    double step) const {
  const bool inside = holds(from);
  double near = 0.0;
  for (double far = step; near < most; near = far, far += step) {
    if (holds(from + far * direction) == inside) continue;
    double changed = far;
    while (changed - near > kTiny * step) {
      const double middle = 0.5 * (near + changed);
      (holds(from + middle * direction) == inside ? near : changed) = middle;
    }
    return changed < most ? std::optional(changed) : std::nullopt;
  }
  return std::nullopt;
}

std::vector<OutlinePoint> outline(const Shape& shape, double step, std::size_t most) {
  return std::visit(OutlineOf{std::max(step, perimeter(shape) / static_cast<double>(most))}, shape);
}

std::optional<Narrow> narrow_part(const Solids& solids, const std::vector<OutlinePoint>& outline,
                                  Across across, double most, double spacing) {
  const double off = kOffOutline * spacing;
  std::vector<std::optional<Narrow>> widths;
  for (const OutlinePoint& point : outline) {
    widths.emplace_back();
    const Vec before = point.place + off * point.out;
    const Vec behind = point.place - off * point.out;
    // Covered by another solid, or by the outline itself where it turns sharply.
    if (solids.holds(before) || !solids.holds(behind)) continue;
    const bool solid = across == Across::solid;
    const auto width = solids.reach(solid ? behind : before, solid ? Vec(-point.out) : point.out,
                                    most - off, most / kStepsAcross);
    if (width) widths.back() = Narrow{*width + off, point.place};
  }
  return narrowest(widths);
}

}  // namespace sluice

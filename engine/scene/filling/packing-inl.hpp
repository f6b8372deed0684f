#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "engine/scene/filling/bins.hpp"
#include "engine/scene/filling/packing.hpp"
#include "engine/space/space_traits.hpp"

namespace sluice {
namespace packing {

// NeighbourLists hold pairs up to this much beyond the reach, in dx, and serve until a point moved
// by half.
inline constexpr double kSkin = 0.4;
inline constexpr double kTimeStep = 0.7;     // dx
inline constexpr double kDamping = 0.25;     // share of the velocity lost in a step
inline constexpr double kLongestMove = 0.1;  // dx
inline constexpr double kEnough = 6e-4;      // of the residual

/// Neighbours of each point, one after the other.
struct NeighbourLists {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> members;
};

/// Points and all that is needed to move them; lengths in dx.
template <int Dim>
class Packing {
 public:
  using Point = VecN<Dim>;

  Packing(std::vector<Point>& points, const std::vector<FixedPointN<Dim>>& fixed)
      : points_(points), fixed_(fixed), velocity_(points.size(), Point::Zero()) {
    for (const FixedPointN<Dim>& each : fixed) fixed_places_.push_back(each.position);
  }

  /// One iteration; the residual before it.
  double step() {
    if (stale()) list_neighbours();
    push_.assign(points_.size(), Point::Zero());
    sum_pairs();
    sum_fixed();
    double sum = 0.0;
    std::size_t beside = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      sum += push_[i].squaredNorm();
      if (beside_.begin[i] < beside_.begin[i + 1]) ++beside;
      move(i);
    }
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(beside, 1)));
  }

 private:
  static constexpr double kH = 1.5;
  static constexpr double kReach = 2 * kH;

  /// -V grad W over the distance: 5 norm h^-(d+2) (1 - R/2)^3.
  static double slope(double distance_sq) {
    constexpr double kScale = 5.0 * SpaceTraits<Dim>::pi_times_wendland_c2_norm /
                              times_power<Dim + 2>(std::numbers::pi, kH);
    const double rest = 1.0 - std::sqrt(distance_sq) / kReach;
    return kScale * rest * rest * rest;
  }

  void sum_pairs() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t n = pairs_.begin[i]; n < pairs_.begin[i + 1]; ++n) {
        const std::uint32_t j = pairs_.members[n];
        const Point apart = points_[i] - points_[j];
        const double distance_sq = apart.squaredNorm();
        if (distance_sq >= kReach * kReach) continue;
        const Point push = slope(distance_sq) * apart;
        push_[i] += push;
        push_[j] -= push;
      }
    }
  }

  void sum_fixed() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t n = beside_.begin[i]; n < beside_.begin[i + 1]; ++n) {
        const FixedPointN<Dim>& other = fixed_[beside_.members[n]];
        const Point apart = points_[i] - other.position;
        const double distance_sq = apart.squaredNorm();
        if (distance_sq >= kReach * kReach) continue;
        push_[i] += other.volume * slope(distance_sq) * apart;
      }
    }
  }

  void move(std::size_t i) {
    velocity_[i] = (1.0 - kDamping) * (velocity_[i] + kTimeStep * push_[i]);
    Point way = kTimeStep * velocity_[i];
    const double length = way.norm();
    if (length > kLongestMove) way *= kLongestMove / length;
    points_[i] += way;
  }

  [[nodiscard]] bool stale() const {
    if (listed_.empty()) return true;
    const double limit = kSkin / 2 - kLongestMove;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if ((points_[i] - listed_[i]).squaredNorm() > limit * limit) return true;
    }
    return false;
  }

  void list_neighbours() {
    listed_ = points_;
    const double within = kReach + kSkin;
    const auto close = [&](const Point& a, const Point& b) {
      return (a - b).squaredNorm() < within * within;
    };
    const Bins<Dim> bins(points_, within), fixed_bins(fixed_places_, within);
    pairs_ = {{0}, {}};
    beside_ = {{0}, {}};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      bins.near(points_[i], [&](std::uint32_t j) {
        if (j > i && close(points_[i], points_[j])) pairs_.members.push_back(j);
      });
      fixed_bins.near(points_[i], [&](std::uint32_t j) {
        if (close(points_[i], fixed_places_[j])) beside_.members.push_back(j);
      });
      pairs_.begin.push_back(pairs_.members.size());
      beside_.begin.push_back(beside_.members.size());
    }
  }

  std::vector<Point>& points_;
  const std::vector<FixedPointN<Dim>>& fixed_;
  std::vector<Point> fixed_places_;
  std::vector<Point> velocity_;
  std::vector<Point> push_;
  std::vector<Point> listed_;
  NeighbourLists pairs_;
  NeighbourLists beside_;
};

}  // namespace packing

template <int Dim>
PackingReport pack(std::vector<VecN<Dim>>& points, const std::vector<FixedPointN<Dim>>& fixed,
                   double spacing) {
  PackingReport report;
  report.particles = points.size();
  if (points.empty()) return report;
  // Lengths in dx about a near origin.
  const VecN<Dim> origin = points.front();
  for (VecN<Dim>& point : points) point = (point - origin) / spacing;
  std::vector<FixedPointN<Dim>> scaled = fixed;
  for (FixedPointN<Dim>& each : scaled) each.position = (each.position - origin) / spacing;

  packing::Packing<Dim> moving(points, scaled);
  do {
    report.residual = moving.step();
    ++report.iterations;
  } while (report.residual > packing::kEnough && report.iterations < kMaxPackingIterations);
  for (VecN<Dim>& point : points) point = origin + spacing * point;
  return report;
}

}  // namespace sluice

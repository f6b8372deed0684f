#include "engine/scene/filling/packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace sluice {
namespace {

// NeighbourLists hold pairs up to this much beyond the reach, in dx, and serve until a point moved
// by half.
constexpr double kSkin = 0.4;
constexpr double kTimeStep = 0.7;     // dx
constexpr double kDamping = 0.25;     // share of the velocity lost in a step
constexpr double kLongestMove = 0.1;  // dx
constexpr double kEnough = 6e-4;      // of the residual

/// Points in square cells, so that those near a place are found.
class Bins {
 public:
  Bins(std::span<const Vec> points, double size) : size_(size) {
    if (points.empty()) return;
    Vec low = points.front(), high = points.front();
    for (const Vec& point : points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
    low_ = low;
    // A long thin body at an angle: cells grow rather than their number.
    const double most = 4.0 * static_cast<double>(points.size()) + 1024.0;
    const Vec spread = high - low;
    while ((spread.x() / size_ + 1) * (spread.y() / size_ + 1) > most) size_ *= 1.25;
    columns_ = cell(spread.x()) + 1;
    rows_ = cell(spread.y()) + 1;
    begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (const Vec& point : points) ++begin_[index(point) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    members_.resize(points.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      members_[next[index(points[i])]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// Calls f(index) for all points in the nine cells around a place.
  template <class F>
  void near(const Vec& place, const F& f) const {
    if (members_.empty()) return;
    const std::int64_t column = cell(place.x() - low_.x()), row = cell(place.y() - low_.y());
    for (std::int64_t r = std::max<std::int64_t>(row - 1, 0); r <= std::min(row + 1, rows_ - 1);
         ++r) {
      const std::int64_t first = std::max<std::int64_t>(column - 1, 0);
      const std::int64_t last = std::min(column + 1, columns_ - 1);
      if (first > last) continue;
      const auto from = begin_[static_cast<std::size_t>(r * columns_ + first)];
      const auto to = begin_[static_cast<std::size_t>(r * columns_ + last) + 1];
      for (std::uint32_t i = from; i < to; ++i) f(members_[i]);
    }
  }

 private:
  [[nodiscard]] std::int64_t cell(double distance) const {
    return static_cast<std::int64_t>(std::floor(distance / size_));
  }
  [[nodiscard]] std::size_t index(const Vec& point) const {
    return static_cast<std::size_t>(cell(point.y() - low_.y()) * columns_ +
                                    cell(point.x() - low_.x()));
  }

  double size_;
  Vec low_ = Vec::Zero();
  std::int64_t columns_ = 0;
  std::int64_t rows_ = 0;
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> members_;
};

/// Neighbours of each point, one after the other.
struct NeighbourLists {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> members;
};

/// Points and all that is needed to move them; lengths in dx.
class Packing {
 public:
  Packing(std::vector<Vec>& points, const std::vector<FixedPoint>& fixed)
      : points_(points), fixed_(fixed), velocity_(points.size(), Vec::Zero()) {
    for (const FixedPoint& each : fixed) fixed_places_.push_back(each.position);
  }

  /// One iteration; the residual before it.
  double step() {
    if (stale()) list_neighbours();
    push_.assign(points_.size(), Vec::Zero());
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

  /// -V grad W over the distance: 35/(4 pi h^4) (1 - R/2)^3.
  static double slope(double distance_sq) {
    constexpr double kScale = 35.0 / (4.0 * std::numbers::pi * kH * kH * kH * kH);
    const double rest = 1.0 - std::sqrt(distance_sq) / kReach;
    return kScale * rest * rest * rest;
  }

  void sum_pairs() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t n = pairs_.begin[i]; n < pairs_.begin[i + 1]; ++n) {
        const std::uint32_t j = pairs_.members[n];
        const Vec apart = points_[i] - points_[j];
        const double distance_sq = apart.squaredNorm();
        if (distance_sq >= kReach * kReach) continue;
        const Vec push = slope(distance_sq) * apart;
        push_[i] += push;
        push_[j] -= push;
      }
    }
  }

  void sum_fixed() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t n = beside_.begin[i]; n < beside_.begin[i + 1]; ++n) {
        const FixedPoint& other = fixed_[beside_.members[n]];
        const Vec apart = points_[i] - other.position;
        const double distance_sq = apart.squaredNorm();
        if (distance_sq >= kReach * kReach) continue;
        push_[i] += other.volume * slope(distance_sq) * apart;
      }
    }
  }

  void move(std::size_t i) {
    velocity_[i] = (1.0 - kDamping) * (velocity_[i] + kTimeStep * push_[i]);
    Vec way = kTimeStep * velocity_[i];
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
    const auto close = [&](const Vec& a, const Vec& b) {
      return (a - b).squaredNorm() < within * within;
    };
    const Bins bins(points_, within), fixed_bins(fixed_places_, within);
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

  std::vector<Vec>& points_;
  const std::vector<FixedPoint>& fixed_;
  std::vector<Vec> fixed_places_;
  std::vector<Vec> velocity_;
  std::vector<Vec> push_;
  std::vector<Vec> listed_;
  NeighbourLists pairs_;
  NeighbourLists beside_;
};

}  // namespace

PackingReport pack(std::vector<Vec>& points, const std::vector<FixedPoint>& fixed, double spacing) {
  PackingReport report;
  report.particles = points.size();
  if (points.empty()) return report;
  // Lengths in dx about a near origin.
  const Vec origin = points.front();
  for (Vec& point : points) point = (point - origin) / spacing;
  std::vector<FixedPoint> scaled = fixed;
  for (FixedPoint& each : scaled) each.position = (each.position - origin) / spacing;

  Packing packing(points, scaled);
  do {
    report.residual = packing.step();
    ++report.iterations;
  } while (report.residual > kEnough && report.iterations < kMaxPackingIterations);
  for (Vec& point : points) point = origin + spacing * point;
  return report;
}

}  // namespace sluice

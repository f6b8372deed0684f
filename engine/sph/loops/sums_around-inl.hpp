// Sums over the particles around a point. Included once per SIMD target.

#if defined(SLUICE_SUMS_AROUND_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SLUICE_SUMS_AROUND_INL
#undef SLUICE_SUMS_AROUND_INL
#else
#define SLUICE_SUMS_AROUND_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/sph/loops/boxes-inl.hpp"
#include "engine/sph/loops/state-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The first cluster of a row that reaches `left`, or its end. Clusters lie about evenly along a
/// row, so that it is mostly in the vector that is tried first.
template <int Dim>
std::uint32_t first_near(const BoxesView<Dim>& boxes, const RowPart& row) {
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const float* const reach = boxes.x_max_before;
  const float low = boxes.x_min_after[row.begin];
  const float length = reach[row.end - 1] - low;
  const auto count = static_cast<float>(row.end - row.begin);
  const float guess = (row.left - low) / length * count - 0.5F * static_cast<float>(lanes);
  // Written so that no number, too, is a guess within the row.
  const float most = count - 1.0F;
  const auto at =
      row.begin + static_cast<std::uint32_t>(guess > 0.0F ? std::min(guess, most) : 0.0F);
  if (at == row.begin || reach[at - 1] < row.left) {
    const auto found = hn::FindFirstTrue(d, hn::LoadU(d, reach + at) >= hn::Set(d, row.left));
    if (found >= 0) return std::min(row.end, at + static_cast<std::uint32_t>(found));
  }
  const float* const first = std::lower_bound(reach + row.begin, reach + row.end, row.left);
  return static_cast<std::uint32_t>(first - reach);
}

/// Clusters listed before they are summed over: of some rows, so that the two loops seldom end.
constexpr std::size_t kListed = 64;

/// Calls body(clusters) for those near the point, in memory order.
template <int Dim, class Body>
HWY_INLINE void for_clusters_around(const Surroundings<Dim>& around, const Body& body) {
  const hn::CappedTag<float, kTail> d;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  const BoxesView<Dim>& boxes = around.boxes;
  std::uint32_t listed[kListed + kTail];
  std::size_t count = 0;
  for (const RowPart& row : around.rows) {
    const auto left = hn::Set(d, row.left);
    const auto right = hn::Set(d, row.right);
    for (std::uint32_t j = first_near(boxes, row); j < row.end; j += lanes) {
      if (boxes.x_min_after[j] > row.right) break;
      count += list_slots(d, clusters_within(d, boxes, j, row.end, left, right), j, listed + count);
      if (count >= kListed) {
        body(std::span<const std::uint32_t>(listed, count));
        count = 0;
      }
    }
  }
  body(std::span<const std::uint32_t>(listed, count));
}

template <class Shape, int Dim>
PointSums sum_around(const ParticlesN<Dim>& p, const Surroundings<Dim>& around) {
  const State d;
  const StateVec inverse_h = hn::Set(d, 1.0 / around.smoothing_length);
  const auto point = array_of<Dim>([&](auto axis) HWY_ATTR {
    return hn::Set(d, around.point[static_cast<Eigen::Index>(axis)]);
  });
  const StateVec rho_0 = hn::Set(d, around.reference_density);
  StateVec kernel = hn::Zero(d);
  StateVec excess = hn::Zero(d);
  StateVec volumes = hn::Zero(d);
  const auto add = [&](std::size_t s) HWY_ATTR {
    const auto used = hn::LoadU(d, p.id.data() + s) >= hn::Zero(d);
    const auto off = array_of<Dim>([&](auto axis) HWY_ATTR {
      return (hn::LoadU(d, p.position[axis].data() + s) - point[axis]) * inverse_h;
    });
    const StateVec w = hn::IfThenElseZero(used, Shape::value(d, plain_dot(off, off)));
    const StateVec e = hn::IfThenElseZero(used, hn::LoadU(d, p.density_excess.data() + s));
    kernel = kernel + w;
    excess = excess + w * e;
    volumes = volumes + w / (rho_0 + e);
  };
  for_clusters_around(around, [&](std::span<const std::uint32_t> clusters) HWY_ATTR {
    for (const std::uint32_t cluster : clusters) {
      const std::size_t first = kCluster * cluster;
      for (std::size_t s = first; s < first + kCluster; s += hn::Lanes(d)) add(s);
    }
  });
  return {hn::GetLane(hn::SumOfLanes(d, kernel)), hn::GetLane(hn::SumOfLanes(d, excess)),
          hn::GetLane(hn::SumOfLanes(d, volumes))};
}

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

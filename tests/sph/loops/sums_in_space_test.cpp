// Order, boxes, lists and sums in the plane and in space against plain double loops over all pairs,
// on every SIMD target of this machine.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/sph/loops/sums_in_space_test.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include "engine/sph/loops/sweeps-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sluice::HWY_NAMESPACE {

/// The loops of a scheme with eq. 8 and a viscous stress.
template <typename T, int Dim>
void fill_viscous(Sweeps<T, Dim>& out) {
  using Eq8 = Form<ArtificialViscosity, 0>;
  using Stress = Form<LaminarViscosity, 0>;
  out.density_and_acceleration =
      &sum_rates<WendlandShape, RateSums<Dim, Sums::both, false, Eq8, Stress>, T, Dim>;
  out.acceleration =
      &sum_rates<WendlandShape, RateSums<Dim, Sums::acceleration, false, Eq8, Stress>, T, Dim>;
  out.density_and_shift =
      &sum_rates<WendlandShape, RateSums<Dim, Sums::density, true, Eq8, Stress>, T, Dim>;
  out.search = &search_boxes<Dim>;
  out.prune = &prune_list<T, Dim>;
}

void fill_viscous_2_float(Sweeps<float, 2>& out) { fill_viscous(out); }
void fill_viscous_3_float(Sweeps<float, 3>& out) { fill_viscous(out); }
void fill_viscous_2_double(Sweeps<double, 2>& out) { fill_viscous(out); }
void fill_viscous_3_double(Sweeps<double, 3>& out) { fill_viscous(out); }

}  // namespace sluice::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/sph/loops/simd_target.hpp"
#include "engine/sph/pairs/chunk_sums.hpp"
#include "engine/sph/pairs/grid-inl.hpp"
#include "engine/sph/pairs/layout-inl.hpp"
#include "engine/sph/solver/cluster_bounds-inl.hpp"
#include "engine/sph/solver/neighbours-inl.hpp"
#include "tests/space/dimensions.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {

HWY_EXPORT(fill_viscous_2_float);
HWY_EXPORT(fill_viscous_3_float);
HWY_EXPORT(fill_viscous_2_double);
HWY_EXPORT(fill_viscous_3_double);

namespace {

template <typename T, int Dim>
Sweeps<T, Dim> viscous_sweeps(const std::string& target) {
  Sweeps<T, Dim> out;
  with_simd_target(target, [&] {
    if constexpr (std::is_same_v<T, float>) {
      if constexpr (Dim == 2) HWY_DYNAMIC_DISPATCH(fill_viscous_2_float)(out);
      if constexpr (Dim == 3) HWY_DYNAMIC_DISPATCH(fill_viscous_3_float)(out);
    } else {
      if constexpr (Dim == 2) HWY_DYNAMIC_DISPATCH(fill_viscous_2_double)(out);
      if constexpr (Dim == 3) HWY_DYNAMIC_DISPATCH(fill_viscous_3_double)(out);
    }
  });
  return out;
}

constexpr double kAlpha = 0.3;
constexpr double kEpsilon = 0.01;
constexpr double kTwoNu = 0.2;

/// In units of h, c and rho_0.
template <int Dim>
struct Points {
  std::array<std::vector<double>, Dim> position, velocity;
  std::vector<double> excess, id;

  [[nodiscard]] std::size_t size() const { return id.size(); }
};

template <int Dim>
VecN<Dim> of(const std::array<std::vector<double>, Dim>& vectors, std::size_t i) {
  return place_in<Dim>(spans_of<Dim>(vectors), i);
}

/// `count` points within 3 h of a place along each axis.
template <int Dim>
void scatter(Dice& dice, const VecN<Dim>& middle, int count, Points<Dim>& points) {
  for (int n = 0; n < count; ++n) {
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      const double from = middle[static_cast<Eigen::Index>(axis)];
      points.position[axis].push_back(from + dice.between(-3.0, 3.0));
      points.velocity[axis].push_back(dice.between(-0.2, 0.2));
    }
    points.excess.push_back(dice.between(-0.1, 0.1));
    points.id.push_back(static_cast<double>(points.id.size()));
  }
}

/// The sums of a point, before their common scale.
template <int Dim>
struct PointRates {
  double density = 0.0;
  VecN<Dim> acceleration = VecN<Dim>::Zero();
  VecN<Dim> gradient = VecN<Dim>::Zero();  ///< sum_j V_j g X_ij
  double trace = 0.0;                      ///< sum_j V_j g |X_ij|^2
};

/// eqs. 4, 5 and 8, the viscous stress and the sums of shifting, as they are written.
template <int Dim>
std::vector<PointRates<Dim>> plain_sums(const Points<Dim>& p) {
  std::vector<PointRates<Dim>> rates(p.size());
  const auto pressure_term = [&](std::size_t i) {
    return p.excess[i] / std::pow(1.0 + p.excess[i], 2);
  };
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < p.size(); ++j) {
      const VecN<Dim> x_ij = of<Dim>(p.position, i) - of<Dim>(p.position, j);
      const VecN<Dim> v_ij = of<Dim>(p.velocity, i) - of<Dim>(p.velocity, j);
      const double g = std::pow(std::max(1.0 - 0.5 * x_ij.norm(), 0.0), 3);
      const double volume_j = 1.0 / (1.0 + p.excess[j]);
      const double mean_density = 1.0 + 0.5 * (p.excess[i] + p.excess[j]);
      const double approach = std::min(v_ij.dot(x_ij), 0.0);
      const double viscous = -kAlpha * approach / (mean_density * (x_ij.squaredNorm() + kEpsilon));
      rates[i].density -= volume_j * g * (1.0 + p.excess[i]) * v_ij.dot(x_ij);
      rates[i].acceleration +=
          g * ((pressure_term(i) + pressure_term(j) + viscous) * x_ij - kTwoNu * v_ij);
      rates[i].gradient += volume_j * g * x_ij;
      rates[i].trace += volume_j * g * x_ij.squaredNorm();
    }
  }
  return rates;
}

/// Points in the engine's order with their lists.
template <typename T, int Dim>
class Ordered {
 public:
  Ordered(const BoxN<Dim>& domain, const Points<Dim>& points, const Sweeps<T, Dim>& sweeps)
      : team_(2),
        grid_(domain, 0.7, 1.0, points.size()),
        sweeps_(sweeps),
        shift_(static_cast<T>(grid_.origin_cell_size())) {
    order_ = sort_into_clusters<Dim>(team_, grid_, spans_of<Dim>(points.position), points.id);
    const std::size_t slots = layout().slots();
    std::array<std::vector<double>, Dim> position;
    for (std::vector<double>& along : position) along.resize(slots, 0.0);
    std::vector<double> id(slots, kNobody);
    for (std::size_t s = 0; s < slots; ++s) {
      const std::uint32_t i = order_.source[s];
      if (i == Order::kEmpty) continue;
      for (std::size_t axis = 0; axis < Dim; ++axis) position[axis][s] = points.position[axis][i];
      id[s] = points.id[i];
    }
    bounds_.assign_origin_cells(team_, grid_, layout(), spans_of<Dim>(position), id);
    write(points);
    list();
  }

  /// For each point the sums that `loop` leaves for it.
  [[nodiscard]] std::vector<PointRates<Dim>> sums(typename Sweeps<T, Dim>::Sweep loop,
                                                  const SumBlocks<Dim>& blocks,
                                                  std::size_t points) {
    TermConstants<T, Dim> constants;
    std::get<ArtificialViscosity::Constants<T>>(constants.in_fluid) = {
        static_cast<T>(kAlpha), static_cast<T>(kEpsilon), T{0}};
    std::get<LaminarViscosity::Constants<T>>(constants.in_fluid) = {static_cast<T>(kTwoNu)};
    constants.origin_shift = shift_;
    sums_.place(list_, layout().chunk, blocks.stride);
    for (std::size_t n = 0; n < layout().chunks(); ++n) {
      SweepTask<T, Dim> task;
      task.self = task.fluid = arrays_.view();
      task.to_fluid = &list_.chunks[n];
      task.first_cluster = layout().chunk_begin(n);
      task.clusters = layout().chunk_begin(n + 1) - task.first_cluster;
      task.constants = &constants;
      task.sums = sums_.of(n);
      loop(task);
    }
    std::vector<PointRates<Dim>> rates(points);
    for (std::size_t s = 0; s < layout().slots(); ++s) {
      if (order_.source[s] == Order::kEmpty) continue;
      PointRates<Dim>& rate = rates[order_.source[s]];
      rate.density = sum_of(s, blocks, blocks.density);
      rate.trace = sum_of(s, blocks, blocks.trace);
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        rate.acceleration[static_cast<Eigen::Index>(axis)] = sum_of(s, blocks, blocks.vector[axis]);
      }
      rate.gradient = rate.acceleration;
    }
    return rates;
  }

 private:
  [[nodiscard]] const Layout& layout() const { return order_.layout; }

  void write(const Points<Dim>& points) {
    arrays_.resize(layout().slots());
    for (std::size_t s = 0; s < layout().slots(); ++s) {
      const std::uint32_t i = order_.source[s];
      const bool used = i != Order::kEmpty;
      const VecN<Dim> origin = grid_.origin_cell_center(bounds_.origin_cell[s / kCluster]);
      for (std::size_t axis = 0; axis < Dim; ++axis) {
        const double from = origin[static_cast<Eigen::Index>(axis)];
        arrays_.position(axis)[s] =
            static_cast<T>(used ? points.position[axis][i] - from : nowhere(s));
        arrays_.field(PairFields<Dim>::velocity + axis)[s] =
            static_cast<T>(used ? points.velocity[axis][i] : 0.0);
      }
      const double excess = used ? points.excess[i] : 0.0;
      arrays_.excess()[s] = static_cast<T>(excess);
      arrays_.volume()[s] = static_cast<T>(1.0 / (1.0 + excess));
      arrays_.pressure_term()[s] = static_cast<T>(excess / std::pow(1.0 + excess, 2));
    }
  }

  void list() {
    ListPaths<T, Dim> paths;
    paths.resize(layout().slots());
    paths.begin(arrays_, 0, layout().slots());
    bounds_.resize(layout());
    bounds_.assign_boxes(0, layout().clusters(), grid_, 1.0, paths.view());
    bounds_.assign_rows(team_, layout());
    const PairSet<T, Dim> set{layout(), bounds_, paths.view()};
    const std::array wanted{NewPairList<T, Dim>{&set, &set, &list_}};
    const PairRange<T, Dim> range{static_cast<T>(2.001), shift_, grid_.has_one_origin_cell()};
    build_pair_lists<T, Dim>(team_, sweeps_, range, wanted);
  }

  /// What a chunk has for its own slot, and what all others have for it.
  [[nodiscard]] double sum_of(std::size_t slot, const SumBlocks<Dim>& blocks, std::size_t block) {
    const std::size_t cluster = slot / kCluster;
    const std::size_t chunk = cluster / layout().chunk;
    const std::size_t own = cluster % layout().chunk;
    const auto at = [&](std::size_t from, std::size_t place) {
      return static_cast<double>(
          sums_.of(from)[blocks.stride * place + kCluster * block + slot % kCluster]);
    };
    double sum = at(chunk, own);
    for (const Contribution& each : sums_.contributions(chunk)) {
      if (each.cluster == own) sum += at(each.chunk, each.place);
    }
    return sum;
  }

  ThreadTeam team_;
  Grid<Dim> grid_;
  Sweeps<T, Dim> sweeps_;
  OriginShift<T, Dim> shift_;
  Order order_;
  ClusterBounds<Dim> bounds_;
  PairArrays<T, Dim> arrays_;
  PairList list_;
  ChunkSums<T> sums_;
};

template <typename T, int Dim>
void expect_sums(const BoxN<Dim>& domain, const Points<Dim>& points, double eps) {
  const std::vector<PointRates<Dim>> expected = plain_sums(points);
  for (const std::string& target : simd_targets()) {
    const Sweeps<T, Dim> sweeps = viscous_sweeps<T, Dim>(target);
    Ordered<T, Dim> ordered(domain, points, sweeps);
    const std::size_t count = points.size();
    const auto both = ordered.sums(sweeps.density_and_acceleration, kRateSums<Dim>, count);
    const auto alone = ordered.sums(sweeps.acceleration, kAccelerationSums<Dim>, count);
    const auto shift = ordered.sums(sweeps.density_and_shift, kDensityAndShiftingSums<Dim>, count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::string what = target + ", point " + std::to_string(i);
      EXPECT_NEAR(both[i].density, expected[i].density, eps) << what;
      EXPECT_NEAR(shift[i].density, expected[i].density, eps) << what;
      EXPECT_NEAR(shift[i].trace, expected[i].trace, eps) << what;
      EXPECT_NEAR((both[i].acceleration - expected[i].acceleration).norm(), 0.0, eps) << what;
      EXPECT_NEAR((alone[i].acceleration - expected[i].acceleration).norm(), 0.0, eps) << what;
      EXPECT_NEAR((shift[i].gradient - expected[i].gradient).norm(), 0.0, eps) << what;
      if (::testing::Test::HasFailure()) return;
    }
  }
}

/// Sums are of some tens of summands below 1; places in single precision resolve 3e-5 h where there
/// are many origin cells.
template <int Dim>
void expect_sums_in_both(const BoxN<Dim>& domain, const Points<Dim>& points, double eps_float) {
  expect_sums<double, Dim>(domain, points, 1e-11);
  expect_sums<float, Dim>(domain, points, eps_float);
}

template <class Dimension>
class SumsIn : public ::testing::Test {};
TYPED_TEST_SUITE(SumsIn, testing::Dimensions);

TYPED_TEST(SumsIn, AnyDimensionEqualThePlainDoubleLoop) {
  constexpr int Dim = TypeParam::value;
  Dice dice(61);
  Points<Dim> points;
  scatter<Dim>(dice, VecN<Dim>::Zero(), 500, points);
  expect_sums_in_both<Dim>({VecN<Dim>::Constant(-4.0), VecN<Dim>::Constant(4.0)}, points, 1e-4);
}

TYPED_TEST(SumsIn, AnyDimensionCrossTheBordersOfOriginCells) {
  constexpr int Dim = TypeParam::value;
  Dice dice(62);
  Points<Dim> points;
  // 512 h from the domain's corner, and again, cells meet: at corners, and at an edge or face.
  scatter<Dim>(dice, VecN<Dim>::Constant(512.0 - 1000.0), 300, points);
  scatter<Dim>(dice, VecN<Dim>::Constant(3 * 512.0 - 1000.0), 200, points);
  VecN<Dim> face = VecN<Dim>::Constant(100.0 - 1000.0);
  face[Dim - 1] = 2 * 512.0 - 1000.0;
  scatter<Dim>(dice, face, 100, points);
  expect_sums_in_both<Dim>({VecN<Dim>::Constant(-1000.0), VecN<Dim>::Constant(1000.0)}, points,
                           1e-2);
}

}  // namespace
}  // namespace sluice
#endif

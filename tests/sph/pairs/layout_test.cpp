#include "engine/sph/pairs/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/sph/pairs/grid-inl.hpp"
#include "engine/sph/pairs/layout-inl.hpp"
#include "engine/sph/pairs/pair_list.hpp"
#include "tests/space/dimensions.hpp"
#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

template <int Dim>
struct Places {
  std::array<std::vector<double>, Dim> position;
  std::vector<double> id;

  [[nodiscard]] VecN<Dim> at(std::size_t s) const {
    return place_in<Dim>(spans_of<Dim>(position), s);
  }
};

template <int Dim>
VecN<Dim> in_box(Dice& dice, const BoxN<Dim>& box) {
  VecN<Dim> place;
  for (int axis = 0; axis < Dim; ++axis) place[axis] = dice.between(box.min[axis], box.max[axis]);
  return place;
}

/// Random places, some of which coincide, and empty slots between them.
template <int Dim>
Places<Dim> scattered(Dice& dice, const BoxN<Dim>& box, std::size_t slots) {
  Places<Dim> p;
  for (std::size_t s = 0; s < slots; ++s) {
    const bool again = s > 0 && dice.between(0.0, 1.0) < 0.1;
    const VecN<Dim> place = again ? p.at(s - 1) : in_box<Dim>(dice, box);
    for (int axis = 0; axis < Dim; ++axis) {
      p.position[static_cast<std::size_t>(axis)].push_back(place[axis]);
    }
    p.id.push_back(dice.between(0.0, 1.0) < 0.2 ? -1.0 : static_cast<double>(s));
  }
  return p;
}

template <int Dim>
Order sorted(int threads, const Grid<Dim>& grid, const Places<Dim>& p) {
  ThreadTeam team(threads);
  return sort_into_clusters<Dim>(team, grid, spans_of<Dim>(p.position), p.id);
}

/// The particles in order, without empty slots.
std::vector<std::uint32_t> particles_of(const Order& order) {
  std::vector<std::uint32_t> all = order.source;
  std::erase(all, Order::kEmpty);
  return all;
}

template <int Dim>
std::vector<std::uint32_t> plainly_sorted(const Grid<Dim>& grid, const Places<Dim>& p) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t s = 0; s < p.id.size(); ++s) {
    if (p.id[s] >= 0.0) all.push_back(s);
  }
  const auto key = [&](std::uint32_t s) {
    std::array<double, Dim + 2> row_place_id{static_cast<double>(grid.row(p.at(s)))};
    for (std::size_t axis = 0; axis < Dim; ++axis) row_place_id[axis + 1] = p.position[axis][s];
    row_place_id.back() = p.id[s];
    return row_place_id;
  };
  std::sort(all.begin(), all.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return all;
}

/// Rows begin new clusters, clusters are short, and only the last slots of one are empty.
template <int Dim>
void expect_sound(const Grid<Dim>& grid, const Places<Dim>& p, const Order& order) {
  const Layout& layout = order.layout;
  ASSERT_EQ(layout.row_begin.size(), grid.rows() + 1);
  ASSERT_EQ(layout.slots(), order.source.size());
  ASSERT_LE(kCluster * layout.row_begin.back(), layout.slots());
  for (std::size_t row = 0; row < grid.rows(); ++row) {
    for (std::size_t c = layout.row_begin[row]; c < layout.row_begin[row + 1]; ++c) {
      const std::uint32_t first = order.source[kCluster * c];
      ASSERT_NE(first, Order::kEmpty);
      bool ended = false;
      for (std::size_t s = kCluster * c; s < kCluster * (c + 1); ++s) {
        const std::uint32_t particle = order.source[s];
        ended = ended || particle == Order::kEmpty;
        ASSERT_EQ(particle == Order::kEmpty, ended);
        if (ended) continue;
        ASSERT_EQ(grid.row(p.at(particle)), row);
        ASSERT_LE(p.at(particle).x() - p.at(first).x(), grid.max_cluster_length());
      }
    }
  }
}

template <int Dim>
void expect_order(const BoxN<Dim>& domain, const BoxN<Dim>& filled, std::size_t slots) {
  Dice dice(17);
  const Grid<Dim> grid(domain, 0.1, 0.15, slots);
  const Places<Dim> p = scattered<Dim>(dice, filled, slots);
  const Order order = sorted<Dim>(1, grid, p);
  EXPECT_EQ(particles_of(order), plainly_sorted<Dim>(grid, p));
  expect_sound<Dim>(grid, p, order);
  for (const int threads : {2, 3}) {
    const Order again = sorted<Dim>(threads, grid, p);
    EXPECT_EQ(again.source, order.source);
    EXPECT_EQ(again.layout.row_begin, order.layout.row_begin);
  }
}

/// A box from `from` to `to` along x and all axes behind y, and up to `high` along y.
template <int Dim>
BoxN<Dim> box_of(double from, double to, double low, double high) {
  BoxN<Dim> box{VecN<Dim>::Constant(from), VecN<Dim>::Constant(to)};
  box.min[kUpAxis] = low;
  box.max[kUpAxis] = high;
  return box;
}

template <class Dimension>
class Layouts : public ::testing::Test {};
TYPED_TEST_SUITE(Layouts, testing::Dimensions);

TYPED_TEST(Layouts, OrderByRowPlaceAndNumberWhateverTheThreads) {
  constexpr int Dim = TypeParam::value;
  expect_order<Dim>(box_of<Dim>(0, 6, 0, 4), box_of<Dim>(0, 6, 0, 4), 4000);
}

TYPED_TEST(Layouts, OrderWhatLiesInACornerOfAVastDomainAndBeyondIt) {
  constexpr int Dim = TypeParam::value;
  expect_order<Dim>(box_of<Dim>(-1e4, 1e4, -1e5, 1e5),
                    box_of<Dim>(9.99e3, 1.001e4, 9.999e4, 1.0001e5), 3000);
}

TYPED_TEST(Layouts, OfNothingAreEmpty) {
  constexpr int Dim = TypeParam::value;
  expect_order<Dim>(box_of<Dim>(0, 1, 0, 1), box_of<Dim>(0, 1, 0, 1), 0);
}

TEST(Grid, NumbersRowsByZFirstAndThenByY) {
  // Rows are 0.2 m high and deep: five by five of them.
  const Grid<3> grid({{0, 0, 0}, {0.9, 0.9, 0.9}}, 0.1, 0.15, 100);
  ASSERT_EQ(grid.rows(), 25U);
  EXPECT_EQ(grid.row({0.5, 0.1, 0.1}), 0U);
  EXPECT_EQ(grid.row({0.5, 0.3, 0.1}), 1U);
  EXPECT_EQ(grid.row({0.5, 0.1, 0.3}), 5U);
  EXPECT_EQ(grid.row({0.5, 9.0, 9.0}), 24U);
}

TYPED_TEST(Layouts, PlacesLieAroundTheCentreOfTheirOriginCell) {
  constexpr int Dim = TypeParam::value;
  const BoxN<Dim> vast = box_of<Dim>(-500, 500, -500, 500);
  const Grid<Dim> grid(vast, 0.1, 0.15, 100);
  ASSERT_FALSE(grid.has_one_origin_cell());
  Dice dice(19);
  for (int n = 0; n < 100; ++n) {
    const VecN<Dim> place = in_box<Dim>(dice, vast);
    const VecN<Dim> off = place - grid.origin_cell_center(grid.origin_cell(place));
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.5 * grid.origin_cell_size());
  }
}

TYPED_TEST(Layouts, EntriesKeepClusterAndStepToTheOriginCell) {
  constexpr int Dim = TypeParam::value;
  using Entry = ListEntry<Dim>;
  EXPECT_EQ(Entry::code_of(OriginStep<Dim>{}), Entry::kSameOriginCell);
  const std::uint32_t last = (1U << Entry::kCodeBit) - 1U;
  for (std::uint32_t code = 0; code < Entry::kCodes; ++code) {
    EXPECT_EQ(Entry::code_of(Entry::step_of(code)), code);
    EXPECT_EQ(Entry::code(Entry::of(last, code)), code);
    EXPECT_EQ(Entry::cluster(Entry::of(last, code)), last);
  }
}

}  // namespace
}  // namespace sluice

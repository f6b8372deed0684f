#include "engine/sph/pairs/layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "tests/sph/test_fluids.hpp"

namespace sluice {
namespace {

struct Places {
  std::vector<double> x, y, id;
};

/// Random places, some of which coincide, and empty slots between them.
Places scattered(Dice& dice, const Box& box, std::size_t slots) {
  Places p;
  for (std::size_t s = 0; s < slots; ++s) {
    const bool again = s > 0 && dice.between(0.0, 1.0) < 0.1;
    const Vec place = again ? Vec(p.x.back(), p.y.back()) : dice.in_box(box.min, box.max);
    p.x.push_back(place.x());
    p.y.push_back(place.y());
    p.id.push_back(dice.between(0.0, 1.0) < 0.2 ? -1.0 : static_cast<double>(s));
  }
  return p;
}

Order sorted(int threads, const Grid& grid, const Places& p) {
  ThreadTeam team(threads);
  return sort_into_clusters(team, grid, p.x, p.y, p.id);
}

/// The particles in order, without empty slots.
std::vector<std::uint32_t> particles_of(const Order& order) {
  std::vector<std::uint32_t> all = order.source;
  std::erase(all, Order::kEmpty);
  return all;
}

std::vector<std::uint32_t> plainly_sorted(const Grid& grid, const Places& p) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t s = 0; s < p.id.size(); ++s) {
    if (p.id[s] >= 0.0) all.push_back(s);
  }
  const auto key = [&](std::uint32_t s) {
    return std::tuple(grid.row(p.y[s]), p.x[s], p.y[s], p.id[s]);
  };
  std::sort(all.begin(), all.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return all;
}

/// Strips begin new clusters, clusters are short, and only the last slots of one are empty.
void expect_sound(const Grid& grid, const Places& p, const Order& order) {
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
        ASSERT_EQ(grid.row(p.y[particle]), row);
        ASSERT_LE(p.x[particle] - p.x[first], grid.max_cluster_length());
      }
    }
  }
}

void expect_order(const Box& domain, const Box& filled, std::size_t slots) {
  Dice dice(17);
  const Grid grid(domain, 0.1, 0.15, slots);
  const Places p = scattered(dice, filled, slots);
  const Order order = sorted(1, grid, p);
  EXPECT_EQ(particles_of(order), plainly_sorted(grid, p));
  expect_sound(grid, p, order);
  for (const int threads : {2, 3}) {
    const Order again = sorted(threads, grid, p);
    EXPECT_EQ(again.source, order.source);
    EXPECT_EQ(again.layout.row_begin, order.layout.row_begin);
  }
}

TEST(Layout, OrdersByRowPlaceAndNumberWhateverTheThreads) {
  expect_order({{0, 0}, {6, 4}}, {{0, 0}, {6, 4}}, 4000);
}

TEST(Layout, OrdersWhatLiesInACornerOfAVastDomainAndBeyondIt) {
  expect_order({{-1e4, -1e5}, {1e4, 1e5}}, {{9.99e3, 9.999e4}, {1.001e4, 1.0001e5}}, 3000);
}

TEST(Layout, OfNothingIsEmpty) { expect_order({{0, 0}, {1, 1}}, {{0, 0}, {1, 1}}, 0); }

}  // namespace
}  // namespace sluice

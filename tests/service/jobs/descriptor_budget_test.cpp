#include "service/jobs/descriptor_budget.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace sluice::test {
namespace {

TEST(DescriptorBudget, LeavesTheServiceAndItsWorkersTheirFiles) {
  EXPECT_EQ(connections_within(least_descriptor_limit(2) - 1, 2), 0);
  for (const int workers : {1, 2, 64}) {
    const std::uint64_t least = least_descriptor_limit(workers);
    EXPECT_GT(connections_within(least, workers), 0);
    for (const std::uint64_t limit : {least, std::uint64_t{1024}, std::uint64_t{65536}}) {
      EXPECT_LT(static_cast<std::uint64_t>(connections_within(limit, workers) + 4 * workers),
                limit);
    }
  }
  EXPECT_GE(connections_within(1024, 2), 512);  // the usual limit lowers nothing
}

}  // namespace
}  // namespace sluice::test

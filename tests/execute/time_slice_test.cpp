#include "engine/execute/time_slice.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <thread>

namespace sluice::test {
namespace {

/// As the system tells it of the calling thread, ns; 0 before Linux 6.12.
std::uint64_t present_slice() {
  std::array<char, 48> attributes{};
  EXPECT_EQ(::syscall(SYS_sched_getattr, 0, attributes.data(), attributes.size(), 0), 0);
  std::uint64_t slice = 0;
  std::memcpy(&slice, attributes.data() + 24, sizeof slice);
  return slice;
}

TEST(TimeSlice, IsInheritedByThreadsAndGivenBackAndLeavesThePriority) {
  // In a thread of its own, so that the test program stays as it is.
  std::thread([] {
    const std::uint64_t usual = present_slice();
    const int nice = ::getpriority(PRIO_PROCESS, 0);
    ask_for_slices(kShortestSlice);
    if (present_slice() == 0) GTEST_SKIP() << "this system has no slices to ask for";
    EXPECT_EQ(present_slice(), kShortestSlice);
    std::thread([] { EXPECT_EQ(present_slice(), kShortestSlice); }).join();
    EXPECT_EQ(::getpriority(PRIO_PROCESS, 0), nice);
    ask_for_slices(0);
    EXPECT_EQ(present_slice(), usual);
  }).join();
}

}  // namespace
}  // namespace sluice::test

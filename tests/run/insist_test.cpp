#include "engine/run/insist.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "engine/run/stopwatch.hpp"

namespace sluice {
namespace {

const StorageError kPassing(StorageFault::io, "x: cannot write");

/// Fails `failures` times and counts all tries.
struct Write {
  int failures = 0;
  std::function<void()> failure = [] { throw kPassing; };
  int tries = 0;
  void operator()() {
    if (++tries <= failures) failure();
  }
};

TEST(Insist, TriesAgainAfterAFailureThatPassesAndTellsOfIt) {
  Write write{1};
  std::vector<double> waits;
  insist(30.0, std::ref(write), [&](const StorageError& error, double wait) {
    EXPECT_STREQ(error.what(), kPassing.what());
    waits.push_back(wait);
  });
  EXPECT_EQ(write.tries, 2);
  ASSERT_EQ(waits.size(), 1U);
  EXPECT_NEAR(waits.front(), 0.5, 1e-9);  // the first wait of Backoff
}

TEST(Insist, WithoutPatienceTriesOnceAndThrowsTheFailureOn) {
  Write write{100};
  EXPECT_THROW(insist(0.0, std::ref(write), [](const StorageError&, double) {}), StorageError);
  EXPECT_EQ(write.tries, 1);
}

TEST(Insist, WaitsForNothingThatNoWaitingMends) {
  for (const StorageFault fault :
       {StorageFault::corrupt, StorageFault::invalid_content, StorageFault::locked,
        StorageFault::not_ours, StorageFault::already_exists, StorageFault::wrong_scene}) {
    Write write{1, [fault] { throw StorageError(fault, "never"); }};
    EXPECT_THROW(insist(30.0, std::ref(write), [](const StorageError&, double) {}), StorageError);
    EXPECT_EQ(write.tries, 1) << to_string(fault);
  }
}

TEST(Insist, TakesAWantOfMemoryAndErrorsOfTheFileSystemForPassingOnes) {
  const std::filesystem::path frames = "job/frames";
  const std::vector<std::function<void()>> failures{
      [] { throw std::bad_alloc(); },
      [&] {
        throw std::filesystem::filesystem_error("cannot create directory", frames,
                                                std::make_error_code(std::errc::io_error));
      }};
  for (const auto& failure : failures) {
    Write write{1, failure};
    insist(30.0, std::ref(write), [](const StorageError&, double) {});
    EXPECT_EQ(write.tries, 2);
  }
}

TEST(Insist, WaitsForNothingWhereSomethingElseHasTheName) {
  for (const std::errc error :
       {std::errc::file_exists, std::errc::not_a_directory, std::errc::is_a_directory,
        std::errc::too_many_symbolic_link_levels}) {
    Write write{1, [error] {
                  throw std::filesystem::filesystem_error("cannot create directory", "job/frames",
                                                          std::make_error_code(error));
                }};
    EXPECT_THROW(insist(30.0, std::ref(write), [](const StorageError&, double) {}), StorageError);
    EXPECT_EQ(write.tries, 1) << std::make_error_code(error).message();
  }
}

TEST(Insist, AWishToStopEndsTheWaitWithOneMoreTry) {
  Write write{100};
  bool hurry = false;
  const Stopwatch clock;
  double longest = 0.0;
  EXPECT_THROW(insist(
                   1e6, std::ref(write),
                   [&](const StorageError&, double wait) {
                     longest = wait;
                     hurry = wait > 1.5;  // the third wait of Backoff
                   },
                   [&] { return hurry; }),
               StorageError);
  EXPECT_NEAR(longest, 2.0, 1e-9);
  EXPECT_EQ(write.tries, 4);
  EXPECT_LT(clock.seconds(), 0.5 + 1.0 + 1.9) << "the third wait was not waited for";
}

TEST(Insist, InAHurryStillTriesTwice) {
  Write write{1};
  insist(
      30.0, std::ref(write), [](const StorageError&, double) {}, [] { return true; });
  EXPECT_EQ(write.tries, 2);
}

TEST(Insist, NeverTakesAnotherExceptionForAFailureOfTheDisk) {
  Write write{1, [] { throw std::logic_error("a defect"); }};
  EXPECT_THROW(insist(30.0, std::ref(write), [](const StorageError&, double) {}), std::logic_error);
  EXPECT_EQ(write.tries, 1);
}

}  // namespace
}  // namespace sluice

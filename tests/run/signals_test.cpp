#include "engine/run/signals.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "engine/run/stop_wish.hpp"

namespace sluice {
namespace {

TEST(SignalRequests, ACheckpointRequestIsHandedOutOnce) {
  SignalRequests requests;
  EXPECT_EQ(requests.take(), RunRequest::none);
  std::raise(SIGUSR1);
  std::raise(SIGUSR1);
  EXPECT_EQ(requests.take(), RunRequest::checkpoint);
  EXPECT_EQ(requests.take(), RunRequest::none);
}

class StopSignal : public ::testing::TestWithParam<int> {};

TEST_P(StopSignal, IsAStopThatStays) {
  SignalRequests requests;
  std::raise(GetParam());
  EXPECT_EQ(requests.take(), RunRequest::stop);
  EXPECT_EQ(requests.take(), RunRequest::stop);
  EXPECT_TRUE(requests.stop_requested());
}

TEST_P(StopSignal, IsTheSameWishWhenItComesTwiceTogether) {
  SignalRequests requests;
  std::raise(SIGTERM);
  std::raise(GetParam());
  EXPECT_EQ(requests.take(), RunRequest::stop);
}

INSTANTIATE_TEST_SUITE_P(All, StopSignal, ::testing::Values(SIGTERM, SIGINT, SIGHUP));

TEST(StopWish, IsAnotherOneWhenItComesLaterThanTheFirstBySomeTime) {
  const std::chrono::nanoseconds first(0);
  StopWish wish;
  EXPECT_FALSE(wish.asked());
  EXPECT_EQ(wish.take(first), StopWish::Kind::first);
  EXPECT_TRUE(wish.asked());
  for (const auto after : {std::chrono::milliseconds(0), std::chrono::milliseconds(1),
                           std::chrono::milliseconds(1999)}) {
    EXPECT_EQ(wish.take(first + after), StopWish::Kind::same);
  }
  EXPECT_EQ(wish.take(first + kSameWish), StopWish::Kind::at_once);
  wish.forget();
  EXPECT_EQ(wish.take(first + kSameWish), StopWish::Kind::first);
}

TEST(SignalRequests, EndTheProcessAtOnceWhenAskedAgainLaterAndEmptyTheFileThatNamesIt) {
  std::FILE* const file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  ASSERT_EQ(::write(fileno(file), "4711\n", 5), 5);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    SignalRequests requests;
    requests.empty_when_ended_at_once(fileno(file));
    std::raise(SIGTERM);
    std::this_thread::sleep_for(kSameWish);
    std::raise(SIGINT);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGINT);
  EXPECT_EQ(::lseek(fileno(file), 0, SEEK_END), 0);
  std::fclose(file);
}

TEST(SignalRequests, ShareWhatWasAskedForWithOneThatIsMadeLater) {
  SignalRequests outer;
  std::raise(SIGTERM);
  {
    SignalRequests inner;
    EXPECT_EQ(inner.take(), RunRequest::stop);
  }
  std::raise(SIGTERM);  // still taken
  EXPECT_EQ(outer.take(), RunRequest::stop);
}

TEST(SignalRequests, GiveThePreviousActionsBack) {
  struct sigaction before {};
  before.sa_handler = SIG_IGN;
  struct sigaction original {};
  sigaction(SIGUSR1, &before, &original);
  { const SignalRequests requests; }
  struct sigaction after {};
  sigaction(SIGUSR1, &original, &after);
  EXPECT_EQ(after.sa_handler, SIG_IGN);
}

TEST(SignalRequests, StayDeafToAHangupThatWasIgnoredAtTheStart) {
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  struct sigaction original {};
  sigaction(SIGHUP, &ignore, &original);
  {
    const SignalRequests requests;
    std::raise(SIGHUP);
    EXPECT_FALSE(requests.stop_requested());
  }
  sigaction(SIGHUP, &original, nullptr);
}

}  // namespace
}  // namespace sluice

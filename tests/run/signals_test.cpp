#include "engine/run/signals.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace sluice {
namespace {

TEST(SignalRequests, ACheckpointRequestIsHandedOutOnce) {
  SignalRequests requests;
  EXPECT_EQ(requests.take(), Request::none);
  std::raise(SIGUSR1);
  std::raise(SIGUSR1);
  EXPECT_EQ(requests.take(), Request::checkpoint);
  EXPECT_EQ(requests.take(), Request::none);
}

class StopSignal : public ::testing::TestWithParam<int> {};

TEST_P(StopSignal, IsAStopThatStays) {
  SignalRequests requests;
  std::raise(GetParam());
  EXPECT_EQ(requests.take(), Request::stop);
  EXPECT_EQ(requests.take(), Request::stop);
  EXPECT_TRUE(requests.stop_requested());
}

TEST_P(StopSignal, EndsTheProcessAtOnceTheSecondTime) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const SignalRequests requests;
    std::raise(SIGTERM);
    std::raise(GetParam());
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, StopSignal, ::testing::Values(SIGTERM, SIGINT, SIGHUP));

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

#include "service/worker/core_use.hpp"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

/// A process that waits for ever, or that computes for ever on two threads.
class Child {
 public:
  enum class Habit { waits, computes };
  explicit Child(Habit habit) : pid_(::fork()) {
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (habit == Habit::waits) ::pause();
    volatile bool for_ever = true;
    std::thread second([&] {
      while (for_ever) {
      }
    });
    ::pause();
    ::_exit(0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_;
};

TEST(CoreUse, OfAProcessThatWaitsStaysTheSame) {
  const Child child(Child::Habit::waits);
  wait_until("it to wait", [&] { return !core_use(child.pid()).runnable; });
  const double before = core_use(child.pid()).core_seconds;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(core_use(child.pid()).core_seconds, before);
  EXPECT_FALSE(core_use(child.pid()).runnable);
}

TEST(CoreUse, OfAProcessWhoseFirstThreadWaitsIsThatOfTheOthers) {
  const Child child(Child::Habit::computes);
  wait_until("it to compute", [&] { return core_use(child.pid()).core_seconds > 0.05; });
  EXPECT_TRUE(core_use(child.pid()).runnable);
}

TEST(CoreUse, OfAProcessThatIsGoneIsNothing) {
  pid_t gone = 0;
  {
    const Child child(Child::Habit::waits);
    gone = child.pid();
  }
  EXPECT_EQ(core_use(gone).core_seconds, 0.0);
  EXPECT_FALSE(core_use(gone).runnable);
}

TEST(StallClock, CountsAllTimeInWhichAProcessDoesNotWantToRun) {
  StallClock clock(100.0);
  EXPECT_EQ(clock.look(110.0, {5.0, false}), 10.0);
  EXPECT_EQ(clock.look(111.0, {5.0, false}), 11.0);
  clock.restart(112.0);
  EXPECT_EQ(clock.look(113.0, {5.0, false}), 1.0);
}

TEST(StallClock, CountsByTheCoresWhatAProcessWaitsForThem) {
  StallClock clock(100.0);
  EXPECT_EQ(clock.look(110.0, {0.5, true}), 0.5);
  EXPECT_EQ(clock.look(120.0, {0.5, true}), 0.5) << "it got none";
  EXPECT_EQ(clock.look(121.0, {2.5, true}), 1.5) << "two threads for a second";
  EXPECT_EQ(clock.look(131.0, {1.0, true}), 1.5) << "a thread ended, and its time is gone";
  EXPECT_EQ(clock.look(141.0, {1.0, false}), 11.5);
}

}  // namespace
}  // namespace sluice::test

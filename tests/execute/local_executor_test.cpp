#include "engine/execute/local_executor.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>

#include "tests/execute/execute_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

class LocalProcessTest : public ::testing::Test {
 protected:
  ProcessCommand bash(std::string_view lines) { return script(folder_.path(), lines); }
  std::string run(std::string_view lines) { return output_of(*start(bash(lines))); }
  /// Nothing of ours is left to wait for.
  static void expect_no_child() {
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }

  TemporaryFolder folder_;
};

TEST_F(LocalProcessTest, TellsTheExitCodeOnce) {
  const auto process = start(bash("exit 42"));
  const ProcessEnd end = end_of(*process);
  EXPECT_EQ(end.exit_code, 42);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(process->reap());
}

TEST_F(LocalProcessTest, TellsTheSignal) {
  const ProcessEnd end = end_of(*start(bash("kill -9 $$")));
  EXPECT_LT(end.exit_code, 0);
  EXPECT_EQ(end.signal, SIGKILL);
}

TEST_F(LocalProcessTest, ItsEndWakesAPoll) {
  const auto process = start(bash("sleep 0.1"));
  if (process->end_descriptor() < 0) GTEST_SKIP() << "this system has no process descriptors";
  pollfd entry{process->end_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&entry, 1, -1), 1);
  EXPECT_TRUE(process->reap());
}

TEST_F(LocalProcessTest, GetsItsArgumentsInItsFolder) {
  ProcessCommand command = bash(R"(echo "$PWD: $@")");
  command.arguments = {"run", "a b"};
  EXPECT_EQ(output_of(*start(command)), folder_.path().string() + ": run a b\n");
}

TEST_F(LocalProcessTest, HasAGroupOfItsOwn) {
  const auto process = start(bash("sleep 1000"));
  EXPECT_EQ(::getpgid(process->pid()), process->pid());
}

TEST_F(LocalProcessTest, LeavesNothingOfItsGroupBehind) {
  const std::string pid = run("sleep 1000 > /dev/null 2>&1 & echo $!");
  wait_until("the end of what it left",
             [&] { return ::kill(std::stoi(pid), 0) != 0 && errno == ESRCH; });
}

TEST_F(LocalProcessTest, IsKilledAndReapedWithItsOwner) {
  pid_t pid = 0;
  {
    const auto process = start(bash("sleep 1000"));
    pid = process->pid();
  }
  EXPECT_EQ(::waitpid(pid, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(LocalProcessTest, SaysWhyItCannotStart) {
  ProcessCommand command = bash("true");
  command.program = folder_ / "missing";
  try {
    (void)start(command);
    FAIL() << "a missing program was started";
  } catch (const ProcessStartError& error) {
    EXPECT_EQ(std::string(error.what()),
              "cannot open " + command.program.string() + ": No such file or directory");
    EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
  }
  command = bash("true");
  fs::permissions(command.program, fs::perms::owner_read);
  EXPECT_THROW((void)start(command), ProcessStartError);
  command = bash("true");
  command.folder = folder_ / "nowhere";
  EXPECT_THROW((void)start(command), ProcessStartError);
}

TEST_F(LocalProcessTest, LeaksNoDescriptorAndNoZombie) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = descriptors();
  ProcessCommand missing = bash("true");
  missing.program = "/nowhere";
  for (int i = 0; i < 20; ++i) {
    EXPECT_THROW((void)start(missing), ProcessStartError);
    const auto process = start(bash("exit 0"));
    if (i % 2 == 0) (void)end_of(*process);
  }
  EXPECT_EQ(descriptors(), before);
  expect_no_child();
}

TEST_F(LocalProcessTest, GetsItsSignalWhenItsParentIsKilled) {
  ProcessCommand command =
      bash("trap 'touch told; exit 85' TERM; touch ready; while :; do sleep 0.02; done");
  command.signals.at_parents_end = SIGTERM;
  const pid_t parent = ::fork();
  if (parent == 0) {
    const auto process = start(command);
    ::pause();
  }
  wait_until("the process", [&] { return fs::exists(folder_ / "ready"); });
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  wait_until("its obedience", [&] { return fs::exists(folder_ / "told"); });
}

/// Lowers the limit of open files of this process for its life.
class FewDescriptors {
 public:
  explicit FewDescriptors(rlim_t most) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit fewer{most, before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &fewer), 0);
  }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(LocalProcessTest, StartsInItsSandboxUnderAnyLimitOfOpenFilesOrSaysSo) {
  ProcessCommand command;
  command.program = "/bin/true";
  command.folder = folder_.path();
  command.confinement = Confinement::full;
  for (const rlim_t most : {64, 256, 257, 1000, 1001}) {
    for (const std::uint64_t limit : {std::uint64_t{256}, ProcessLimits::kMost}) {
      const FewDescriptors few(most);
      command.limits.descriptors = limit;
      EXPECT_EQ(end_of(*start(command)).exit_code, 0) << most << ", " << limit;
    }
  }
  const FewDescriptors few(18);
  EXPECT_THROW((void)start(command), ProcessStartError);
}

TEST_F(LocalProcessTest, OfThisProgramNeedsNoName) {
  ProcessCommand command;
  command.arguments = {"--gtest_filter=LocalProcessTest.ItsEndWakesAPoll", "--gtest_list_tests"};
  EXPECT_NE(output_of(*start(command)).find("ItsEndWakesAPoll"), std::string::npos);
}

}  // namespace
}  // namespace sluice::test

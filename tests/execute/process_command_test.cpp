#include "engine/execute/process_command.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/store/disk/file_system.hpp"
#include "tests/execute/execute_support.hpp"

namespace sluice::test {
namespace {

/// What each member of a command makes of the process.
class CommandTest : public ::testing::Test {
 protected:
  ProcessCommand bash(std::string_view lines) { return script(folder_.path(), lines); }
  /// The mask of signals that /proc tells of under that name.
  static std::string mask_line(const char* name) {
    return std::string("grep ") + name + " /proc/$$/status | cut -f2";
  }
  static std::uint64_t mask(const std::string& text) { return std::stoull(text, nullptr, 16); }
  static std::uint64_t bit(int signal) { return std::uint64_t{1} << (signal - 1); }

  TemporaryFolder folder_;
};

TEST_F(CommandTest, LeftOutInputIsEmptyAndOthersClosedAreClosed) {
  ProcessCommand command = bash("ls -l /proc/self/fd");
  command.others = ProcessCommand::Others::closed;
  const FileDescriptor leaky(::dup(STDIN_FILENO));  // without close-on-exec
  const std::string listed = output_of(*start(command));
  EXPECT_NE(listed.find("0 -> /dev/null"), std::string::npos) << listed;
  // 0, 1, 2 and the one with which ls reads the folder.
  EXPECT_EQ(std::count(listed.begin(), listed.end(), '>'), 4) << listed;
}

/// How many descriptors of this process a child keeps, beside the first three.
int inheritable_descriptors() {
  int count = 0;
  for (int number = 3; number < 1024; ++number) {
    const int flags = ::fcntl(number, F_GETFD);
    count += flags >= 0 && (flags & FD_CLOEXEC) == 0 ? 1 : 0;
  }
  return count;
}

TEST_F(CommandTest, OthersKeptAreKeptAndNothingOfTheExecutorsIsAmongThem) {
  const FileDescriptor kept(::dup(STDIN_FILENO));
  ASSERT_GT(inheritable_descriptors(), 0);
  ProcessCommand command = bash("ls -l /proc/self/fd");
  const std::string listed = output_of(*start(command));
  EXPECT_EQ(std::count(listed.begin(), listed.end(), '>'), 4 + inheritable_descriptors()) << listed;
}

TEST_F(CommandTest, OutputGoesWhereItIsSentAndHasNoPipeThen) {
  write_file(folder_ / "input", "a line\n");
  write_file(folder_ / "log", "before\n");
  const FileDescriptor input(::open((folder_ / "input").c_str(), O_RDONLY | O_CLOEXEC));
  const FileDescriptor log(::open((folder_ / "log").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  ProcessCommand command = bash("cat; echo error >&2");
  command.input = input.get();
  command.output = log.get();
  command.errors = log.get();
  const auto process = start(command);
  EXPECT_LT(process->output(), 0);
  EXPECT_LT(process->errors(), 0);
  EXPECT_EQ(end_of(*process).exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "log"), "before\na line\nerror\n");
}

TEST_F(CommandTest, EnvironmentIsThisProcessesOrTheOneThatIsGiven) {
  ::setenv("SLUICE_TEST_SECRET", "hidden", 1);
  ProcessCommand command = bash("/usr/bin/env");
  EXPECT_NE(output_of(*start(command)).find("SLUICE_TEST_SECRET=hidden"), std::string::npos);
  command.environment = {{"NAME=value"}};
  const std::string given = output_of(*start(command));
  EXPECT_EQ(given.find("hidden"), std::string::npos) << given;
  EXPECT_NE(given.find("NAME=value\n"), std::string::npos) << given;
}

TEST_F(CommandTest, LimitsAreThoseThatAreGiven) {
  ProcessCommand command = bash("ulimit -c; ulimit -n; ulimit -v");
  command.limits.core_dump = 0;
  command.limits.descriptors = 200;
  command.limits.address_space = std::uint64_t{1} << 40;
  EXPECT_EQ(output_of(*start(command)), "0\n200\n1073741824\n");
}

TEST_F(CommandTest, AFileGrowsToItsLimitAndNoFurther) {
  ProcessCommand command = bash(R"(trap '' XFSZ
head -c 200000 /dev/zero > big; stat -c %s big)");
  command.limits.largest_file = 100 * 1024;
  EXPECT_EQ(output_of(*start(command)), "102400\n");
}

TEST_F(CommandTest, PriorityIsWhatIsGiven) {
  ProcessCommand command = bash("nice; cat /proc/self/oom_score_adj");
  command.priority.niceness = 7;
  command.priority.oom_score = 600;
  EXPECT_EQ(output_of(*start(command)), "7\n600\n");
}

TEST_F(CommandTest, SignalsThatAreToBeIgnoredAreIgnored) {
  ProcessCommand command = bash("sleep 0.2; exit 3");
  command.signals.ignored = {SIGUSR1};
  const auto process = start(command);
  process->send(SIGUSR1);
  EXPECT_EQ(end_of(*process).exit_code, 3);
}

/// Ignores a signal in this process for its life.
class Ignored {
 public:
  explicit Ignored(int number) : number_(number), before_(std::signal(number, SIG_IGN)) {}
  Ignored(const Ignored&) = delete;
  Ignored& operator=(const Ignored&) = delete;
  ~Ignored() { std::signal(number_, before_); }

 private:
  int number_;
  void (*before_)(int);
};

TEST_F(CommandTest, IgnoredSignalsStayIgnoredWhereActionsAreKept) {
  const Ignored hangup(SIGHUP);
  ProcessCommand command = bash(mask_line("SigIgn"));
  EXPECT_NE(mask(output_of(*start(command))) & bit(SIGHUP), 0U);
  command.signals.actions = ProcessSignals::Actions::usual;
  EXPECT_EQ(mask(output_of(*start(command))) & bit(SIGHUP), 0U);
}

TEST_F(CommandTest, SignalsAreBlockedOnlyWhereTheCommandSaysSo) {
  sigset_t before;
  sigset_t here;
  ::sigemptyset(&here);
  ::sigaddset(&here, SIGTSTP);
  ::pthread_sigmask(SIG_BLOCK, &here, &before);
  ProcessCommand command = bash(mask_line("SigBlk"));
  EXPECT_EQ(mask(output_of(*start(command))) & bit(SIGTSTP), 0U);
  ::sigaddset(&command.signals.blocked, SIGHUP);
  EXPECT_NE(mask(output_of(*start(command))) & bit(SIGHUP), 0U);
  sigset_t after;
  ::pthread_sigmask(SIG_SETMASK, &before, &after);
  EXPECT_EQ(::sigismember(&after, SIGTSTP), 1) << "the executor changed this thread's mask";
  EXPECT_EQ(::sigismember(&after, SIGHUP), 0);
}

}  // namespace
}  // namespace sluice::test

#include "service/worker/worker_process.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>

#include "service/jobs/descriptor_budget.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

class WorkerProcessTest : public ::testing::Test {
 protected:
  WorkerCommand script(std::string_view text) {
    const fs::path path = data_.path() / "program.sh";
    write_file(path, "#!/bin/bash\n" + std::string(text) + "\n");
    fs::permissions(path, fs::perms::owner_all);
    WorkerCommand command;
    command.program = path;
    command.folder = data_.path();
    command.token = "the-token";
    command.confinement = Confinement::none;
    return command;
  }
  static WorkerEnd end_of(WorkerProcess& process) {
    std::optional<WorkerEnd> end;
    wait_until("the end of the process", [&] { return (end = process.reap()).has_value(); });
    return *end;
  }
  /// What it wrote to stdout, read after its end; little enough for the pipe.
  static std::string output_of(WorkerProcess& process) {
    (void)end_of(process);
    std::array<char, 65536> buffer{};
    const ssize_t count = ::read(process.output(), buffer.data(), buffer.size());
    return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
  }
  std::string run(std::string_view text) {
    WorkerProcess process(script(text));
    return output_of(process);
  }

  DataFolder data_;
};

TEST_F(WorkerProcessTest, TellsTheExitCode) {
  WorkerProcess process(script("exit 42"));
  const WorkerEnd end = end_of(process);
  EXPECT_EQ(end.exit_code, 42);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(process.reap());
}

TEST_F(WorkerProcessTest, TellsTheSignal) {
  WorkerProcess process(script("kill -9 $$"));
  const WorkerEnd end = end_of(process);
  EXPECT_LT(end.exit_code, 0);
  EXPECT_EQ(end.signal, SIGKILL);
}

TEST_F(WorkerProcessTest, ItsEndWakesAPoll) {
  WorkerProcess process(script("sleep 0.1"));
  if (process.end_descriptor() < 0) GTEST_SKIP() << "this system has no process descriptors";
  pollfd entry{process.end_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&entry, 1, -1), 1);
  EXPECT_TRUE(process.reap());
}

TEST_F(WorkerProcessTest, HasNoInputAndNoDescriptorsOfOurs) {
  const auto own = script("ls -l /proc/self/fd");
  const FileDescriptor leaky(::dup(STDIN_FILENO));  // without close-on-exec
  WorkerProcess process(own);
  const std::string listed = output_of(process);
  EXPECT_NE(listed.find("0 -> /dev/null"), std::string::npos) << listed;
  // 0, 1, 2 and the one with which ls reads the folder.
  EXPECT_EQ(std::count(listed.begin(), listed.end(), '>'), 4) << listed;
}

TEST_F(WorkerProcessTest, SeesOnlyTheEnvironmentThatItNeeds) {
  ::setenv("SLUICE_TEST_SECRET", "hidden", 1);
  const std::string environment = run("env");
  EXPECT_EQ(environment.find("hidden"), std::string::npos);
  EXPECT_NE(environment.find("SLUICE_ATTEMPT=the-token"), std::string::npos);
}

TEST_F(WorkerProcessTest, WritesNoCoreAndHasFewDescriptors) {
  EXPECT_EQ(run("ulimit -c; ulimit -n"), "0\n256\n");
}

TEST_F(WorkerProcessTest, CannotGrowAFileBeyondItsLimit) {
  WorkerCommand command = script(R"(trap '' XFSZ
head -c 200000 /dev/zero > big; stat -c %s big)");
  command.largest_file = 100 * 1024;
  WorkerProcess process(command);
  EXPECT_EQ(output_of(process), "102400\n");
}

TEST_F(WorkerProcessTest, CannotTakeMoreAddressesThanItsLimit) {
  WorkerCommand command = script("ulimit -v");
  command.address_space = std::uint64_t{1} << 40;
  WorkerProcess process(command);
  EXPECT_EQ(output_of(process), std::to_string((std::uint64_t{1} << 40) / 1024) + "\n");
}

TEST_F(WorkerProcessTest, LivesThroughARequestForACheckpointThatComesTooEarly) {
  WorkerProcess process(script("sleep 0.2; exit 3"));
  process.send(SIGUSR1);
  EXPECT_EQ(end_of(process).exit_code, 3);
}

TEST_F(WorkerProcessTest, LeavesNothingOfItsGroupBehind) {
  const std::string pid = run("sleep 1000 > /dev/null 2>&1 & echo $!");
  wait_until("the end of what it left",
             [&] { return ::kill(std::stoi(pid), 0) != 0 && errno == ESRCH; });
}

TEST_F(WorkerProcessTest, IsKilledAndReapedWithItsOwner) {
  pid_t pid = 0;
  {
    const WorkerProcess process(script("sleep 1000"));
    pid = process.pid();
  }
  EXPECT_EQ(::waitpid(pid, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(WorkerProcessTest, SaysWhyItCannotStart) {
  WorkerCommand command = script("true");
  command.program = data_.path() / "missing";
  try {
    const WorkerProcess process(command);
    FAIL() << "a missing program was started";
  } catch (const WorkerStartError& error) {
    EXPECT_NE(std::string(error.what()).find("missing"), std::string::npos) << error.what();
  }
  command = script("true");
  fs::permissions(command.program, fs::perms::owner_read);
  EXPECT_THROW(WorkerProcess{command}, WorkerStartError);
  command = script("true");
  command.folder = data_.path() / "nowhere";
  EXPECT_THROW(WorkerProcess{command}, WorkerStartError);
}

TEST_F(WorkerProcessTest, LeaksNoDescriptorAndNoZombie) {
  const auto descriptors = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = descriptors();
  WorkerCommand missing = script("true");
  missing.program = "/nowhere";
  for (int i = 0; i < 20; ++i) {
    EXPECT_THROW(WorkerProcess{missing}, WorkerStartError);
    WorkerProcess process(script("exit 0"));
    if (i % 2 == 0) (void)end_of(process);
  }
  EXPECT_EQ(descriptors(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(WorkerProcessTest, IsToldToStopWhenItsServiceIsKilled) {
  const WorkerCommand command =
      script("trap 'touch told; exit 85' TERM; touch ready; while :; do sleep 0.02; done");
  const pid_t service = ::fork();
  if (service == 0) {
    const WorkerProcess process(command);
    ::pause();
  }
  wait_until("the worker", [&] { return fs::exists(data_.path() / "ready"); });
  ::kill(service, SIGKILL);
  ::waitpid(service, nullptr, 0);
  wait_until("the worker's obedience", [&] { return fs::exists(data_.path() / "told"); });
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

TEST_F(WorkerProcessTest, StartsInItsSandboxUnderAnyLimitOfOpenFilesOrSaysSo) {
  WorkerCommand command;
  command.program = sluice_program();
  command.arguments = {"--version"};
  command.folder = data_.path();
  for (const rlim_t most : {64, 256, 257, 1000, 1001}) {
    const FewDescriptors few(most);
    WorkerProcess process(command);
    EXPECT_EQ(end_of(process).exit_code, 0) << most;
  }
  const FewDescriptors few(18);
  EXPECT_THROW(WorkerProcess{command}, WorkerStartError);
}

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

#include "service/scheduler/worker_command.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/execute/local_executor.hpp"
#include "engine/store/disk/file_system.hpp"
#include "tests/service/scheduler/scheduler_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// What a worker has and has not, as the process that it is.
class WorkerCommandTest : public ::testing::Test {
 protected:
  WorkerCommandTest() {
    fs::create_directories(folder_);
    job_.token = "the-token";
    job_.threads = 2;
  }
  std::unique_ptr<RunningProcess> start(std::string_view script) {
    const fs::path program = write_worker(data_, script);
    return local_executor().start(worker_command(program, folder_, job_, limits_));
  }
  static ProcessEnd end_of(RunningProcess& worker) {
    std::optional<ProcessEnd> end;
    wait_until("the end of the worker", [&] { return (end = worker.reap()).has_value(); });
    return *end;
  }
  /// What it writes to stdout; little enough for the pipe.
  std::string run(std::string_view script) {
    const auto worker = start(script);
    static_cast<void>(end_of(*worker));
    std::array<char, 65536> buffer{};
    const ssize_t count = ::read(worker->output(), buffer.data(), buffer.size());
    return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
  }

  DataFolder data_;
  fs::path folder_ = data_.job("j");
  Job job_;
  ServiceLimits limits_ = limits_for_scripts();
};

TEST_F(WorkerCommandTest, ItsEnvironmentNamesTheAttemptAndHoldsNoSecret) {
  ::setenv("SLUICE_TEST_SECRET", "hidden", 1);
  const std::string environment = run("env");
  EXPECT_EQ(environment.find("hidden"), std::string::npos);
  EXPECT_NE(environment.find("SLUICE_ATTEMPT=the-token"), std::string::npos);
}

TEST_F(WorkerCommandTest, HasNoInputAndNoDescriptorsOfTheService) {
  const FileDescriptor leaky(::dup(STDIN_FILENO));  // without close-on-exec
  const std::string listed = run("ls -l /proc/self/fd");
  EXPECT_NE(listed.find("0 -> /dev/null"), std::string::npos) << listed;
  // 0, 1, 2 and the one with which ls reads the folder.
  EXPECT_EQ(std::count(listed.begin(), listed.end(), '>'), 4) << listed;
}

TEST_F(WorkerCommandTest, WritesNoCoreAndHasFewDescriptorsAndComesAfterTheService) {
  EXPECT_EQ(run("ulimit -c; ulimit -n; nice; cat /proc/self/oom_score_adj"), "0\n256\n5\n500\n");
}

TEST_F(WorkerCommandTest, ItsFilesAreNoLargerThanAJobMayTake) {
  limits_.disk_per_job = 100 * 1024;
  EXPECT_EQ(run("ulimit -f"), "100\n");
  limits_.disk_per_job = 0;
  EXPECT_EQ(run("ulimit -f"), "unlimited\n");
}

TEST_F(WorkerCommandTest, LivesThroughARequestForACheckpointThatComesTooEarly) {
  const auto worker = start("sleep 0.2; exit 3");
  worker->send(SIGUSR1);
  EXPECT_EQ(end_of(*worker).exit_code, 3);
}

TEST_F(WorkerCommandTest, IsToldToStopWhenItsServiceIsKilled) {
  const pid_t service = ::fork();
  if (service == 0) {
    const auto worker =
        start("trap 'touch told; exit 85' TERM; touch ready; while :; do sleep 0.02; done");
    ::pause();
  }
  wait_until("the worker", [&] { return fs::exists(folder_ / "ready"); });
  ::kill(service, SIGKILL);
  ::waitpid(service, nullptr, 0);
  wait_until("the worker's obedience", [&] { return fs::exists(folder_ / "told"); });
}

TEST_F(WorkerCommandTest, IsConfinedUnlessTheServiceSaysOtherwise) {
  limits_.confinement = ServiceLimits().confinement;
  EXPECT_EQ(worker_command("", folder_, job_, limits_).confinement, Confinement::full);
  limits_.confinement = Confinement::none;
  EXPECT_EQ(worker_command("", folder_, job_, limits_).confinement, Confinement::none);
}

}  // namespace
}  // namespace sluice::test

#include "engine/execute/sandbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <string>

#include "tests/execute/execute_support.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SLUICE_SANITIZED 1
#else
#define SLUICE_SANITIZED 0
#endif

namespace sluice::test {
namespace {

/// In the child: no exception may bring it back into the other tests.
[[noreturn]] void attempt_and_exit(Sandbox& sandbox, const std::function<long()>& action) noexcept {
  if (sandbox.enter() != 0) ::_exit(255);
  ::_exit(action() >= 0 ? 0 : errno);
}

bool is_missing(std::string_view part) {
  return Sandbox::missing().find(part) != std::string::npos;
}

/// What a process could try, each in a child of its own that has entered the sandbox.
class SandboxTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(inside_);
    write_file(outside_, "secret");
  }
  /// The errno that `action` leaves inside, 0 when it succeeds (returns 0 or more).
  int tried(const std::function<long()>& action) {
    const FileDescriptor program(::open("/proc/self/exe", O_PATH | O_CLOEXEC));
    Sandbox sandbox(inside_, program.get());
    const pid_t child = ::fork();
    if (child == 0) {
      attempt_and_exit(sandbox, action);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  int tried_to_open(const std::filesystem::path& path, int flags) {
    return tried([&] { return ::open(path.c_str(), flags, 0644); });
  }

  TemporaryFolder data_;
  std::filesystem::path inside_ = data_.path() / "job";
  std::filesystem::path outside_ = data_.path() / "secret";
};

TEST_F(SandboxTest, WritesReadsAndRenamesInTheJobsFolder) {
  EXPECT_EQ(tried([&] {
              const int file = ::open((inside_ / "a").c_str(), O_CREAT | O_EXCL | O_WRONLY, 0644);
              if (file < 0 || ::write(file, "x", 1) != 1 || ::fsync(file) != 0) return -1;
              if (::rename((inside_ / "a").c_str(), (inside_ / "b").c_str()) != 0) return -1;
              if (::mkdir((inside_ / "frames").c_str(), 0755) != 0) return -1;
              return ::open(inside_.c_str(), O_RDONLY | O_DIRECTORY);
            }),
            0);
  EXPECT_EQ(read_file(inside_ / "b"), "x");
}

class LandlockTest : public SandboxTest {
 protected:
  void SetUp() override {
    SandboxTest::SetUp();
    if (is_missing("Landlock")) GTEST_SKIP() << "this system has no Landlock";
  }
};

class SeccompTest : public SandboxTest {
 protected:
  void SetUp() override {
    SandboxTest::SetUp();
    if (is_missing("seccomp")) GTEST_SKIP() << "this system has no seccomp";
    if (SLUICE_SANITIZED) GTEST_SKIP() << "sanitizers trace their process: no filter with them";
  }
};

TEST_F(LandlockTest, WritesNowhereElse) {
  EXPECT_EQ(tried_to_open(outside_, O_WRONLY), EACCES);
  EXPECT_EQ(tried_to_open(data_.path() / "new", O_WRONLY | O_CREAT), EACCES);
  EXPECT_EQ(tried_to_open(inside_ / ".." / "new", O_WRONLY | O_CREAT), EACCES);
  EXPECT_EQ(tried([&] { return ::unlink(outside_.c_str()); }), EACCES);
  EXPECT_EQ(tried([&] { return ::mkdir((data_.path() / "d").c_str(), 0755); }), EACCES);
  EXPECT_EQ(read_file(outside_), "secret");
}

TEST_F(LandlockTest, IsNotLedAstrayByLinks) {
  std::filesystem::create_symlink(outside_, inside_ / "link");
  EXPECT_EQ(tried_to_open(inside_ / "link", O_WRONLY), EACCES);
  EXPECT_NE(tried([&] { return ::link(outside_.c_str(), (inside_ / "hard").c_str()); }), 0);
}

TEST_F(LandlockTest, ReadsNoOtherJobAndNoPasswords) {
  EXPECT_EQ(tried_to_open(outside_, O_RDONLY), EACCES);
  EXPECT_EQ(tried_to_open("/etc/passwd", O_RDONLY), EACCES);
  EXPECT_EQ(tried_to_open("/proc/1/environ", O_RDONLY), EACCES);
}

TEST_F(SeccompTest, OpensNoSocket) {
  for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK}) {
    EXPECT_EQ(tried([&] { return ::socket(family, SOCK_STREAM, 0); }), EPERM) << family;
  }
}

TEST_F(SeccompTest, StartsNoProgram) {
  char* const arguments[] = {nullptr};
  EXPECT_EQ(tried([&] { return ::execve("/bin/true", arguments, arguments); }), EPERM);
  EXPECT_EQ(tried([&] {
              const int file = ::open("/proc/self/exe", O_PATH);
              return ::syscall(SYS_execveat, file, "", arguments, arguments, AT_EMPTY_PATH);
            }),
            EPERM);
}

TEST_F(SeccompTest, TracesAndSignalsNobodyElse) {
  const pid_t own = ::getpid();
  EXPECT_EQ(tried([&] { return ::kill(own, 0); }), EPERM);
  EXPECT_EQ(tried([&] { return ::syscall(SYS_tgkill, own, own, 0); }), EPERM);
  EXPECT_EQ(tried([&] { return ::ptrace(PTRACE_ATTACH, own, nullptr, nullptr); }), EPERM);
}

TEST_F(SeccompTest, RaisesNoLimitButReadsThem) {
  EXPECT_EQ(tried([] {
              rlimit limits{};
              return ::getrlimit(RLIMIT_NOFILE, &limits);
            }),
            0);
  EXPECT_EQ(tried([] {
              const rlimit limits{2000, 2000};
              return ::setrlimit(RLIMIT_NOFILE, &limits);
            }),
            EPERM);
}

TEST_F(SeccompTest, MakesThreadsButNoNamespaces) {
  EXPECT_EQ(tried([] { return ::unshare(CLONE_NEWUSER); }), EPERM);
  EXPECT_EQ(tried([] {
              pthread_t thread{};
              const auto nothing = [](void*) -> void* { return nullptr; };
              const int error = ::pthread_create(&thread, nullptr, nothing, nullptr);
              if (error == 0) ::pthread_join(thread, nullptr);
              errno = error;
              return error == 0 ? 0 : -1;
            }),
            0);
}

TEST_F(SeccompTest, AbortsWithItsOwnSignal) {
  EXPECT_EQ(tried([]() -> long { std::abort(); }), 1000 + SIGABRT);
}

}  // namespace
}  // namespace sluice::test

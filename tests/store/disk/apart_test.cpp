#include "engine/store/disk/apart.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <random>
#include <string>

#include "engine/store/disk/trailer.hpp"
#include "engine/store/files/checkpoint_io.hpp"
#include "engine/store/files/inspect.hpp"
#include "engine/store/files/series_file.hpp"
#include "engine/store/files/snapshot_io.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

std::string death_of(const std::function<std::string()>& work, const ApartLimits& limits = {}) {
  try {
    return "none, but: " + work_apart(limits, work);
  } catch (const ApartFailure& failure) {
    return failure.what();
  }
}

TEST(Apart, GivesWhatTheWorkReturns) {
  const std::string large(3'000'000, 'x');
  EXPECT_EQ(work_apart({}, [&] { return large; }), large);
  EXPECT_EQ(work_apart({}, [] { return std::string(); }), "");
}

TEST(Apart, GivesWayToOthersWhereThatIsAskedFor) {
  const auto niceness = [] { return std::to_string(::getpriority(PRIO_PROCESS, 0)); };
  const std::string own = niceness();
  EXPECT_EQ(work_apart({}, niceness), own);
  ApartLimits limits;
  limits.nice = 3;
  EXPECT_EQ(work_apart(limits, niceness), std::to_string(std::min(19, std::stoi(own) + 3)));
}

TEST(Apart, ThrowsHereWhatTheWorkThrowsThere) {
  const std::string said = expect_fault(StorageFault::disk_full, [] {
    (void)work_apart(
        {}, []() -> std::string { throw StorageError(StorageFault::disk_full, "no room"); });
  });
  EXPECT_EQ(said, "no room");
  EXPECT_THROW((void)work_apart({}, []() -> std::string { throw std::out_of_range("far"); }),
               std::runtime_error);
}

TEST(Apart, OutlivesWorkThatDiesSpinsGrowsOrSaysNothing) {
  EXPECT_NE(death_of([] {
              ::raise(SIGSEGV);
              return std::string();
            }).find("signal 11"),
            std::string::npos);
  ApartLimits short_lived;
  short_lived.core_seconds = 1.0;
  EXPECT_NE(death_of(
                []() -> std::string {
                  for (const volatile bool go_on = true; go_on;) {
                  }
                  return {};
                },
                short_lived)
                .find("1 s of a core"),
            std::string::npos);
  short_lived.patience = 0.1;
  EXPECT_NE(death_of(
                []() -> std::string {
                  for (;;) ::pause();
                },
                short_lived)
                .find("not done after 0.1 s"),
            std::string::npos);
  EXPECT_NE(death_of([]() -> std::string { ::_exit(0); }).find("without an answer"),
            std::string::npos);
  short_lived = {};
  short_lived.output = 1000;
  EXPECT_NE(death_of([] { return std::string(2000, 'x'); }, short_lived).find("over 1000 bytes"),
            std::string::npos);
}

TEST(Apart, TriesOnceMoreWhenOthersKilledIt) {
  const TemporaryFolder folder;
  const auto kill_the_first = [&] {
    if (::rmdir((folder / "first").c_str()) == 0) ::raise(SIGKILL);
    return std::string("done");
  };
  fs::create_directory(folder / "first");
  EXPECT_EQ(work_apart({}, kill_the_first), "done");
  EXPECT_NE(death_of([]() -> std::string {
              ::raise(SIGKILL);
              return {};
            }).find("signal 9"),
            std::string::npos);
}

TEST(Apart, LeavesWishesToStopToItsParent) {
  for (const int wish : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(work_apart({},
                         [&] {
                           ::raise(wish);
                           return std::string("done");
                         }),
              "done");
  }
}

TEST(Apart, LetsTheWorkWriteNoFileAndKeepsItFromTheFilesThatAreOpenHere) {
  const TemporaryFolder folder;
  const int open_here = ::dup(STDOUT_FILENO);
  EXPECT_EQ(work_apart({}, [&] { return std::to_string(::lseek(open_here, 0, SEEK_CUR)); }), "-1");
  ::close(open_here);
  EXPECT_NE(death_of([&] {
              write_bytes(folder / "file", make_trailer({}).encode());
              return std::string();
            }).find("signal 25"),
            std::string::npos);
}

TEST(Apart, RunsAProgramInAFolderAndTellsWhatItSaid) {
  const TemporaryFolder folder;
  const ApartEnd end =
      program_apart({}, "/bin/sh", folder.path(), {"-c", "pwd; echo why >&2; exit 3"});
  EXPECT_EQ(end.output, folder.path().string() + "\n");
  EXPECT_EQ(end.errors, "why\n");
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.death, "");
}

/// Files that were altered by somebody who knows how to sum them.
class MadeToHurt : public testing::Test {
 protected:
  /// Whether the file is read, refused or neither.
  void expect_survival(const fs::path& path, const std::function<void()>& read) {
    const Bytes good = read_bytes(path);
    const ByteSpan image = std::span(good).first(good.size() - Trailer::kSize);
    std::mt19937_64 random(20240607);
    for (int n = 0; n < kCopies; ++n) {
      Bytes altered(image.begin(), image.end());
      for (std::size_t flips = 1 + random() % 3; flips > 0; --flips) {
        altered[random() % altered.size()] ^= static_cast<std::byte>(1U << (random() % 8));
      }
      const auto trailer = make_trailer(altered).encode();
      altered.insert(altered.end(), trailer.begin(), trailer.end());
      write_bytes(path, altered);
      try {
        read();
        ++read_;
      } catch (const StorageError&) {
        ++refused_;
      }
    }
  }

  static constexpr int kCopies = 60;
  TemporaryFolder folder_;
  int read_ = 0;
  int refused_ = 0;
};

TEST_F(MadeToHurt, SeriesAreReadOrRefused) {
  const fs::path path = folder_ / "series.h5";
  write_series(path, make_samples());
  expect_survival(path, [&] { (void)read_harmless(path, [&] { return read_series(path); }); });
  EXPECT_EQ(read_ + refused_, kCopies);
  EXPECT_GT(refused_, 0);
}

TEST_F(MadeToHurt, CheckpointsAndFramesAreInspected) {
  const fs::path checkpoint = write_checkpoint(folder_.path(), make_checkpoint(100));
  expect_survival(checkpoint, [&] { (void)inspect_file(checkpoint); });
  const fs::path frame = folder_ / "frame.h5";
  write_snapshot(frame, make_test_snapshot(50));
  expect_survival(frame, [&] { (void)inspect_file(frame); });
  EXPECT_EQ(read_, 2 * kCopies) << "what is wrong is part of an inspection";
}

}  // namespace
}  // namespace sluice::test

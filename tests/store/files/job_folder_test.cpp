#include "engine/store/files/job_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string>

#include "engine/store/disk/publish.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

Names names_of(const std::vector<fs::path>& paths) {
  Names names;
  for (const fs::path& path : paths) {
    names.push_back(path.filename().string());
  }
  return names;
}

void damage(const fs::path& path) {
  Bytes bytes = read_bytes(path);
  bytes[bytes.size() / 2] ^= std::byte{4};
  write_bytes(path, bytes);
}

TEST(JobFolder, IsMadeWithItsSceneAndOpenedAgain) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a" / "b";
  {
    const JobFolder job = JobFolder::create(path, "{\"name\":1}");
    EXPECT_EQ(job.scene_text(), "{\"name\":1}");
    EXPECT_EQ(names_in(path), (Names{"frames", "lock", "scene.json"}));
  }
  EXPECT_TRUE(JobFolder::holds_job(path));
  EXPECT_EQ(JobFolder::open(path).scene_text(), "{\"name\":1}");
}

TEST(JobFolder, NamesItsFilesInOnePlace) {
  const JobPaths paths("job");
  EXPECT_EQ(paths.checkpoint(42), fs::path("job/checkpoint-000000000042.h5"));
  EXPECT_EQ(paths.frame(3), fs::path("job/frames/frame-000003.h5"));
  EXPECT_EQ(paths.scene(), fs::path("job/scene.json"));
  EXPECT_EQ(paths.series(), fs::path("job/series.h5"));
  EXPECT_TRUE(paths.checkpoints().empty());
}

TEST(JobFolder, WhoseMakingWasCutShortIsMadeAgain) {
  const TemporaryFolder folder;
  std::ofstream(folder / "lock") << "4711\n";
  std::ofstream(folder / ".scene.json.4711.0.tmp") << "{";
  const JobFolder job = JobFolder::create(folder.path(), "{}");
  EXPECT_EQ(names_in(folder.path()), (Names{"frames", "lock", "scene.json"}));
}

TEST(JobFolder, IsNotMadeWhereAJobOrAnythingElseIs) {
  const TemporaryFolder folder;
  { const JobFolder job = JobFolder::create(folder / "job", "{}"); }
  expect_fault(StorageFault::already_exists,
               [&] { (void)JobFolder::create(folder / "job", "{}"); });
  fs::create_directory(folder / "photos");
  std::ofstream(folder / "photos/cat.png") << "cat";
  expect_fault(StorageFault::not_ours, [&] { (void)JobFolder::create(folder / "photos", "{}"); });
  EXPECT_EQ(names_in(folder / "photos"), Names{"cat.png"});
  std::ofstream(folder / "photos/lock") << "a file of someone else";
  expect_fault(StorageFault::not_ours, [&] { (void)JobFolder::create(folder / "photos", "{}"); });
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW((void)JobFolder::create(folder / "file", "{}"), StorageError);
  EXPECT_THROW((void)JobFolder::create(folder / "file" / "below", "{}"), StorageError);
}

TEST(JobFolder, ThatIsNoneOfOursIsNotOpened) {
  const TemporaryFolder folder;
  expect_fault(StorageFault::not_ours, [&] { (void)JobFolder::open(folder.path()); });
  expect_fault(StorageFault::not_ours, [&] { (void)JobFolder::open(folder / "missing"); });
  EXPECT_TRUE(names_in(folder.path()).empty());
  fs::create_directory(folder / "scene.json");
  expect_fault(StorageFault::not_ours, [&] { (void)JobFolder::open(folder.path()); });
}

TEST(JobFolder, WithAnOddLockFileIsRefused) {
  const TemporaryFolder folder;
  { const JobFolder job = JobFolder::create(folder / "job", "{}"); }
  const fs::path lock = JobPaths(folder / "job").lock();
  std::ofstream(folder / "precious") << "keep me";
  const auto refuse = [&] {
    expect_fault(StorageFault::not_ours, [&] { (void)JobFolder::open(folder / "job"); });
    fs::remove(lock);
  };
  fs::remove(lock);
  fs::create_symlink(folder / "precious", lock);
  refuse();
  fs::create_symlink(folder / "nowhere", lock);
  refuse();
  fs::create_hard_link(folder / "precious", lock);
  refuse();
  fs::create_directory(lock);
  refuse();
  ASSERT_EQ(::mkfifo(lock.c_str(), 0600), 0);
  refuse();
  EXPECT_EQ(read_text(folder / "precious", 100), "keep me");
  EXPECT_NO_THROW((void)JobFolder::open(folder / "job"));
}

TEST(JobFolder, IsUsedByOneProcessAtATime) {
  const TemporaryFolder folder;
  std::optional<JobFolder> job = JobFolder::create(folder / "job", "{}");
  const std::string message =
      expect_fault(StorageFault::locked, [&] { (void)JobFolder::open(folder / "job"); });
  EXPECT_NE(message.find("process " + std::to_string(::getpid())), std::string::npos) << message;
  const auto open_it = [&] {
    try {
      (void)JobFolder::open(folder / "job");
      return 0;
    } catch (const StorageError& error) {
      return error.fault() == StorageFault::locked ? 7 : 1;
    }
  };
  EXPECT_EQ(in_child(open_it), 7);
  job.reset();
  EXPECT_EQ(in_child(open_it), 0);
}

TEST(JobFolder, IsFreeAgainWhenItsHolderIsKilled) {
  const TemporaryFolder folder;
  { const JobFolder job = JobFolder::create(folder / "job", "{}"); }
  EXPECT_EQ(in_child([&] {
              const JobFolder job = JobFolder::open(folder / "job");
              return ::raise(SIGKILL);
            }),
            -1);
  EXPECT_NO_THROW((void)JobFolder::open(folder / "job"));
}

TEST(JobFolder, ThatCannotBeWrittenInIsRefused) {
  if (::geteuid() != 0) {
    GTEST_SKIP() << "needs the right to become another user";
  }
  const TemporaryFolder folder;
  { const JobFolder job = JobFolder::create(folder / "job", "{}"); }
  fs::permissions(folder.path(), fs::perms{0755});
  constexpr uid_t kNobody = 65534;
  const auto as_nobody = [&](const auto& action) {
    return in_child([&] {
      if (::setuid(kNobody) != 0) {
        return 1;
      }
      try {
        action();
        return 0;
      } catch (const StorageError& error) {
        return error.fault() == StorageFault::unwritable ? 5 : 2;
      }
    });
  };
  EXPECT_EQ(as_nobody([&] { (void)JobFolder::open(folder / "job"); }), 5);
  EXPECT_EQ(as_nobody([&] { (void)JobFolder::create(folder / "new", "{}"); }), 5);
}

TEST(JobFolder, RemovesWhatAKilledProcessLeftWhenOpened) {
  const TemporaryFolder folder;
  { const JobFolder job = JobFolder::create(folder / "job", "{}"); }
  const JobPaths paths(folder / "job");
  std::ofstream(paths.root() / ".checkpoint-000000000005.h5.1.0.tmp") << "half";
  std::ofstream(paths.frames() / ".frame-000001.h5.1.0.tmp") << "half";
  const JobFolder job = JobFolder::open(folder / "job");
  EXPECT_EQ(names_in(paths.root()), (Names{"frames", "lock", "scene.json"}));
  EXPECT_TRUE(names_in(paths.frames()).empty());
}

TEST(Restore, OfAJobWithoutCheckpointsFindsNone) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  EXPECT_EQ(job.newest_checkpoint({}), std::nullopt);
}

TEST(Restore, TakesTheNewestCheckpoint) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  for (const std::uint64_t step : {5U, 1000U, 20U}) {
    job.write_checkpoint(make_checkpoint(step));
  }
  const std::optional<Restored> restored =
      job.newest_checkpoint({make_checkpoint(0).scene_hash, {}});
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->path, job.paths().checkpoint(1000));
  EXPECT_TRUE(same_bits(restored->checkpoint, make_checkpoint(1000)));
  EXPECT_TRUE(restored->rejected.empty());
}

TEST(Restore, PutsDamagedOnesAsideWithTheReasonAndTakesTheOneBefore) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  for (const std::uint64_t step : {10U, 20U, 30U}) {
    job.write_checkpoint(make_checkpoint(step));
  }
  damage(job.paths().checkpoint(30));
  fs::resize_file(job.paths().checkpoint(20), 4096);
  const std::optional<Restored> restored = job.newest_checkpoint({});
  ASSERT_TRUE(restored);
  EXPECT_TRUE(same_bits(restored->checkpoint, make_checkpoint(10)));
  ASSERT_EQ(restored->rejected.size(), 2U);
  EXPECT_NE(restored->rejected[0].find("checkpoint-000000000030.h5"), std::string::npos);
  EXPECT_EQ(names_of(job.paths().bad_checkpoints()),
            (Names{"checkpoint-000000000020.h5.bad", "checkpoint-000000000030.h5.bad"}));
  EXPECT_EQ(names_of(job.paths().checkpoints()), Names{"checkpoint-000000000010.h5"});
}

TEST(Restore, RefusesACheckpointUnderTheNameOfAnotherStep) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  job.write_checkpoint(make_checkpoint(10));
  fs::copy_file(job.paths().checkpoint(10), job.paths().checkpoint(99));
  const std::optional<Restored> restored = job.newest_checkpoint({});
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->checkpoint.solver.step, 10U);
  EXPECT_EQ(restored->rejected.size(), 1U);
}

TEST(Restore, NeverBeginsAgainSilentlyWhenNoCheckpointCanBeUsed) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  job.write_checkpoint(make_checkpoint(10));
  damage(job.paths().checkpoint(10));
  expect_fault(StorageFault::no_usable_checkpoint, [&] { (void)job.newest_checkpoint({}); });
  // Nor the next time, when only the file that was put aside tells of it.
  const std::string message =
      expect_fault(StorageFault::no_usable_checkpoint, [&] { (void)job.newest_checkpoint({}); });
  EXPECT_NE(message.find(".bad"), std::string::npos) << message;
}

TEST(Restore, LeavesCheckpointsOfAnotherSceneAlone) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  job.write_checkpoint(make_checkpoint(10));
  job.write_checkpoint(make_checkpoint(20));
  expect_fault(StorageFault::wrong_scene, [&] {
    (void)job.newest_checkpoint({std::string("other"), {}});
  });
  EXPECT_EQ(job.paths().checkpoints().size(), 2U);
  EXPECT_TRUE(job.paths().bad_checkpoints().empty());
}

TEST(Restore, TakesTheOneBeforeWhenAWriterWasKilled) {
  const TemporaryFolder folder;
  { JobFolder::create(folder / "job", "{}").write_checkpoint(make_checkpoint(10)); }
  class Killer : public FileSystem {
   public:
    int rename(const fs::path&, const fs::path&) override { return ::raise(SIGKILL); }
  };
  EXPECT_EQ(in_child([&] {
              Killer killer;
              JobFolder::open(folder / "job", killer).write_checkpoint(make_checkpoint(20));
              return 0;
            }),
            -1);
  JobFolder job = JobFolder::open(folder / "job");
  EXPECT_EQ(job.newest_checkpoint({})->checkpoint.solver.step, 10U);
  EXPECT_EQ(names_in(folder / "job"),
            (Names{"checkpoint-000000000010.h5", "frames", "lock", "scene.json"}));
}

std::vector<std::uint64_t> steps_left(const JobFolder& job) {
  std::vector<std::uint64_t> steps;
  for (const fs::path& path : job.paths().checkpoints()) {
    steps.push_back(step_of_checkpoint_name(path.filename().string()).value());
  }
  return steps;
}

TEST(Prune, KeepsTheTwoNewestAndAnOlderOneThatMovesOn) {
  const TemporaryFolder folder;
  JobFolder job = JobFolder::create(folder / "job", "{}");
  using Steps = std::vector<std::uint64_t>;
  const auto write_and_prune = [&](std::uint64_t step) {
    job.write_checkpoint(make_checkpoint(step, 2));
    EXPECT_TRUE(job.prune().empty());
    return steps_left(job);
  };
  EXPECT_EQ(write_and_prune(10), Steps{10});
  EXPECT_EQ(write_and_prune(20), (Steps{20, 10}));
  EXPECT_EQ(write_and_prune(30), (Steps{30, 20, 10}));
  // 10 lies before half of 40: 20 takes its place.
  EXPECT_EQ(write_and_prune(40), (Steps{40, 30, 20}));
  EXPECT_EQ(write_and_prune(41), (Steps{41, 40, 30}));
  EXPECT_EQ(write_and_prune(42), (Steps{42, 41, 30}));
  EXPECT_EQ(write_and_prune(60), (Steps{60, 42, 30}));
  EXPECT_EQ(write_and_prune(61), (Steps{61, 60, 42}));
  EXPECT_EQ(write_and_prune(1000), (Steps{1000, 61, 60}));
}

TEST(Prune, CountsOnlyCheckpointsThatAreWhole) {
  const TemporaryFolder folder;
  {
    JobFolder job = JobFolder::create(folder / "job", "{}");
    for (const std::uint64_t step : {10U, 20U, 30U, 40U, 50U}) {
      job.write_checkpoint(make_checkpoint(step, 2));
    }
  }
  JobFolder job = JobFolder::open(folder / "job");
  damage(job.paths().checkpoint(50));
  damage(job.paths().checkpoint(40));
  const std::vector<std::string> rejected = job.prune();
  ASSERT_EQ(rejected.size(), 2U);
  EXPECT_NE(rejected[0].find("it is kept as checkpoint-000000000050.h5.bad"), std::string::npos)
      << rejected[0];
  EXPECT_EQ(steps_left(job), (std::vector<std::uint64_t>{30, 20, 10}));
  EXPECT_EQ(job.paths().bad_checkpoints().size(), 2U);
}

}  // namespace
}  // namespace sluice::test

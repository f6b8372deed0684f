#include "engine/store/files/new_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <string>
#include <vector>

#include "engine/store/files/job_folder.hpp"
#include "tests/store/disk/faulty_file_system.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

constexpr std::string_view kScene = "{\"name\": \"a\"}\n";
const Names kComplete{"frames", "job.json", "scene.json"};

void publish_in(const TemporaryFolder& folder, FileSystem& system = FileSystem::real()) {
  publish_job_folder(folder / "job", kScene, {{"job.json", "{}\n"}}, system);
}

TEST(NewFolder, HoldsWhatItWasGivenAndIsAJob) {
  const TemporaryFolder folder;
  publish_in(folder);
  EXPECT_EQ(names_in(folder.path()), Names{"job"});
  EXPECT_EQ(names_in(folder / "job"), kComplete);
  EXPECT_EQ(read_text(folder / "job/job.json", 100), "{}\n");
  EXPECT_EQ(JobFolder::open(folder / "job").scene_text(), kScene);
}

TEST(NewFolder, IsNotThereWhicheverStepFails) {
  for (const Step step : {Step::create, Step::write, Step::sync, Step::close, Step::rename}) {
    for (const int error : {ENOSPC, EIO}) {
      const TemporaryFolder folder;
      FaultyFileSystem system(step, [error] { return error; });
      const std::string message =
          expect_fault(error == EIO ? StorageFault::io : StorageFault::disk_full,
                       [&] { publish_in(folder, system); });
      EXPECT_NE(message.find((folder / "job").string()), std::string::npos) << message;
      EXPECT_TRUE(names_in(folder.path()).empty());
    }
  }
}

TEST(NewFolder, IsNotThereWhenItsNameCannotBeBroughtToTheDisk) {
  int after = 1;  // The first sync of a folder comes before the rename, the second after it
  const TemporaryFolder folder;
  FaultyFileSystem system(Step::sync_folder, [&after] { return after-- > 0 ? 0 : EIO; });
  expect_fault(StorageFault::io, [&] { publish_in(folder, system); });
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(NewFolder, IsNotThereWhenAFileReadsBackWrong) {
  const TemporaryFolder folder;
  LyingFileSystem system;
  expect_fault(StorageFault::io, [&] { publish_in(folder, system); });
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(NewFolder, IsSyncedWithItsFilesBeforeTheRenameAndWithItsNameAfterIt) {
  const TemporaryFolder folder;
  NotingFileSystem system;
  publish_in(folder, system);
  EXPECT_EQ(system.calls, "file file folder rename folder ");
}

TEST(NewFolder, KilledAtAnyStepIsNotThereOrWholeAndLeavesNothingBehind) {
  for (const Step step :
       {Step::create, Step::write, Step::sync, Step::close, Step::rename, Step::sync_folder}) {
    int after = 1;  // The first sync of a folder comes before the rename, the second after it
    const TemporaryFolder folder;
    const int status = in_child([&] {
      FaultyFileSystem system(
          step, [&] { return step == Step::sync_folder && after-- > 0 ? 0 : ::raise(SIGKILL); });
      publish_in(folder, system);
      return 0;
    });
    ASSERT_EQ(status, -1);
    const bool whole = step == Step::sync_folder;
    EXPECT_EQ(remove_unfinished_folders(folder.path()), whole ? 0U : 1U);
    EXPECT_EQ(fs::exists(folder / "job"), whole);
    EXPECT_EQ(names_in(folder.path()), whole ? Names{"job"} : Names{});
    EXPECT_EQ(whole ? names_in(folder / "job") : kComplete, kComplete);
  }
}

TEST(NewFolder, IsRefusedWhereAnythingIsInItsPlace) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "job");
  expect_fault(StorageFault::already_exists, [&] { publish_in(folder); });
  fs::remove(folder / "job");
  fs::create_symlink("nowhere", folder / "job");
  expect_fault(StorageFault::already_exists, [&] { publish_in(folder); });
  EXPECT_TRUE(fs::is_symlink(folder / "job"));
}

TEST(NewFolder, NeedsItsParent) {
  const TemporaryFolder folder;
  expect_fault(StorageFault::io, [&] { publish_job_folder(folder / "missing/job", kScene, {}); });
}

TEST(NewFolder, LeftoversOfOthersStay) {
  const TemporaryFolder folder;
  const Names others{".hidden", ".link.new", ".text.new", "job.new"};
  fs::create_directory(folder / ".hidden");
  fs::create_directory_symlink(".hidden", folder / ".link.new");
  write_bytes(folder / ".text.new", {});
  fs::create_directory(folder / "job.new");
  fs::create_directories(folder / ".job.new/frames");
  EXPECT_EQ(remove_unfinished_folders(folder.path()), 1U);
  EXPECT_EQ(names_in(folder.path()), others);
  EXPECT_EQ(remove_unfinished_folders(folder / "no such folder"), 0U);
}

}  // namespace
}  // namespace sluice::test

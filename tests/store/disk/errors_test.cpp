#include "engine/store/disk/errors.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <new>

#include "engine/store/disk/file_system.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

TEST(StorageErrorOf, AFileSystemErrorHasItsPathItsMeaningAndItsFault) {
  const struct {
    std::errc error;
    StorageFault fault;
  } cases[] = {{std::errc::no_space_on_device, StorageFault::disk_full},
               {std::errc::permission_denied, StorageFault::unwritable},
               {std::errc::read_only_file_system, StorageFault::unwritable},
               {std::errc::io_error, StorageFault::io},
               {std::errc::not_enough_memory, StorageFault::io}};
  for (const auto& [error, fault] : cases) {
    const std::error_code code = std::make_error_code(error);
    try {
      storing([&] { throw fs::filesystem_error("cannot get file status", "job/frames", code); });
      FAIL() << code.message();
    } catch (const StorageError& said) {
      EXPECT_EQ(said.fault(), fault) << code.message();
      EXPECT_TRUE(std::string(said.what()).starts_with("job/frames: ")) << said.what();
      EXPECT_NE(std::string(said.what()).find(code.message()), std::string::npos) << said.what();
    }
  }
}

TEST(ToldOutside, AMessageNamesTheFolderOncePerPath) {
  EXPECT_EQ(told_outside("job", "./frames/a: cannot write (./b)"),
            "job/frames/a: cannot write (job/b)");
  EXPECT_EQ(told_outside("./job", told_outside("./job", "./a: x")), "./job/a: x");
  EXPECT_EQ(told_outside("job", "../a: x."), "../a: x.");
  EXPECT_EQ(told_outside(".", "./a: x"), "./a: x");
  EXPECT_EQ(told_outside("/", "./a: x"), "/a: x");
}

TEST(StorageErrorOf, AWantOfMemoryForAFileIsAFailureThatPasses) {
  expect_fault(StorageFault::io, [] { storing([] { throw std::bad_alloc(); }); });
}

TEST(ALook, TellsWhatIsMissingFromWhatCannotBeLookedAt) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_present(folder / "none"));
  std::ofstream(folder / "file") << "x";
  EXPECT_TRUE(is_present(folder / "file"));
  EXPECT_FALSE(is_present(folder / "file" / "inside"));  // no folder, so nothing is in it
  // A name that the system refuses to look up: whether it is there is not known.
  expect_fault(StorageFault::io, [&] { (void)is_present(folder / std::string(300, 'n')); });
}

TEST(ALook, ListsWhatAFolderHoldsAndNothingWhereThereIsNone) {
  const TemporaryFolder folder;
  std::ofstream(folder / "one") << "1";
  fs::create_directory(folder / "two");
  EXPECT_EQ(entries_of(folder.path()).size(), 2U);
  EXPECT_TRUE(entries_of(folder / "none").empty());
  expect_fault(StorageFault::corrupt, [&] { (void)entries_of(folder / "one"); });
}

}  // namespace
}  // namespace sluice::test

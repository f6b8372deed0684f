#include "engine/store/disk/publish.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>
#include <string>

#include "engine/store/disk/trailer.hpp"
#include "tests/store/disk/faulty_file_system.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

Bytes pattern(std::size_t count, int seed) {
  Bytes bytes(count);
  for (std::size_t i = 0; i < count; ++i) {
    bytes[i] = static_cast<std::byte>((i * 31 + i / 251 + static_cast<std::size_t>(seed)) & 0xFFU);
  }
  return bytes;
}

TEST(Publish, KeepsEveryByteAndAddsNothingButTheTrailer) {
  const TemporaryFolder folder;
  for (const std::size_t count : {0UL, 1UL, 4095UL, 3000000UL}) {
    const Bytes image = pattern(count, 1);
    publish(folder / "file", image, Durability::power_cut);
    EXPECT_EQ(read_verified(folder / "file"), image);
    EXPECT_EQ(fs::file_size(folder / "file"), count + Trailer::kSize);
    EXPECT_NO_THROW(verify(folder / "file"));
  }
  EXPECT_EQ(names_in(folder.path()), Names{"file"});
}

TEST(Publish, WritesATextAsItIs) {
  const TemporaryFolder folder;
  publish_text(folder / "a.json", "{}\n");
  publish_text(folder / "empty", "");
  EXPECT_EQ(read_text(folder / "a.json", 100), "{}\n");
  EXPECT_EQ(read_text(folder / "empty", 100), "");
}

TEST(WriteText, GoesThroughALinkAndLeavesIt) {
  const TemporaryFolder folder;
  publish_text(folder / "there", "a longer text before");
  fs::create_symlink("there", folder / "link");
  fs::create_symlink("link", folder / "link of a link");
  fs::create_symlink("new", folder / "dangling");
  write_text(folder / "link of a link", "one");
  write_text(folder / "dangling", "two");
  EXPECT_EQ(read_text(folder / "there", 100), "one");
  EXPECT_EQ(read_text(folder / "new", 100), "two");
  for (const char* name : {"link", "link of a link", "dangling"}) {
    EXPECT_TRUE(fs::is_symlink(folder / name)) << name;
  }
}

TEST(WriteText, WritesIntoWhatIsNoRegularFile) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const FileDescriptor reader(::open(pipe.c_str(), O_RDONLY | O_NONBLOCK));
  write_text(pipe, "text");
  std::array<char, 8> read{};
  EXPECT_EQ(::read(reader.get(), read.data(), read.size()), 4);
  EXPECT_TRUE(fs::is_fifo(pipe));
  fs::create_directory(folder / "folder");
  expect_fault(StorageFault::io, [&] { write_text(folder / "folder", "text"); });
  EXPECT_EQ(names_in(folder.path()), (Names{"folder", "pipe"}));
}

TEST(WriteText, LeavesADeviceADevice) {
  const TemporaryFolder folder;
  const fs::path node = folder / "null";
  if (::mknod(node.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) GTEST_SKIP() << "needs root";
  write_text(node, "text");
  EXPECT_TRUE(fs::is_character_file(node));
}

TEST(WriteText, ReplacesARegularFileWhole) {
  const TemporaryFolder folder;
  publish_text(folder / "file", "old");
  FaultyFileSystem faulty(Step::rename, [] { return ENOSPC; });
  expect_fault(StorageFault::disk_full, [&] { write_text(folder / "file", "new", faulty); });
  EXPECT_EQ(read_text(folder / "file", 100), "old");
  write_text(folder / "file", "new");
  write_text(folder / "another", "new");
  EXPECT_EQ(read_text(folder / "file", 100), "new");
  EXPECT_EQ(names_in(folder.path()), (Names{"another", "file"}));
}

TEST(Publish, LeavesTheOldFileAndNoTemporaryWhicheverStepFails) {
  for (const Step step : {Step::create, Step::write, Step::sync, Step::close, Step::rename}) {
    for (const int error : {ENOSPC, EDQUOT, EIO, EROFS}) {
      const TemporaryFolder folder;
      const Bytes old = pattern(5000, 1);
      publish(folder / "file", old, Durability::power_cut);
      FaultyFileSystem system(step, [error] { return error; });
      const StorageFault fault = error == EIO     ? StorageFault::io
                                 : error == EROFS ? StorageFault::unwritable
                                                  : StorageFault::disk_full;
      const std::string message = expect_fault(fault, [&] {
        publish(folder / "file", pattern(6000, 2), Durability::power_cut, system);
      });
      EXPECT_NE(message.find((folder / "file").string()), std::string::npos) << message;
      EXPECT_EQ(read_verified(folder / "file"), old);
      EXPECT_EQ(names_in(folder.path()), Names{"file"});
    }
  }
}

TEST(Publish, SaysSoWhenTheFolderCannotBeSyncedThoughTheNewFileIsWhole) {
  const TemporaryFolder folder;
  FaultyFileSystem system(Step::sync_folder, [] { return EIO; });
  expect_fault(StorageFault::io,
               [&] { publish(folder / "file", pattern(6000, 2), Durability::power_cut, system); });
  EXPECT_EQ(read_verified(folder / "file"), pattern(6000, 2));
  EXPECT_EQ(names_in(folder.path()), Names{"file"});
}

TEST(Publish, GoesOnAfterAnInterruptedOrShortWrite) {
  const TemporaryFolder folder;
  int interruptions = 3;
  FaultyFileSystem system(Step::write, [&] { return interruptions-- > 0 ? EINTR : 0; });
  publish(folder / "file", pattern(50000, 3), Durability::power_cut, system);
  EXPECT_LE(interruptions, 0);
  EXPECT_EQ(read_verified(folder / "file"), pattern(50000, 3));
}

TEST(Publish, TriesAnotherNameWhenALeftoverHasTheTemporarysName) {
  const TemporaryFolder folder;
  int collisions = 2;
  FaultyFileSystem system(Step::create, [&] { return collisions-- > 0 ? EEXIST : 0; });
  publish(folder / "file", pattern(10, 3), Durability::power_cut, system);
  EXPECT_EQ(read_verified(folder / "file"), pattern(10, 3));
}

TEST(Publish, DoesNotPutInPlaceWhatReadsBackWrong) {
  const TemporaryFolder folder;
  const Bytes old = pattern(5000, 1);
  publish(folder / "file", old, Durability::power_cut);
  LyingFileSystem system;
  for (const Durability durability : {Durability::power_cut, Durability::process_crash}) {
    expect_fault(StorageFault::io,
                 [&] { publish(folder / "file", pattern(5000, 2), durability, system); });
  }
  expect_fault(StorageFault::io, [&] { publish_text(folder / "text", "abc", system); });
  EXPECT_EQ(read_verified(folder / "file"), old);
  EXPECT_EQ(names_in(folder.path()), Names{"file"});
}

class FullFileSystem : public FileSystem {
 public:
  std::uint64_t free_bytes(const fs::path&) override { return 100; }
  int create_exclusive(const fs::path& path) override {
    ADD_FAILURE() << "began to write";
    return FileSystem::create_exclusive(path);
  }
};

TEST(Publish, DoesNotBeginWhereTheDiskHasNoRoom) {
  const TemporaryFolder folder;
  FullFileSystem system;
  const std::string message = expect_fault(StorageFault::disk_full, [&] {
    publish(folder / "file", pattern(100, 1), Durability::power_cut, system);
  });
  EXPECT_NE(message.find("148 bytes where 100 are free"), std::string::npos) << message;
}

TEST(Publish, SyncsTheFileBeforeAndTheFolderAfterTheRenameWhenItMustSurviveAPowerCut) {
  const TemporaryFolder folder;
  NotingFileSystem system;
  publish(folder / "file", pattern(10, 1), Durability::power_cut, system);
  EXPECT_EQ(system.calls, "file rename folder ");
  system.calls.clear();
  publish(folder / "file", pattern(10, 1), Durability::process_crash, system);
  EXPECT_EQ(system.calls, "rename ");
  system.calls.clear();
  publish_text(folder / "text", "abc", system);
  EXPECT_EQ(system.calls, "file rename folder ");
}

TEST(Publish, KilledAtAnyStepLeavesTheOldOrTheNewFileWhole) {
  for (const Step step :
       {Step::create, Step::write, Step::sync, Step::close, Step::rename, Step::sync_folder}) {
    const TemporaryFolder folder;
    const Bytes old = pattern(5000, 1);
    const Bytes young = pattern(6000, 2);
    publish(folder / "file", old, Durability::power_cut);
    const int status = in_child([&] {
      FaultyFileSystem system(step, [] { return ::raise(SIGKILL); });
      publish(folder / "file", young, Durability::power_cut, system);
      return 0;
    });
    ASSERT_EQ(status, -1);
    EXPECT_EQ(read_verified(folder / "file"), step == Step::sync_folder ? young : old);
    remove_leftovers(folder.path());
    EXPECT_EQ(names_in(folder.path()), Names{"file"});
  }
}

TEST(Publish, RemovesLeftoversAndNothingElse) {
  const TemporaryFolder folder;
  const Names others{".file.12.tmp", ".file.a.0.tmp", ".hidden", "file.1.2.tmp", "scene.json"};
  for (const std::string& name : others) {
    publish_text(folder / name, "x");
  }
  publish_text(folder / ".checkpoint-000000000012.h5.4711.0.tmp", "x");
  // The number of a process that lives, and even this one's: in a container numbers return at once.
  publish_text(folder / (".series.h5." + std::to_string(::getpid()) + ".3.tmp"), "x");
  fs::create_symlink(folder / "scene.json", folder / ".link.1.2.tmp");
  EXPECT_EQ(remove_leftovers(folder.path()), 2U);
  Names expected = others;
  expected.insert(expected.begin() + 3, ".link.1.2.tmp");
  EXPECT_EQ(names_in(folder.path()), expected);
  EXPECT_EQ(remove_leftovers(folder / "no such folder"), 0U);
}

bool write_line(const char* path, const std::string& line) {
  std::ofstream file(path);
  file << line << std::flush;
  return file.good();
}

/// Mounts a file system of 1 MiB on `folder` for this process alone, as root or in a user name
/// space.
bool mount_small_disk(const fs::path& folder) {
  const std::string user = std::to_string(::geteuid());
  const bool apart = (::geteuid() == 0 && ::unshare(CLONE_NEWNS) == 0) ||
                     (::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0 &&
                      write_line("/proc/self/uid_map", user + " " + user + " 1"));
  return apart && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=1m") == 0;
}

/// Finds out about the full disk only from the write itself.
class HopefulFileSystem : public FileSystem {
 public:
  std::uint64_t free_bytes(const fs::path&) override { return UINT64_MAX; }
};

enum class FullDisk { as_expected, wrong, no_mount };

/// Fills a small disk; runs in a process of its own because the mount is that process's.
FullDisk fill_small_disk(const fs::path& folder) {
  if (!mount_small_disk(folder)) {
    return FullDisk::no_mount;
  }
  const Bytes old = pattern(400000, 1);
  publish(folder / "file", old, Durability::power_cut);
  HopefulFileSystem hopeful;
  for (FileSystem* system : {&FileSystem::real(), static_cast<FileSystem*>(&hopeful)}) {
    expect_fault(StorageFault::disk_full, [&] {
      publish(folder / "file", pattern(900000, 2), Durability::power_cut, *system);
    });
    EXPECT_EQ(read_verified(folder / "file"), old);
    EXPECT_EQ(names_in(folder), Names{"file"});
  }
  return testing::Test::HasFailure() ? FullDisk::wrong : FullDisk::as_expected;
}

TEST(Publish, OnAFullDiskKeepsTheOldFileAndLeavesNoTemporary) {
  const TemporaryFolder folder;
  const int status = in_child([&] { return static_cast<int>(fill_small_disk(folder.path())); });
  if (status == static_cast<int>(FullDisk::no_mount)) {
    GTEST_SKIP() << "this machine does not let the test mount a small tmpfs";
  }
  EXPECT_EQ(status, static_cast<int>(FullDisk::as_expected));
}

TEST(Trailer, IsRefusedForAnyOtherBitThanWritten) {
  const TemporaryFolder folder;
  publish(folder / "file", pattern(100, 1), Durability::power_cut);
  const Bytes good = read_bytes(folder / "file");
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    write_bytes(folder / "file", bad);
    expect_fault(StorageFault::corrupt, [&] { (void)read_verified(folder / "file"); });
    expect_fault(StorageFault::corrupt, [&] { verify(folder / "file"); });
  }
}

TEST(Trailer, OfANewerVersionIsNotTakenForDamage) {
  const TemporaryFolder folder;
  const Bytes image = pattern(100, 1);
  Trailer trailer = make_trailer(image);
  trailer.version = 2;
  Bytes bytes = image;
  const auto encoded = trailer.encode();
  bytes.insert(bytes.end(), encoded.begin(), encoded.end());
  write_bytes(folder / "file", bytes);
  expect_fault(StorageFault::unsupported_version, [&] { (void)read_verified(folder / "file"); });
}

TEST(Trailer, RefusesFilesThatAreNoFilesWithoutWaiting) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_fault(StorageFault::corrupt, [&] { (void)read_verified(folder / "pipe"); });
  expect_fault(StorageFault::corrupt, [&] { (void)read_verified(folder.path()); });
  expect_fault(StorageFault::io, [&] { (void)read_verified(folder / "missing"); });
  write_bytes(folder / "empty", {});
  expect_fault(StorageFault::corrupt, [&] { (void)read_verified(folder / "empty"); });
}

}  // namespace
}  // namespace sluice::test

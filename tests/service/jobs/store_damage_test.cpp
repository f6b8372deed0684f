#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "service/jobs/migrate.hpp"
#include "service/jobs/sqlite_db.hpp"
#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Fault = JobStoreError::Fault;

/// Runs `action` in a process of its own. Its exit status, 99 when it threw, -1 when it was killed.
int in_process(const std::function<int()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    int result = 99;  // An exception must not go on into the parent's tests
    try {
      result = action();
    } catch (...) {
    }
    ::_exit(result);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_all(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A folder with some jobs whose service was killed.
void fill_and_die(const fs::path& data) {
  ASSERT_EQ(in_process([&] {
              JobStore store(data);
              for (int i = 0; i < 50; ++i) (void)add_job(store);
              return ::raise(SIGKILL);
            }),
            -1);
}

TEST(DataFolder, IsUsedByOneServiceAtATime) {
  const DataFolder data;
  std::optional<JobStore> store(data.path());
  const std::string message =
      expect_refusal(Fault::in_use, [&] { const JobStore second(data.path()); });
  EXPECT_NE(message.find("process " + std::to_string(::getpid())), std::string::npos) << message;
  const auto open_it = [&] {
    try {
      const JobStore other(data.path());
      return 0;
    } catch (const JobStoreError& error) {
      return error.fault() == Fault::in_use ? 7 : 1;
    }
  };
  EXPECT_EQ(in_process(open_it), 7);
  (void)add_job(*store);
  store.reset();
  EXPECT_EQ(in_process(open_it), 0);
}

TEST(DataFolder, ThatIsMissingIsMade) {
  const DataFolder data;
  JobStore store(data.path() / "a" / "b");
  EXPECT_TRUE(fs::is_directory(data.path() / "a" / "b" / "jobs"));
}

TEST(DataFolder, BehindALinkIsUsedButALinkInPlaceOfTheDataBaseIsNot) {
  const DataFolder data;
  const fs::path real = data.path() / "real";
  fs::create_directories(real / "inner");
  fs::create_directory_symlink(real, data.path() / "link");
  { const JobStore store(data.path() / "link" / "inner"); }
  EXPECT_TRUE(fs::is_regular_file(real / "inner" / "jobs.sqlite"));
  fs::rename(real / "inner" / "jobs.sqlite", real / "elsewhere");
  fs::create_symlink(real / "elsewhere", real / "inner" / "jobs.sqlite");
  EXPECT_THROW(const JobStore store(real / "inner"), JobStoreError);
}

TEST(DataFolder, ThatCannotBeOneIsRefusedWithItsPath) {
  const DataFolder data;
  write_all(data.path() / "file", "x");
  const std::string message =
      expect_refusal(Fault::io, [&] { const JobStore store(data.path() / "file" / "data"); });
  EXPECT_NE(message.find("file"), std::string::npos) << message;
  fs::create_directories(data.path() / "odd");
  fs::create_symlink(data.path() / "file", data.path() / "odd" / "lock");
  expect_refusal(Fault::io, [&] { const JobStore store(data.path() / "odd"); });
  EXPECT_EQ(read_all(data.path() / "file"), "x");
}

TEST(Migration, BringsAnEmptyFileToTheNewestVersionOnce) {
  const DataFolder data;
  write_all(data.database(), "");
  for (int start = 0; start < 2; ++start) {
    const JobStore store(data.path());
    EXPECT_TRUE(store.list({}).empty());
  }
  SqliteDb db(data.database());
  EXPECT_EQ(db.number("PRAGMA user_version"), newest_database_version());
  EXPECT_EQ(db.number("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = 'jobs' "
                      "AND sql LIKE '%STRICT%'"),
            1);
}

TEST(Journal, IsMadeVoidAfterEachWriteAndIsNoWriteAheadLog) {
  const DataFolder data;
  JobStore store(data.path());
  (void)add_job(store);
  // A journal that counts begins with the eight bytes d9d505f920a163d7 (SQLite's file format, 3).
  std::ifstream journal(data.path() / "jobs.sqlite-journal");
  std::string head(8, 'x');
  ASSERT_TRUE(journal.read(head.data(), 8));
  EXPECT_EQ(head, std::string(8, '\0'));
  EXPECT_FALSE(fs::exists(data.path() / "jobs.sqlite-wal"));
}

TEST(Migration, ThatIsCutShortIsMadeWholeAtTheNextStart) {
  const DataFolder data;
  EXPECT_EQ(in_process([&] {
              SqliteDb db(data.database());
              SqliteTransaction transaction(db);
              db.execute("CREATE TABLE jobs (id TEXT); PRAGMA user_version = 1");
              return ::raise(SIGKILL);
            }),
            -1);
  JobStore store(data.path());
  EXPECT_NO_THROW((void)add_job(store));
}

TEST(Migration, RefusesAFileOfANewerProgramAndLeavesItAlone) {
  const DataFolder data;
  { const JobStore store(data.path()); }
  {
    SqliteDb db(data.database());
    db.execute("PRAGMA user_version = 1000");
  }
  const std::string before = read_all(data.database());
  const std::string message =
      expect_refusal(Fault::newer_version, [&] { const JobStore store(data.path()); });
  EXPECT_NE(message.find("1000"), std::string::npos) << message;
  EXPECT_EQ(read_all(data.database()), before);
}

TEST(Migration, RefusesADataBaseOfAnotherProgram) {
  const DataFolder data;
  {
    SqliteDb db(data.database());
    db.execute("CREATE TABLE recipes (name TEXT)");
  }
  const std::string before = read_all(data.database());
  expect_refusal(Fault::damaged, [&] { const JobStore store(data.path()); });
  EXPECT_EQ(read_all(data.database()), before);
}

TEST(Damage, OfTheWholeFileIsNamedWithTheWayOut) {
  const DataFolder data;
  for (const std::string& text :
       {std::string("not a data base, however long it is\n"), std::string(8192, '\xff')}) {
    write_all(data.database(), text);
    const std::string message =
        expect_refusal(Fault::damaged, [&] { const JobStore store(data.path()); });
    EXPECT_NE(message.find("--rebuild"), std::string::npos) << message;
    EXPECT_EQ(read_all(data.database()), text);
  }
}

/// The pages of the index over states, filled with what no index holds.
void damage_an_index(const fs::path& file) {
  std::int64_t page = 0;
  std::int64_t size = 0;
  {
    SqliteDb db(file);
    page = db.number("SELECT rootpage FROM sqlite_schema WHERE name = 'jobs_by_state'");
    size = db.number("PRAGMA page_size");
  }
  std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
  // The cells lie at the page's end, its header at its start.
  out.seekp(page * size - 600);
  out << std::string(500, 'x');
}

TEST(Damage, InsideIsFoundAfterAnUncleanStop) {
  const DataFolder data;
  fill_and_die(data.path());
  damage_an_index(data.database());
  const std::string message =
      expect_refusal(Fault::damaged, [&] { const JobStore store(data.path()); });
  EXPECT_NE(message.find("--rebuild"), std::string::npos) << message;
  // Nor is it forgotten at the next start.
  expect_refusal(Fault::damaged, [&] { const JobStore store(data.path()); });
}

TEST(Damage, IsLookedForWhenNothingTellsOfTheLastStop) {
  const DataFolder data;
  {
    JobStore store(data.path());
    for (int i = 0; i < 50; ++i) (void)add_job(store);
  }
  damage_an_index(data.database());
  EXPECT_NO_THROW(const JobStore store(data.path())) << "a clean stop needs no check";
  fs::remove(data.path() / "lock");
  expect_refusal(Fault::damaged, [&] { const JobStore store(data.path()); });
}

TEST(Damage, ThatIsMetAtWorkIsLookedForAtTheNextStart) {
  const DataFolder data;
  {
    JobStore store(data.path());
    for (int i = 0; i < 50; ++i) (void)add_job(store);
  }
  damage_an_index(data.database());
  {
    const JobStore store(data.path());
    JobFilter queued;
    queued.state = JobState::queued;
    expect_refusal(Fault::damaged, [&] { (void)store.list(queued); });
  }
  expect_refusal(Fault::damaged, [&] { const JobStore store(data.path()); });
}

/// Submits, claims and completes jobs for ever; writes a line for each step that was acknowledged.
[[noreturn]] void work_until_killed(const fs::path& data, int out) {
  JobStore store(data);
  const auto tell = [&](char step, const std::string& id) {
    const std::string line = step + id + "\n";
    if (::write(out, line.data(), line.size()) < 0) ::_exit(1);
  };
  for (;;) {
    tell('s', add_job(store).id);
    const Job job = store.claim(1, {}).value();
    (void)store.apply(job.id, JobAction::complete, job.token, {});
    tell('c', job.id);
  }
}

std::string read_some(int in) {
  std::string text(1 << 16, '\0');
  const ssize_t count = ::read(in, text.data(), text.size());
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return text;
}

/// What such a process told before it was killed, after `bytes` of its lines had come.
std::string told_until_killed(const fs::path& data, std::size_t bytes) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      work_until_killed(data, ends[1]);
    } catch (...) {
    }
    ::_exit(1);
  }
  ::close(ends[1]);
  std::string told;
  for (std::string more = read_some(ends[0]); !more.empty(); more = read_some(ends[0])) {
    told += more;
    if (told.size() >= bytes) ::kill(child, SIGKILL);
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  return told;
}

/// Each job's row stands where its last event says.
void expect_rows_and_events_agree(const JobStore& store) {
  const std::map<JobState, std::string> expected = {
      {JobState::queued, "submitted"},
      {JobState::running, "submitted claimed"},
      {JobState::completed, "submitted claimed completed"}};
  for (const Job& job : store.list({{}, {}, "", 10000})) {
    EXPECT_EQ(history(store, job.id), expected.at(job.state));
  }
}

/// Ends what a killed process left, so that the next one claims its own jobs.
void end_all(JobStore& store) {
  while (const std::optional<Job> claimed = store.claim(1, {})) {
    (void)store.apply(claimed->id, JobAction::complete, claimed->token, {});
  }
}

TEST(Kill, InTheMiddleOfWritesLosesNothingThatWasAcknowledged) {
  const DataFolder data;
  for (std::size_t round = 0; round < 20; ++round) {
    std::istringstream told(told_until_killed(data.path(), 23 * (1 + round)));
    JobStore store(data.path());
    std::size_t checked = 0;
    for (std::string line; std::getline(told, line); ++checked) {
      const std::optional<Job> job = store.find(line.substr(1));
      ASSERT_TRUE(job);
      EXPECT_TRUE(line[0] == 's' || job->state == JobState::completed);
    }
    EXPECT_GT(checked, 0U);
    expect_rows_and_events_agree(store);
    end_all(store);
  }
}

/// Mounts a file system of 512 KiB on `folder` for this process alone.
bool mount_small_disk(const fs::path& folder) {
  return ::geteuid() == 0 && ::unshare(CLONE_NEWNS) == 0 &&
         ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=512k") == 0;
}

enum class FullDisk { as_expected, wrong, no_mount };

/// Fills a small disk with jobs; runs in a process of its own because the mount is that process's.
FullDisk fill_small_disk(const fs::path& folder) {
  if (!mount_small_disk(folder)) return FullDisk::no_mount;
  std::string last;
  std::size_t count = 0;
  {
    JobStore store(folder);
    const std::string message = expect_refusal(Fault::disk_full, [&] {
      for (;; ++count) last = add_job(store).id;
    });
    EXPECT_NE(message.find("make room"), std::string::npos) << message;
    EXPECT_GT(count, 20U);
    EXPECT_TRUE(store.find(last)) << "reading goes on";
  }
  JobStore store(folder);  // a service starts on a full disk, to make room
  EXPECT_EQ(store.list({{}, {}, "", 100000}).size(), count);
  EXPECT_TRUE(store.find(last));
  return testing::Test::HasFailure() ? FullDisk::wrong : FullDisk::as_expected;
}

TEST(Disk, ThatIsFullRefusesAJobAndKeepsTheOthers) {
  const DataFolder data;
  const int status = in_process([&] { return static_cast<int>(fill_small_disk(data.path())); });
  if (status == static_cast<int>(FullDisk::no_mount)) {
    GTEST_SKIP() << "this machine does not let the test mount a small tmpfs";
  }
  EXPECT_EQ(status, static_cast<int>(FullDisk::as_expected));
}

}  // namespace
}  // namespace sluice::test

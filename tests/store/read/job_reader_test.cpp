#include "engine/store/read/job_reader.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "engine/scene/model/problems.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/series_file.hpp"
#include "tests/store/expect_fault.hpp"
#include "tests/store/fixtures.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

class JobReaderTest : public ::testing::Test {
 protected:
  void damage(const fs::path& path) const {
    Bytes bytes = read_bytes(path);
    bytes[bytes.size() / 2] ^= std::byte{4};
    write_bytes(path, bytes);
  }

  TemporaryFolder folder_;
  JobFolder job_ = JobFolder::create(folder_ / "job", "{}");
  JobReader reader_{folder_ / "job"};
};

TEST_F(JobReaderTest, NeedsNoLock) { EXPECT_EQ(reader_.scene_text(), "{}"); }

TEST_F(JobReaderTest, HasNoSeriesAndNoOutcomeBeforeTheRun) {
  EXPECT_TRUE(reader_.series().empty());
  EXPECT_TRUE(reader_.outcome().is_null());
  EXPECT_FALSE(reader_.completed());
}

TEST_F(JobReaderTest, TakesSeriesFromTheNewestWholeCheckpointUntilThereIsAFile) {
  Checkpoint older = make_checkpoint(5);
  older.samples.front().values.front() = 0.125;
  job_.write_checkpoint(older);
  const fs::path newest = job_.write_checkpoint(make_checkpoint(6));
  EXPECT_TRUE(same_bits(reader_.series(), split(make_samples())));
  damage(newest);
  EXPECT_TRUE(same_bits(reader_.series(), split(older.samples)));
  EXPECT_TRUE(fs::exists(newest)) << "putting it aside is for the run";
  write_series(job_.paths().series(), make_samples());
  EXPECT_TRUE(same_bits(reader_.series(), split(make_samples())));
}

TEST_F(JobReaderTest, SaysThatSeriesAreDamaged) {
  job_.write_checkpoint(make_checkpoint(5));
  write_series(job_.paths().series(), make_samples());
  damage(job_.paths().series());
  expect_fault(StorageFault::corrupt, [&] { (void)reader_.series(); });
}

TEST_F(JobReaderTest, TakesAnOutcomeThatIsNoJsonForNone) {
  std::ofstream(job_.paths().outcome()) << "{\"state\": \"comp";
  EXPECT_TRUE(reader_.outcome().is_null());
  std::ofstream(job_.paths().outcome()) << "{\"state\": \"completed\"}";
  EXPECT_TRUE(reader_.completed());
  std::ofstream(job_.paths().outcome()) << "{\"state\": 3}";
  EXPECT_FALSE(reader_.completed());
}

TEST_F(JobReaderTest, FollowsNoLink) {
  std::ofstream(folder_ / "elsewhere") << "{\"state\": \"completed\"}";
  fs::create_symlink(folder_ / "elsewhere", job_.paths().outcome());
  EXPECT_THROW((void)reader_.outcome(), StorageError);
}

TEST_F(JobReaderTest, NamesTheFirstProblemOfAScene) {
  EXPECT_THROW((void)reader_.scene(), SceneError);
}

TEST(JobReader, LooksAtNoSamplesWhereTheSceneHasNoSensors) {
  const TemporaryFolder folder;
  const JobFolder job = JobFolder::create(folder / "job", R"({
    "name": "wet", "tank": {"width": 1, "height": 1}, "gravity": [0, -9.81], "end_time": 1,
    "fluid": [{"shape": "rectangle", "corner": [0, 0], "size": [0.5, 0.5]}],
    "material": {"density": 1000}, "resolution": {"spacing": 0.05}})");
  std::ofstream(job.paths().series()) << "no series of ours";
  const JobRecord record = JobReader(folder / "job").record();
  EXPECT_EQ(record.scene.name, "wet");
  EXPECT_TRUE(record.series.empty());
}

TEST(JobReader, OfAFolderWithoutAJobSaysSo) {
  const TemporaryFolder folder;
  expect_fault(StorageFault::not_ours, [&] { const JobReader reader(folder.path()); });
}

}  // namespace
}  // namespace sluice::test

#include "service/jobs/rebuild.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <system_error>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/format/canonical.hpp"
#include "engine/store/disk/errors.hpp"
#include "engine/store/files/digest.hpp"
#include "engine/store/files/job_folder.hpp"
#include "engine/store/files/new_folder.hpp"
#include "service/jobs/job_file.hpp"
#include "tests/service/jobs/store_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

std::string scene_text(double end_time) {
  return R"({"name": "drop", "fluid": [{"shape": "circle", "center": [0, 0], "radius": 1}],)"
         R"("gravity": [0, 0], "material": {"density": 1000, "sound_speed": 10},)"
         R"("resolution": {"spacing": 0.1}, "end_time": )" +
         std::to_string(end_time) + "}";
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

void write_outcome(const fs::path& folder, int exit_code, double end_time,
                   const std::string& reason = "") {
  write_text(JobPaths(folder).outcome(), R"({"exit_code":)" + std::to_string(exit_code) +
                                             R"(,"reason":")" + reason + R"(","end_time":)" +
                                             std::to_string(end_time) + "}");
}

/// The folder of a job as a submission leaves it.
fs::path make_folder(const DataFolder& data, const std::string& id, const JobFile& file = {},
                     double end_time = 1.0) {
  publish_job_folder(data.job(id), scene_text(end_time), {{"job.json", job_file_text(file)}});
  return data.job(id);
}

class Rebuild : public testing::Test {
 protected:
  std::size_t rebuild() {
    return rebuild_from_folders(store_, data_.path(),
                                [this](const fs::path& folder, const std::string& reason) {
                                  reports_[folder.filename().string()] += reason;
                                });
  }
  /// The row made from a folder that `prepare` has worked on.
  Job rebuilt(const std::function<void(const fs::path&)>& prepare, double end_time = 1.0) {
    const std::string id = store_.new_id();
    prepare(make_folder(data_, id, {}, end_time));
    EXPECT_EQ(rebuild(), 1U);
    return store_.find(id).value();
  }

  DataFolder data_;
  JobStore store_{data_.path()};
  std::map<std::string, std::string> reports_;
};

TEST_F(Rebuild, GivesBackAllThatFolderAndSceneTell) {
  const std::string id = store_.new_id();
  const JobFile file{"käse", -3, 2, 1'700'000'000'123, "key", "hash", std::nullopt};
  make_folder(data_, id, file);
  EXPECT_EQ(rebuild(), 1U);
  const Job job = store_.find(id).value();
  const Scene scene = parse_job_scene(scene_text(1.0)).scene.value();
  EXPECT_EQ(job.state, JobState::queued);
  EXPECT_EQ(job.name, "drop");
  EXPECT_EQ(job.label, "käse");
  EXPECT_EQ(job.priority, -3);
  EXPECT_EQ(job.threads, 2);
  EXPECT_EQ(job.created_ms, 1'700'000'000'123);
  EXPECT_EQ(job.end_time, 1.0);
  EXPECT_EQ(job.scene_hash, scene_hash(identity_text(scene)));
  EXPECT_NE(job.estimate.find("fluid_particles"), std::string::npos);
  EXPECT_EQ(store_.find_by_key("key", "hash")->id, id);
  EXPECT_EQ(history(store_, id), "adopted");
  EXPECT_TRUE(reports_.empty());
}

TEST_F(Rebuild, GivesBackTheRowsOfAStoreThatWasLost) {
  const DataFolder data;
  std::map<std::string, JobState> states;
  {
    JobStore store(data.path());
    for (const JobState state : {JobState::completed, JobState::failed, JobState::cancelled,
                                 JobState::paused, JobState::queued}) {
      Job job = a_job();
      job.id = store.new_id();
      make_folder(data, job.id);
      store.submit(job, "", "", 100);
      states[job.id] = state;
      if (state == JobState::paused) (void)store.apply(job.id, JobAction::pause, "", {});
      if (state == JobState::cancelled) (void)store.apply(job.id, JobAction::cancel, "", {});
      if (state == JobState::completed || state == JobState::failed) {
        const Job running = store.claim(1, {}).value();
        const bool completed = state == JobState::completed;
        // One that its scheduler gave up left none.
        if (completed) write_outcome(data.job(job.id), 0, 1.0);
        (void)store.apply(job.id, completed ? JobAction::complete : JobAction::fail, running.token,
                          {});
      }
    }
  }
  const std::optional<fs::path> aside = set_aside_database(data.path());
  ASSERT_TRUE(aside);
  EXPECT_TRUE(fs::exists(*aside));
  JobStore store(data.path());
  EXPECT_TRUE(store.list({}).empty());
  EXPECT_EQ(rebuild_from_folders(store, data.path()), states.size());
  for (const auto& [id, state] : states) {
    EXPECT_EQ(to_string(store.find(id)->state), to_string(state));
  }
}

TEST_F(Rebuild, TakesTheStateFromTheOutcome) {
  const auto with_exit = [&](int exit_code, double reached) {
    return rebuilt([&](const fs::path& folder) {
             write_outcome(folder, exit_code, reached, "because");
           })
        .state;
  };
  EXPECT_EQ(with_exit(0, 1.0), JobState::completed);
  EXPECT_EQ(with_exit(4, 1.0), JobState::failed);
  EXPECT_EQ(with_exit(6, 1.0), JobState::failed);
  EXPECT_EQ(with_exit(5, 1.0), JobState::paused);
  EXPECT_EQ(with_exit(85, 1.0), JobState::queued);
  // Extended after it had ended: the scene's end time is 1 s.
  EXPECT_EQ(with_exit(0, 0.5), JobState::queued);
  EXPECT_EQ(with_exit(4, 0.5), JobState::queued);
}

TEST_F(Rebuild, KeepsTheOutcomeAndTheTimeOfItsEnd) {
  const Job job = rebuilt([](const fs::path& folder) { write_outcome(folder, 4, 1.0, "NaN"); });
  EXPECT_EQ(job.reason, "NaN");
  EXPECT_NE(job.outcome.find("\"exit_code\":4"), std::string::npos) << job.outcome;
  EXPECT_NEAR(static_cast<double>(job.ended_ms), static_cast<double>(job.created_ms), 3.6e6)
      << "ended within the hour";
}

TEST_F(Rebuild, SaysWhereAJobGoesOn) {
  const Job fresh = rebuilt([](const fs::path&) {});
  EXPECT_NE(fresh.reason.find("from the start"), std::string::npos) << fresh.reason;
  const Job begun = rebuilt([](const fs::path& folder) {
    write_text(JobPaths(folder).checkpoint(10), "not read here");
    write_text(JobPaths(folder).checkpoint(200), "not read here");
  });
  EXPECT_NE(begun.reason.find("checkpoint-000000000200.h5"), std::string::npos) << begun.reason;
}

TEST_F(Rebuild, RunsNothingWhoseJobFileIsLost) {
  const Job job = rebuilt([](const fs::path& folder) { fs::remove(job_file_path(folder)); });
  EXPECT_EQ(job.state, JobState::paused);
  EXPECT_EQ(job.label, "");
  EXPECT_NE(reports_.at(job.id).find("paused"), std::string::npos);
  EXPECT_GT(job.created_ms, 0) << "the id tells when it was made";
  const Job ended = rebuilt([](const fs::path& folder) {
    fs::remove(job_file_path(folder));
    write_outcome(folder, 0, 1.0);
  });
  EXPECT_EQ(ended.state, JobState::completed);
}

TEST_F(Rebuild, ReportsDamagedFoldersAndGoesOnWithTheOthers) {
  const std::string no_scene = store_.new_id();
  fs::remove(JobPaths(make_folder(data_, no_scene)).scene());
  const std::string bad_scene = store_.new_id();
  write_text(JobPaths(make_folder(data_, bad_scene)).scene(), "{\"name\": ");
  const std::string bad_outcome = store_.new_id();
  write_text(JobPaths(make_folder(data_, bad_outcome)).outcome(), "[1, 2");
  const std::string deep_outcome = store_.new_id();
  write_text(JobPaths(make_folder(data_, deep_outcome)).outcome(), std::string(1 << 20, '['));
  const std::string huge = store_.new_id();
  write_text(JobPaths(make_folder(data_, huge)).scene(), std::string(1 << 20, ' '));
  const std::string good = store_.new_id();
  make_folder(data_, good);
  fs::create_directory(data_.path() / "jobs" / "mine");
  fs::create_directory_symlink(data_.job(good), data_.job(store_.new_id()));
  write_text(data_.path() / "jobs" / "file", "x");
  EXPECT_EQ(rebuild(), 3U);
  EXPECT_FALSE(store_.find(no_scene));
  EXPECT_FALSE(store_.find(bad_scene));
  EXPECT_FALSE(store_.find(huge));
  EXPECT_EQ(store_.find(bad_outcome)->state, JobState::queued);
  EXPECT_TRUE(store_.find(good));
  EXPECT_EQ(reports_.size(), 8U);
  EXPECT_NE(reports_.at(bad_scene).find("scene.json"), std::string::npos);
  EXPECT_NE(reports_.at(no_scene).find("scene.json"), std::string::npos);
  EXPECT_NE(reports_.at(bad_outcome).find("outcome.json"), std::string::npos);
}

TEST_F(Rebuild, LeavesRowsThatAreThereAlone) {
  const Job running = add_job_in(store_, JobState::running);
  make_folder(data_, running.id);
  write_outcome(data_.job(running.id), 0, 1.0);
  EXPECT_EQ(rebuild(), 0U);
  EXPECT_TRUE(same(store_.find(running.id).value(), running));
}

TEST_F(Rebuild, ClearsAwayWhatASubmissionHadNotFinished) {
  const std::string id = store_.new_id();
  const fs::path hidden = data_.path() / "jobs" / ("." + id + ".new");
  make_folder(data_, id);
  fs::rename(data_.job(id), hidden);
  fs::remove(hidden / "job.json");
  EXPECT_EQ(rebuild(), 0U);
  EXPECT_FALSE(fs::exists(hidden));
  EXPECT_FALSE(store_.find(id));
  EXPECT_TRUE(reports_.empty());
}

TEST_F(Rebuild, TakesOfTwoFoldersWithOneKeyTheOneThatRan) {
  JobFile file;
  file.key = "key";
  file.body_hash = "hash";
  const std::string left_over = store_.new_id();
  make_folder(data_, left_over, file);
  const std::string ran = store_.new_id();
  write_text(JobPaths(make_folder(data_, ran, file)).log(), "{}\n");
  EXPECT_EQ(rebuild(), 1U);
  EXPECT_TRUE(store_.find(ran));
  EXPECT_FALSE(store_.find(left_over));
  EXPECT_NE(reports_.at(left_over).find(ran), std::string::npos);
}

TEST(SetAside, FindsNothingInANewFolderAndIsRefusedWhileAServiceRuns) {
  const DataFolder data;
  EXPECT_EQ(set_aside_database(data.path()), std::nullopt);
  const JobStore store(data.path());
  expect_refusal(JobStoreError::Fault::in_use, [&] { (void)set_aside_database(data.path()); });
}

TEST(SetAside, TakesALinkForWhatItIsAlsoOneThatLeadsToItself) {
  const DataFolder data;
  const fs::path file = data.path() / "jobs.sqlite";
  fs::create_symlink(file.filename(), file);
  const auto aside = set_aside_database(data.path());
  ASSERT_TRUE(aside);
  EXPECT_TRUE(fs::is_symlink(*aside));
  EXPECT_TRUE(JobStore(data.path()).list({}).empty());
}

TEST(JobFile, ReadsBackAsItWasWritten) {
  const DataFolder data;
  const JobFile file{"\"käse\"\n", 7, 3, 123, "key", "hash", JobState::cancelled};
  write_job_file(data.path(), file);
  EXPECT_EQ(read_job_file(data.path()), file);
  write_job_file(data.path(), {});
  EXPECT_EQ(read_job_file(data.path()), JobFile{});
}

TEST(JobFile, ThatIsNotAsWrittenIsRefusedWithItsPath) {
  const DataFolder data;
  const std::string rest = R"("priority":0,"created_ms":0,"key":"","body_hash":"")";
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("{}"), std::string("null"),
        R"({"label":"","threads":0,"held":null,)" + rest + "}",
        R"({"label":"","threads":1e300,"held":null,)" + rest + "}",
        R"({"label":"","threads":1.5,"held":null,)" + rest + "}",
        R"({"label":7,"threads":1,"held":null,)" + rest + "}",
        R"({"label":"","threads":1,"held":"running",)" + rest + "}",
        R"({"label":"","threads":1,"held":"",)" + rest + "}", std::string(100'000, '[')}) {
    write_text(job_file_path(data.path()), text);
    try {
      (void)read_job_file(data.path());
      ADD_FAILURE() << "accepted: " << text.substr(0, 100);
    } catch (const StorageError& error) {
      EXPECT_EQ(error.fault(), StorageFault::corrupt);
      EXPECT_NE(std::string(error.what()).find("job.json"), std::string::npos);
    }
  }
}

TEST(JobFile, FollowsWhetherTheJobIsHeld) {
  const DataFolder data;
  JobStore store(data.path());
  Job job = a_job();
  job.id = store.new_id();
  make_folder(data, job.id);
  store.submit(job, "", "", 10);
  const auto held = [&] { return read_job_file(data.job(job.id)).held; };
  (void)store.apply(job.id, JobAction::pause, "", {});
  EXPECT_EQ(held(), JobState::paused);
  (void)store.apply(job.id, JobAction::resume, "", {});
  EXPECT_EQ(held(), std::nullopt);
  const Job running = store.claim(1, {}).value();
  (void)store.apply(job.id, JobAction::cancel, "", {});
  EXPECT_EQ(held(), std::nullopt) << "it has yet to obey";
  (void)store.apply(job.id, JobAction::requeue, running.token, {});
  EXPECT_EQ(held(), JobState::cancelled);
}

TEST(JobFile, ThatCannotBeWrittenHoldsUpNoTransition) {
  const DataFolder data;
  JobStore store(data.path());
  Job job = a_job();
  job.id = store.new_id();
  fs::create_directories(data.job(job.id));
  write_text(job_file_path(data.job(job.id)), "damaged");
  store.submit(job, "", "", 10);
  EXPECT_EQ(store.apply(job.id, JobAction::pause, "", {}).state, JobState::paused);
}

}  // namespace
}  // namespace sluice::test

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <string>

#include "engine/scene/parse.hpp"
#include "service/repair.hpp"
#include "service/retention.hpp"
#include "tests/service/api_support.hpp"

namespace sluice::test {
namespace {

/// Which fdatasync of this thread from now on fails once; 0: none. SQLite calls no other.
thread_local int failing_sync = 0;

}  // namespace
}  // namespace sluice::test

// Stands before the C library's own in this program.
extern "C" int fdatasync(int descriptor) {
  using Function = int (*)(int);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "fdatasync"));
  int& countdown = sluice::test::failing_sync;
  if (countdown > 0 && --countdown == 0) {
    errno = EIO;
    return -1;
  }
  return real(descriptor);
}

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// Row and folder of every job are both there, and the scene ends where the row says.
void expect_agreement(Service& service) {
  std::size_t folders = 0;
  for (const auto& entry : fs::directory_iterator(service.data.path() / "jobs")) {
    EXPECT_TRUE(service.store.find(entry.path().filename().string())) << entry.path();
    ++folders;
  }
  const auto jobs = service.store.list({});
  EXPECT_EQ(jobs.size(), folders);
  for (const Job& job : jobs) {
    const auto scene = parse_scene(read_file(service.data.job(job.id) / "scene.json"));
    ASSERT_TRUE(scene.scene);
    EXPECT_EQ(scene.scene->end_time, job.end_time) << job.id;
  }
}

/// Does `action` with the first, second, ... sync failing until none fails any more. Returns how
/// many did.
template <class Prepare, class Action>
int with_each_sync_failing(const Prepare& prepare, const Action& action) {
  for (int n = 1;; ++n) {
    Service service;
    const std::string id = prepare(service);
    failing_sync = n;
    const Response response = action(service, id);
    const bool none_failed = std::exchange(failing_sync, 0) > 0;
    SCOPED_TRACE(std::to_string(n) + ": " + std::to_string(response.status));
    expect_agreement(service);
    // Done, or nothing of it: asked again it is done, or there is nothing left to do.
    if (none_failed) return n - 1;
    const bool done = response.status < 300;
    const Response again = action(service, id);
    EXPECT_TRUE(done ? again.status < 500 : again.status < 300) << again.body;
    expect_agreement(service);
  }
}

std::string nothing(Service&) { return {}; }

TEST(AnUncertainCommit, OfASubmissionMakesAJobOrNone) {
  const int failed = with_each_sync_failing(nothing, [](Service& service, const std::string&) {
    Response response =
        service.ask("POST", "/v1/jobs", tiny_scene(0.1), {{"idempotency-key", "k"}});
    const std::size_t jobs = service.store.list({}).size();
    EXPECT_EQ(jobs, response.status == 202 ? 1u : 0u);
    return response;
  });
  EXPECT_GE(failed, 3);  // the journal, the data base, the journal's head
}

TEST(AnUncertainCommit, OfAStudyMakesAllJobsOrNone) {
  const std::string study =
      nlohmann::json{{"name", "s"},
                     {"scene", nlohmann::json::parse(tiny_scene(0.1))},
                     {"vary", {{{"key", "/end_time"}, {"values", {0.1, 0.2, 0.3}}}}}}
          .dump();
  const int failed = with_each_sync_failing(nothing, [&](Service& service, const std::string&) {
    Response response = service.ask("POST", "/v1/studies", study, {{"idempotency-key", "k"}});
    const bool made = response.status == 202;
    EXPECT_EQ(service.store.list({}).size(), made ? 3u : 0u);
    EXPECT_EQ(list_in(service.get("/v1/studies"), "studies").size(), made ? 1u : 0u);
    return response;
  });
  EXPECT_GE(failed, 3);
}

TEST(AnUncertainCommit, OfAnExtensionChangesSceneAndRowOrNeither) {
  const auto completed = [](Service& service) { return service.submit_in(JobState::completed); };
  const int failed = with_each_sync_failing(completed, [](Service& service, const std::string& id) {
    Response response = service.post("/v1/jobs/" + id + "/resume", R"({"end_time": 0.2})");
    if (response.status == 200) {
      EXPECT_EQ(service.store.find(id)->state, JobState::queued);
    } else if (response.status >= 500) {
      EXPECT_EQ(service.store.find(id)->state, JobState::completed);
    }
    return response;
  });
  EXPECT_GE(failed, 3);
}

TEST(AnUncertainCommit, OfADeletionRemovesRowAndFolderOrNeither) {
  const auto completed = [](Service& service) { return service.submit_in(JobState::completed); };
  const int failed = with_each_sync_failing(completed, [](Service& service, const std::string& id) {
    Response response = service.ask("DELETE", "/v1/jobs/" + id);
    EXPECT_EQ(service.store.find(id).has_value(), response.status >= 500);
    return response;
  });
  EXPECT_GE(failed, 3);
}

TEST(AnUncertainCommit, OfACancelOrPauseIsWhatTheAnswerSays) {
  for (const char* const action : {"cancel", "pause"}) {
    const auto queued = [](Service& service) { return service.submit(); };
    const int failed = with_each_sync_failing(queued, [&](Service& service, const std::string& id) {
      Response response = service.post("/v1/jobs/" + id + "/" + action);
      EXPECT_EQ(service.store.find(id)->state == JobState::queued, response.status >= 500);
      return response;
    });
    EXPECT_GE(failed, 3);
  }
}

// --- killed in between: what the next start makes of it

void repair(Service& service) { repair_folders(service.store, service.data.path()); }

TEST(Repair, GivesASceneTheEndThatItsRowKnows) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  const fs::path scene = service.data.job(id) / "scene.json";
  write_file(scene, with_end_time(read_file(scene), 5.0));
  repair(service);
  expect_agreement(service);
}

TEST(Repair, UndoesADeletionWhoseRowIsThereAndEndsOneWhoseRowIsGone) {
  Service service;
  const std::string kept = service.submit_in(JobState::completed);
  const std::string gone = service.submit_in(JobState::completed);
  for (const std::string& id : {kept, gone}) {
    fs::rename(service.data.job(id), deleted_folder(service.data.path(), id));
  }
  service.store.remove(gone);
  EXPECT_EQ(service.get("/v1/jobs/" + kept + "/sensors").status, 404);
  repair(service);
  expect_agreement(service);
  EXPECT_EQ(service.get("/v1/jobs/" + kept + "/sensors").status, 200);
  EXPECT_TRUE(cut_deletions(service.data.path()).empty());
}

TEST(Repair, RemovesTemporariesOfOursAndNothingElse) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  for (const char* const name : {".scene.json.4711.0.tmp", ".job.json.4711.3.tmp",
                                 ".report.json.4711.12.tmp", "mine.tmp", ".mine.tmp"}) {
    write_file(service.data.job(id) / name, "x");
  }
  repair(service);
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(service.data.job(id))) {
    left += entry.path().extension() == ".tmp" ? 1 : 0;
  }
  EXPECT_EQ(left, 2u);
}

TEST(Repair, ReportsAFolderThatItCannotMend) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  write_file(service.data.job(id) / "scene.json", "rubbish");
  std::string told;
  repair_folders(service.store, service.data.path(),
                 [&](const fs::path& folder, const std::string&) { told = folder.filename(); });
  EXPECT_EQ(told, id);
}

}  // namespace
}  // namespace sluice::test

#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <utility>

#include "service/jobs/rebuild.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

/// Which fdatasync of this thread from now on fails once; 0: none. SQLite calls no other.
thread_local int failing_sync = 0;
thread_local int syncs = 0;

}  // namespace
}  // namespace sluice::test

// Stands before the C library's own in this program.
extern "C" int fdatasync(int descriptor) {
  using Function = int (*)(int);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "fdatasync"));
  ++sluice::test::syncs;
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

/// Does `action` with the first, second, ... sync failing until none fails any more. Returns how
/// many did.
template <class Prepare, class Action>
int with_each_sync_failing(const Prepare& prepare, const Action& action) {
  int done_all_the_same = 0;
  for (int n = 1;; ++n) {
    Service service;
    const std::string id = prepare(service);
    failing_sync = n;
    const Response response = action(service, id);
    const bool none_failed = std::exchange(failing_sync, 0) > 0;
    SCOPED_TRACE(std::to_string(n) + ": " + std::to_string(response.status));
    expect_agreement(service);
    // Done, or nothing of it: asked again it is done, or there is nothing left to do.
    if (none_failed) {
      EXPECT_GT(done_all_the_same, 0);  // the sync after SQLite's commit point
      return n - 1;
    }
    const bool done = response.status < 300;
    done_all_the_same += done ? 1 : 0;
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

TEST(ARebuild, WaitsForTheDiskOnceForManyJobs) {
  Service service;
  for (int n = 0; n < 30; ++n) (void)service.submit("?priority=" + std::to_string(n));
  const DataFolder other;
  fs::copy(service.data.path() / "jobs", other.path() / "jobs", fs::copy_options::recursive);
  JobStore store(other.path());
  syncs = 0;
  EXPECT_EQ(rebuild_from_folders(store, other.path()), 30u);
  EXPECT_LT(syncs, 10);  // a transaction has four
}

}  // namespace
}  // namespace sluice::test

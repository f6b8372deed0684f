#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "engine/store/disk/errors.hpp"
#include "service/jobs/retention.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;

/// Asks all at once; the status of each answer, in order.
std::vector<int> ask_at_once(std::vector<std::function<Response()>> requests) {
  std::vector<int> statuses(requests.size());
  std::atomic<std::size_t> waiting = requests.size();
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < requests.size(); ++k) {
    threads.emplace_back([&, k] {
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      const Response response = requests[k]();
      statuses[k] = response.status;
      EXPECT_LT(response.status, 500) << response.body;
    });
  }
  for (std::thread& thread : threads) thread.join();
  return statuses;
}

/// Nothing of a job is left, or all of it.
void expect_whole_or_gone(Service& service, const std::string& id) {
  const bool there = service.store.find(id).has_value();
  EXPECT_EQ(fs::exists(service.data.job(id) / "scene.json"), there);
  EXPECT_EQ(fs::exists(service.data.job(id)), there);
  EXPECT_TRUE(cut_deletions(service.data.path()).empty());
}

constexpr int kRounds = 25;

TEST(OneAtATime, OfEightDeletionsOneIsDone) {
  Service service;
  for (int round = 0; round < kRounds; ++round) {
    const std::string id = service.submit_in(JobState::completed);
    auto statuses = ask_at_once(std::vector<std::function<Response()>>(
        8, [&] { return service.ask("DELETE", "/v1/jobs/" + id); }));
    EXPECT_EQ(std::ranges::count(statuses, 204), 1);
    EXPECT_EQ(std::ranges::count(statuses, 404), 7);
    expect_whole_or_gone(service, id);
  }
}

TEST(OneAtATime, ADeletionAndAnExtensionDoNotMix) {
  Service service;
  for (int round = 0; round < kRounds; ++round) {
    const std::string id = service.submit_in(JobState::completed);
    const std::string job = "/v1/jobs/" + id;
    const auto remove = [&] { return service.ask("DELETE", job); };
    const auto extend = [&] { return service.post(job + "/resume", R"({"end_time": 0.2})"); };
    const auto cancel = [&] { return service.post(job + "/cancel"); };
    const auto read = [&] { return service.get(job + "/sensors"); };
    const auto statuses = ask_at_once({remove, extend, cancel, read, remove, extend, read});
    const std::set<int> allowed{200, 204, 404, 409};
    for (const int status : statuses) {
      EXPECT_TRUE(allowed.contains(status) || status == 400) << status;
    }
    expect_whole_or_gone(service, id);
    // What was queued must not come into the way of the next round.
    if (service.store.find(id)) {
      (void)cancel();
      EXPECT_EQ(remove().status, 204);
    }
  }
}

/// Its rename of a job's folder fails.
class StuckFolders : public FileSystem {
 public:
  int rename(const fs::path&, const fs::path&) override {
    errno = EIO;
    return -1;
  }
};

TEST(OneAtATime, ADeletionWhoseFolderCannotBeMovedIsNotDone) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  StuckFolders stuck;
  EXPECT_THROW(delete_job(service.store, service.data.path(), id, stuck), StorageError);
  EXPECT_TRUE(service.store.find(id));
  expect_whole_or_gone(service, id);
  delete_job(service.store, service.data.path(), id);
  expect_whole_or_gone(service, id);
}

/// Counts how often it moved something.
class CountedMoves : public FileSystem {
 public:
  int rename(const fs::path& from, const fs::path& to) override {
    ++moves;
    return FileSystem::rename(from, to);
  }
  int moves = 0;
};

TEST(OneAtATime, ADeletionThatCameTooLateNeverMovesTheFolderOfTheResumedJob) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  ASSERT_EQ(service.post("/v1/jobs/" + id + "/resume", R"({"end_time": 0.2})").status, 200);
  CountedMoves system;
  try {
    delete_job(service.store, service.data.path(), id, system);
    FAIL() << "a queued job was deleted";
  } catch (const JobStoreError& refusal) {
    EXPECT_EQ(refusal.fault(), JobStoreError::Fault::conflict);
  }
  EXPECT_EQ(system.moves, 0);
  expect_whole_or_gone(service, id);
}

TEST(OneAtATime, AJobThatWasResumedHasItsFolderAtEveryMoment) {
  Service service;
  for (int round = 0; round < kRounds; ++round) {
    const std::string id = service.submit_in(JobState::completed);
    std::atomic<bool> done = false;
    std::thread deletions([&] {
      while (!done) (void)service.ask("DELETE", "/v1/jobs/" + id);
    });
    const int resumed = service.post("/v1/jobs/" + id + "/resume", R"({"end_time": 0.2})").status;
    for (int look = 0; resumed == 200 && look < 50; ++look) {
      EXPECT_TRUE(fs::exists(service.data.job(id) / "scene.json"));
    }
    done = true;
    deletions.join();
    if (resumed != 200) continue;
    EXPECT_EQ(service.post("/v1/jobs/" + id + "/cancel").status, 200);
    EXPECT_EQ(service.ask("DELETE", "/v1/jobs/" + id).status, 204);
  }
}

TEST(Readiness, EndsWithTheReasonWhenTheDataFolderIsGone) {
  Service service;
  EXPECT_EQ(service.get("/readyz").status, 200);
  const fs::path away = service.data.path().string() + "-away";
  fs::rename(service.data.path(), away);
  const Response response = service.get("/readyz");
  expect_problem(response, 503, "not-ready");
  EXPECT_NE(response.body.find("moved away"), std::string::npos) << response.body;
  EXPECT_EQ(response.body.find(service.data.path().string()), std::string::npos);
  EXPECT_EQ(service.get("/livez").status, 200);
  fs::rename(away, service.data.path());
  EXPECT_EQ(service.get("/readyz").status, 200);
  fs::rename(service.data.path() / "jobs", service.data.path() / "elsewhere");
  expect_problem(service.get("/readyz"), 503, "not-ready");
  fs::rename(service.data.path() / "elsewhere", service.data.path() / "jobs");
}

}  // namespace
}  // namespace sluice::test

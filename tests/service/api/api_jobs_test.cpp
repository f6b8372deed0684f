#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/store/files/job_folder.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

TEST(ApiJobs, ListsNewestFirstInPages) {
  Service service;
  std::vector<std::string> ids;
  for (int n = 0; n < 5; ++n) ids.push_back(service.submit());
  std::vector<std::string> seen;
  std::string target = "/v1/jobs?limit=2";
  for (int page = 0; page < 3; ++page) {
    const Json body = body_of(service.get(target));
    for (const Json& job : body["jobs"]) seen.push_back(job["id"]);
    if (body["next_cursor"].is_null()) break;
    target = "/v1/jobs?limit=2&cursor=" + body["next_cursor"].get<std::string>();
  }
  EXPECT_EQ(seen, std::vector<std::string>(ids.rbegin(), ids.rend()));
}

TEST(ApiJobs, ListsByStateAndLabel) {
  Service service;
  const std::string a = service.submit("?label=a");
  const std::string b = service.submit("?label=b");
  EXPECT_EQ(service.post("/v1/jobs/" + b + "/pause").status, 200);
  const auto ids = [&](std::string_view query) {
    std::vector<std::string> found;
    for (const Json& job : list_in(service.get("/v1/jobs?" + std::string(query)), "jobs")) {
      found.push_back(job["id"]);
    }
    return found;
  };
  EXPECT_EQ(ids("state=paused"), std::vector{b});
  EXPECT_EQ(ids("label=a"), std::vector{a});
  EXPECT_TRUE(ids("label=a&state=paused").empty());
  expect_problem(service.get("/v1/jobs?state=done"), 400, "invalid-parameter");
  expect_problem(service.get("/v1/jobs?limit=0"), 400, "invalid-parameter");
  expect_problem(service.get("/v1/jobs?cursor=zzz"), 400, "invalid-parameter");
}

TEST(ApiJobs, AnswersForUnknownAndForgedIdsAlike) {
  Service service;
  for (const std::string& id :
       {std::string("j00000000000000000000"), std::string("..%2f..%2fetc"), std::string("%2e%2e"),
        std::string(3000, 'j'), std::string("j0000000000000000000'")}) {
    const Response response = service.get("/v1/jobs/" + id);
    EXPECT_EQ(response.status, 404) << id;
    EXPECT_EQ(response.content_type, "application/problem+json");
  }
  expect_problem(service.get("/v1/jobs/j00000000000000000000"), 404, "no-such-job");
}

TEST(ApiJobs, LongPollReturnsWhenTheJobChanges) {
  Service service;
  const std::string id = service.submit();
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    (void)service.store.apply(id, JobAction::pause, "", {});
  });
  const Response response = service.get("/v1/jobs/" + id + "?wait=60");
  other.join();
  EXPECT_EQ(body_of(response)["state"], "paused");
}

TEST(ApiJobs, LongPollReturnsForProgressOnlyWhenAsked) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  const Job job = service.store.find(id).value();
  std::atomic<bool> over = false;
  std::thread worker([&] {
    for (int step = 1; !over; ++step) {
      service.store.record_progress(id, job.token, R"({"step":)" + std::to_string(step) + "}");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  EXPECT_EQ(body_of(service.get("/v1/jobs/" + id + "?wait=60&progress=1"))["state"], "running");
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    (void)service.store.apply(id, JobAction::cancel, "", {});
  });
  EXPECT_EQ(body_of(service.get("/v1/jobs/" + id + "?wait=60"))["stop_requested"], "cancel");
  over = true;
  worker.join();
  other.join();
}

TEST(ApiJobs, LongPollReturnsAfterItsTimeWithoutNews) {
  Service service;
  const std::string id = service.submit();
  const auto start = Clock::now();
  const Response response = service.get("/v1/jobs/" + id + "?wait=0.2");
  EXPECT_GE(Clock::now() - start, std::chrono::milliseconds(190));
  EXPECT_EQ(response.status, 200);
}

TEST(ApiJobs, LongPollOfAnEndedJobReturnsAtOnceAndWithTheTagItIsNotModified) {
  Service service;
  const std::string id = service.submit_in(JobState::cancelled);
  const Response first = service.get("/v1/jobs/" + id + "?wait=60");
  EXPECT_EQ(first.status, 200);
  const Response again = service.ask("GET", "/v1/jobs/" + id + "?wait=60", "",
                                     {{"if-none-match", header_of(first, "ETag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_TRUE(again.body.empty());
}

TEST(ApiJobs, LongPollWithAnOldTagReturnsTheNewsAtOnce) {
  Service service;
  const std::string id = service.submit();
  const std::string tag = header_of(service.get("/v1/jobs/" + id), "ETag");
  (void)service.store.apply(id, JobAction::pause, "", {});
  const Response response =
      service.ask("GET", "/v1/jobs/" + id + "?wait=60", "", {{"if-none-match", tag}});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(body_of(response)["state"], "paused");
}

TEST(ApiJobs, PauseResumeAndCancelCanBeRepeated) {
  Service service;
  const std::string job = "/v1/jobs/" + service.submit();
  const auto state_after = [&](std::string_view action) {
    const Response response = service.post(job + "/" + std::string(action));
    EXPECT_EQ(response.status, 200) << response.body;
    return body_of(response).value("state", "");
  };
  EXPECT_EQ(state_after("pause"), "paused");
  EXPECT_EQ(state_after("pause"), "paused");
  EXPECT_EQ(state_after("resume"), "queued");
  EXPECT_EQ(state_after("resume"), "queued");
  EXPECT_EQ(state_after("cancel"), "cancelled");
  EXPECT_EQ(state_after("cancel"), "cancelled");
  expect_problem(service.post(job + "/pause"), 409, "wrong-state");
}

TEST(ApiJobs, SaysThatARunningJobHasYetToStop) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  const Response response = service.post("/v1/jobs/" + id + "/pause");
  EXPECT_EQ(response.status, 202);
  EXPECT_EQ(body_of(response)["state"], "running");
  EXPECT_EQ(body_of(response)["stop_requested"], "pause");
}

TEST(ApiJobs, ActionsTakeNoBodyAndNoParameters) {
  Service service;
  const std::string job = "/v1/jobs/" + service.submit();
  expect_problem(service.post(job + "/cancel", "{}"), 400, "bad-request");
  expect_problem(service.post(job + "/cancel?now=1"), 400, "invalid-parameter");
  expect_problem(service.post(job + "/checkpoint"), 409, "wrong-state");
}

TEST(ApiJobs, ExtendsACompletedJobToALaterEndTime) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  const std::string target = "/v1/jobs/" + id + "/resume";
  const Json steps_before = body_of(service.get("/v1/jobs/" + id))["estimate"]["steps"];
  const Response response = service.post(target, R"({"end_time": 0.3})");
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(body_of(response)["state"], "queued");
  EXPECT_EQ(body_of(response)["end_time"], 0.3);
  EXPECT_GT(body_of(response)["estimate"]["steps"], steps_before);
  const Json scene = Json::parse(read_file(service.data.job(id) / "scene.json"));
  EXPECT_EQ(scene["end_time"], 0.3);
  EXPECT_EQ(scene["name"], "tiny");
}

TEST(ApiJobs, ExtendsOnlyToALaterTimeAndOnlyJobsThatDoNotRun) {
  Service service;
  const std::string done = service.submit_in(JobState::completed);
  const std::string target = "/v1/jobs/" + done + "/resume";
  const std::string before = read_file(service.data.job(done) / "scene.json");
  for (const char* const body :
       {R"({"end_time": 0.1})", R"({"end_time": -1})", R"({"end_time": "later"})", R"({"end": 3})",
        "[1]", "{", "3", R"({"end_time": 1e999})"}) {
    expect_problem(service.post(target, body), 400, "bad-request");
  }
  expect_problem(service.post(target, R"({"end_time": 1e300})"), 422, "invalid-scene");
  expect_problem(service.post(target), 409, "wrong-state");
  EXPECT_EQ(read_file(service.data.job(done) / "scene.json"), before);
  const std::string running = service.submit_in(JobState::running);
  expect_problem(service.post("/v1/jobs/" + running + "/resume", R"({"end_time": 1})"), 409,
                 "wrong-state");
}

TEST(ApiJobsThreads, OfTwoExtensionsAtOnceOneHoldsInRowAndScene) {
  for (int round = 0; round < 20; ++round) {
    Service service;
    const std::string id = service.submit_in(JobState::completed);
    const std::string target = "/v1/jobs/" + id + "/resume";
    std::mutex mutex;
    std::vector<JobFolder> workers;
    std::vector<std::thread> clients;
    for (int n = 1; n <= 8; ++n) {
      clients.emplace_back([&, n] {
        const std::string body = R"({"end_time": )" + std::to_string(n) + "}";
        if (service.post(target, body).status != 200) return;
        // What the scheduler starts next has the folder to itself: nobody can put a scene back.
        const std::scoped_lock lock(mutex);
        workers.push_back(JobFolder::open(service.data.job(id)));
      });
    }
    for (std::thread& client : clients) client.join();
    EXPECT_EQ(workers.size(), 1U);
    const Json scene = Json::parse(read_file(service.data.job(id) / "scene.json"));
    EXPECT_EQ(scene["end_time"], service.store.find(id).value().end_time);
  }
}

TEST(ApiJobs, ShowsACompletedJobsProgressAtItsEnd) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  const std::string token = service.store.find(id).value().token;
  service.store.record_progress(id, token,
                                R"({"event":"progress","step":90,"fraction":0.9,"eta":0.2})");
  JobChange change;
  change.outcome = R"({"step": 100, "time": 0.1})";
  (void)service.store.apply(id, JobAction::complete, token, change);
  const Json progress = body_of(service.get("/v1/jobs/" + id))["progress"];
  EXPECT_EQ(progress, Json::parse(R"({"step":100,"fraction":1.0,"eta":0.0,"time":0.1})"));
}

TEST(ApiJobs, DeletesOnlyWhatHasEndedAndItsFolderWithIt) {
  Service service;
  const std::string id = service.submit();
  const std::string job = "/v1/jobs/" + id;
  expect_problem(service.ask("DELETE", job), 409, "wrong-state");
  EXPECT_TRUE(std::filesystem::exists(service.data.job(id) / "scene.json"));
  EXPECT_EQ(service.post(job + "/cancel").status, 200);
  EXPECT_EQ(service.ask("DELETE", job).status, 204);
  EXPECT_TRUE(std::filesystem::is_empty(service.data.path() / "jobs"));
  expect_problem(service.get(job), 404, "no-such-job");
  expect_problem(service.ask("DELETE", job), 404, "no-such-job");
}

TEST(ApiJobs, TellsTheMethodsOfAPath) {
  Service service;
  const std::string job = "/v1/jobs/" + service.submit();
  const Response options = service.ask("OPTIONS", job);
  EXPECT_EQ(options.status, 204);
  EXPECT_EQ(header_of(options, "Allow"), "OPTIONS, DELETE, GET, HEAD");
  const Response put = service.ask("PUT", job);
  expect_problem(put, 405, "method-not-allowed");
  EXPECT_EQ(header_of(put, "Allow"), "OPTIONS, DELETE, GET, HEAD");
  expect_problem(service.get(job + "/cancel"), 405, "method-not-allowed");
  EXPECT_EQ(service.ask("HEAD", job).status, 200);
  expect_problem(service.get("/v1/job"), 404, "not-found");
  expect_problem(service.ask("OPTIONS", "/v1/job"), 404, "not-found");
  expect_problem(service.get(job + "//"), 404, "not-found");
}

}  // namespace
}  // namespace sluice::test

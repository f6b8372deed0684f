#include <filesystem>
#include <set>

#include "service/problem.hpp"
#include "tests/service/api_support.hpp"

namespace sluice::test {
namespace {

using Json = nlohmann::json;

TEST(ApiFiles, ListsAndSendsOnlyTheFilesOfAJob) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/files";
  write_file(service.data.job(id) / "private.txt", "not of ours");
  std::set<std::string> names;
  for (const Json& file : list_in(service.get(target), "files")) names.insert(file["name"]);
  EXPECT_EQ(names, (std::set<std::string>{"scene.json", "job.json"}));
  const Response scene = service.get(target + "/scene.json");
  ASSERT_TRUE(scene.file);
  EXPECT_EQ(*scene.file, service.data.job(id) / "scene.json");
  for (const char* const name : {"private.txt", "lock", "..%2fscene.json", "%2e%2e", "..",
                                 "series.h5", "scene.json%00", "%2fetc%2fpasswd"}) {
    const Request asked{"GET", target + "/" + name, {}, {}, ""};
    const Response response = service.api.handle(asked);
    EXPECT_EQ(response.status, 404) << name;
    EXPECT_FALSE(response.file) << name;
  }
  expect_problem(service.get(target + "/lock"), 404, "no-such-file");
}

TEST(ApiFiles, DoNotListLinks) {
  Service service;
  const std::string id = service.submit();
  std::filesystem::create_symlink("/etc/hostname", service.data.job(id) / "report.json");
  for (const Json& file : list_in(service.get("/v1/jobs/" + id + "/files"), "files")) {
    EXPECT_NE(file["name"], "report.json");
  }
}

TEST(ApiFiles, TheReportIsThereOnceAnAttemptHasEnded) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/report";
  expect_problem(service.get(target), 409, "wrong-state");
  write_file(service.data.job(id) / "outcome.json", R"({"state": "completed"})");
  const Json report = body_of(service.get(target));
  EXPECT_EQ(report["outcome"]["state"], "completed");
  EXPECT_TRUE(report["report"].is_null());
}

TEST(ApiFiles, ThePageOfAReportComesWithAPolicyThatLetsNoScriptRun) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/report?format=html";
  expect_problem(service.get(target), 409, "wrong-state");
  write_file(service.data.job(id) / "report.html", "<!DOCTYPE html>");
  const Response page = service.get(target);
  EXPECT_EQ(page.file, service.data.job(id) / "report.html");
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  bool policy = false;
  for (const auto& [name, value] : page.headers) {
    policy = policy || (name == "Content-Security-Policy" &&
                        value.find("default-src 'none'") != std::string::npos);
  }
  EXPECT_TRUE(policy);
  expect_problem(service.get("/v1/jobs/" + id + "/report?format=pdf"), 400, "invalid-parameter");
}

TEST(ApiFiles, AReportThatIsALinkIsNotSent) {
  Service service;
  const std::string id = service.submit();
  std::filesystem::create_symlink("/etc/hostname", service.data.job(id) / "report.html");
  expect_problem(service.get("/v1/jobs/" + id + "/report?format=html"), 409, "wrong-state");
}

TEST(ApiFiles, TheLogIsEmptyBeforeItBegins) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/log";
  EXPECT_EQ(service.get(target).body, "");
  EXPECT_EQ(service.get(target).status, 200);
  write_file(service.data.job(id) / "log.jsonl", "{}\n");
  EXPECT_EQ(service.get(target).file, service.data.job(id) / "log.jsonl");
}

TEST(ApiMeta, EveryProblemTypeCanBeLookedUp) {
  Service service;
  std::set<std::string_view> slugs;
  for (const ProblemEntry& entry : all_problems()) {
    EXPECT_TRUE(slugs.insert(entry.slug).second) << entry.slug;
    const Json body = body_of(service.get("/problems/" + std::string(entry.slug)));
    EXPECT_EQ(body["status"], entry.status);
    EXPECT_EQ(&problem_entry(entry.type), &entry);
  }
  expect_problem(service.get("/problems/none"), 404, "not-found");
}

TEST(ApiMeta, ServesTheSchemaAndTheDescriptionOfItself) {
  Service service;
  EXPECT_EQ(body_of(service.get("/v1/schemas/scene"))["$schema"],
            "https://json-schema.org/draft/2020-12/schema");
  expect_problem(service.get("/v1/schemas/none"), 404, "not-found");
  EXPECT_EQ(body_of(service.get("/openapi.json"))["openapi"], "3.1.0");
  EXPECT_EQ(body_of(service.get("/"))["service"], "sluice");
  EXPECT_EQ(service.get("/readyz").status, 200);
}

TEST(ApiMeta, CountsJobsEventsAndRequests) {
  Service service;
  (void)service.submit_in(JobState::cancelled);
  service.api.count_request("GET", 200, std::chrono::duration<double>(0.002));
  service.api.count_request("BREW", 405, std::chrono::duration<double>(3.0));
  const std::string text = service.get("/metrics").body;
  for (const char* const line :
       {"sluice_jobs{state=\"cancelled\"} 1\n", "sluice_job_events_total{event=\"submitted\"} 1\n",
        "sluice_http_requests_total{method=\"GET\",status=\"200\"} 1\n",
        "sluice_http_requests_total{method=\"other\",status=\"405\"} 1\n",
        "sluice_http_request_seconds_bucket{le=\"0.001\"} 0\n",
        "sluice_http_request_seconds_bucket{le=\"0.005\"} 1\n",
        "sluice_http_request_seconds_bucket{le=\"+Inf\"} 2\n",
        "sluice_http_request_seconds_sum 3.002\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
}

}  // namespace
}  // namespace sluice::test

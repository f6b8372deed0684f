#include <filesystem>
#include <set>

#include "service/http/problem.hpp"
#include "tests/service/api/api_support.hpp"

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

Json report_of(Service& service, const std::string& id) {
  const Response response = service.get("/v1/jobs/" + id + "/report");
  EXPECT_EQ(response.status, 200) << response.body;
  return body_of(response);
}

TEST(ApiFiles, AReportIsThereAtAnyTime) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  Json report = report_of(service, id);
  EXPECT_EQ(report["state"], "running");
  EXPECT_TRUE(report["outcome"].is_null());
  ASSERT_TRUE(report["report"].is_object());
  EXPECT_EQ(report["report"]["sensors"].size(), 0U) << "no sample yet";
  service.write_samples(id, pressure_series({1.0, 2.0, 3.0}));
  report = report_of(service, id);
  ASSERT_EQ(report["report"]["sensors"].size(), 1U);
  EXPECT_EQ(report["report"]["sensors"][0]["samples"], 3);
  for (const auto& [format, type] : {std::pair("html", "text/html; charset=utf-8"),
                                     std::pair("markdown", "text/markdown; charset=utf-8")}) {
    const Response made = service.get("/v1/jobs/" + id + "/report?format=" + format);
    EXPECT_EQ(made.status, 200) << made.body;
    EXPECT_EQ(made.content_type, type);
    EXPECT_NE(made.body.find("P1"), std::string::npos);
  }
}

TEST(ApiFiles, TheReportOfAFailedJobSaysWhy) {
  Service service;
  const std::string id = service.submit_in(JobState::failed);
  const std::string reason = service.store.find(id)->reason;
  ASSERT_FALSE(reason.empty());
  const Json report = report_of(service, id);
  EXPECT_EQ(report["outcome"]["state"], "failed");
  EXPECT_EQ(report["outcome"]["reason"], reason);
  const Response page = service.get("/v1/jobs/" + id + "/report?format=html");
  EXPECT_NE(page.body.find(reason), std::string::npos) << page.body.substr(0, 2000);
}

TEST(ApiFiles, AReportThatIsMissingDamagedOrALinkIsMade) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  service.write_samples(id, pressure_series({1.0, 2.0}));
  const auto folder = service.data.job(id);
  write_file(folder / "outcome.json", R"({"state": "completed"})");
  const auto samples = [&] { return report_of(service, id)["report"]["sensors"][0]["samples"]; };
  EXPECT_EQ(samples(), 2) << "missing";
  write_file(folder / "report.json", "{\"sensors\": [");
  EXPECT_EQ(samples(), 2) << "damaged";
  std::filesystem::remove(folder / "report.json");
  write_file(service.data.path() / "secret.json", R"({"sensors": [{"samples": "secret"}]})");
  for (const char* const name : {"report.json", "report.html"}) {
    std::filesystem::create_symlink(service.data.path() / "secret.json", folder / name);
  }
  EXPECT_EQ(samples(), 2) << "a link";
  const Response page = service.get("/v1/jobs/" + id + "/report?format=html");
  EXPECT_FALSE(page.file);
  EXPECT_EQ(page.body.find("secret"), std::string::npos);
  std::filesystem::remove(folder / "report.json");
  write_file(folder / "report.json", R"({"sensors": [{"samples": "stored"}]})");
  EXPECT_EQ(samples(), "stored");
}

TEST(ApiFiles, OfADamagedJobTellItsDamage) {
  Service service;
  const std::string id = service.submit_in(JobState::failed);
  const auto folder = service.data.job(id);
  std::filesystem::remove_all(folder / "frames");
  write_file(folder / "frames", "no folder");
  for (const char* const path :
       {"/files", "/files/frame-000000.h5", "/report", "/report?format=html"}) {
    const Response response = service.get("/v1/jobs/" + id + path);
    expect_problem(response, 500, "damaged-files");
    EXPECT_NE(response.body.find(id + "/frames"), std::string::npos) << response.body;
    EXPECT_EQ(response.body.find(service.data.path().string()), std::string::npos);
  }
  std::filesystem::remove(folder / "frames");
  EXPECT_EQ(service.get("/v1/jobs/" + id + "/files").status, 200);
  write_file(folder / "scene.json", "{}");
  expect_problem(service.get("/v1/jobs/" + id + "/sensors"), 500, "damaged-files");
  std::filesystem::remove(folder / "scene.json");
  expect_problem(service.get("/v1/jobs/" + id + "/sensors"), 500, "damaged-files");
}

TEST(ApiFiles, NoRouteFollowsALink) {
  Service service;
  const std::string id = service.submit_in(JobState::running);
  const auto folder = service.data.job(id);
  const std::string job = "/v1/jobs/" + id;
  write_file(service.data.path() / "secret.json", R"({"state": "secret", "reason": "secret"})");
  for (const char* const name : {"outcome.json", "log.jsonl"}) {
    std::filesystem::create_symlink(service.data.path() / "secret.json", folder / name);
  }
  service.write_samples(id, pressure_series({123.5}));
  std::filesystem::rename(folder / "series.h5", service.data.path() / "series.h5");
  std::filesystem::create_symlink(service.data.path() / "series.h5", folder / "series.h5");
  for (const char* const path :
       {"/report", "/report?format=html", "/log", "/files", "/files/outcome.json",
        "/files/series.h5", "/files/log.jsonl", "/sensors", "/sensors/P1"}) {
    const Response response = service.get(job + path);
    EXPECT_FALSE(response.file) << path;
    EXPECT_EQ(response.body.find("secret"), std::string::npos) << path << response.body;
    EXPECT_EQ(response.body.find("123.5"), std::string::npos) << path;
  }
}

TEST(ApiFiles, ThePageOfAReportComesWithAPolicyThatLetsNoScriptRun) {
  Service service;
  const std::string id = service.submit_in(JobState::completed);
  const std::string target = "/v1/jobs/" + id + "/report?format=html";
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

TEST(ApiFiles, TheLogIsEmptyBeforeItBegins) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/log";
  EXPECT_EQ(service.get(target).body, "");
  EXPECT_EQ(service.get(target).status, 200);
  write_file(service.data.job(id) / "log.jsonl", "{}\n");
  EXPECT_EQ(service.get(target).file, service.data.job(id) / "log.jsonl");
}

TEST(ApiMeta, ASlashAtTheEndMeansTheSame) {
  Service service;
  const std::string id = service.submit();
  for (const std::string path : {"/v1/jobs", "/v1/schemas/scene", "/readyz"}) {
    EXPECT_EQ(service.get(path + "/").body, service.get(path).body) << path;
  }
  EXPECT_EQ(service.get("/v1/jobs/" + id + "/").status, 200);
  EXPECT_EQ(service.post("/v1/jobs/" + id + "/pause/").status, 200);
  expect_problem(service.get("/v1/jobs//"), 404, "not-found");
}

TEST(ApiMeta, OptionsOfTheServerNameAllMethods) {
  Service service;
  const Response response = service.api.handle({"OPTIONS", "*", {}, {}, ""});
  EXPECT_EQ(response.status, 204);
  EXPECT_EQ(header_of(response, "Allow"), "OPTIONS, DELETE, GET, HEAD, POST");
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

#include <algorithm>
#include <filesystem>
#include <set>
#include <thread>
#include <vector>

#include "engine/scene/checks/parse.hpp"
#include "engine/scene/filling/initial.hpp"
#include "engine/scene/forecast/estimate.hpp"
#include "service/jobs/job_file.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::size_t count_folders(const Service& service) {
  if (!fs::exists(service.data.path() / "jobs")) return 0;
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(service.data.path() / "jobs"), {}));
}

TEST(ApiSubmit, AcceptsASceneAndSaysWhereTheJobIs) {
  Service service;
  const Response response =
      service.post("/v1/jobs?label=first%20try&priority=7&threads=2", tiny_scene(0.25));
  ASSERT_EQ(response.status, 202) << response.body;
  const Json job = body_of(response);
  const std::string id = job["id"];
  EXPECT_EQ(header_of(response, "Location"), "/v1/jobs/" + id);
  EXPECT_EQ(job["state"], "queued");
  EXPECT_EQ(job["label"], "first try");
  EXPECT_EQ(job["priority"], 7);
  EXPECT_EQ(job["threads"], 2);
  EXPECT_EQ(job["name"], "tiny");
  EXPECT_EQ(job["end_time"], 0.25);
  EXPECT_EQ(job["estimate"]["fluid_particles"], 50);  // 0.6 x 0.3 m in cells of 0.06 m
  EXPECT_EQ(service.get("/v1/jobs/" + id).status, 200);
}

TEST(ApiSubmit, CountsTheCharactersOfALabelAndNotItsBytes) {
  Service service;
  std::string label;
  for (int n = 0; n < 100; ++n) label += "%C3%A4";
  EXPECT_EQ(service.post("/v1/jobs?label=" + label, tiny_scene(0.1)).status, 202);
  expect_problem(service.post("/v1/jobs?label=a" + label, tiny_scene(0.1)), 400,
                 "invalid-parameter");
}

TEST(ApiSubmit, KeepsTheSceneAsItWasSentAndWhatRebuildsTheRow) {
  Service service;
  const std::string id = service.submit("?label=kept&priority=3");
  EXPECT_EQ(read_file(service.data.job(id) / "scene.json"), tiny_scene(0.1));
  const JobFile file = read_job_file(service.data.job(id));
  EXPECT_EQ(file.label, "kept");
  EXPECT_EQ(file.priority, 3);
}

TEST(ApiSubmit, KeepsTheSchemeThatASceneMeansWithoutNamingIt) {
  Service service;
  Json scene = Json::parse(tiny_scene(0.1));
  scene.erase("numerics");
  const std::string id = body_of(service.post("/v1/jobs", scene.dump()))["id"];
  const Json kept = Json::parse(read_file(service.data.job(id) / "scene.json"));
  EXPECT_EQ(kept["numerics"]["scheme"], "recommended");
}

TEST(ApiSubmit, EstimatesTheTimeThatPlanDoes) {
  Service service;
  const Json scene = Json::parse(tiny_scene(0.1));
  const Scene parsed = parse_scene(scene.dump()).scene.value();
  const double core_seconds = expected_core_seconds(parsed, exact_estimate(parsed));
  const Json job = body_of(service.post("/v1/jobs?threads=2", scene.dump()));
  EXPECT_DOUBLE_EQ(job["estimate"]["seconds"].get<double>(), core_seconds / 2);
  const Json dry = body_of(service.post("/v1/jobs?dry_run=1", scene.dump()));
  EXPECT_DOUBLE_EQ(dry["estimate"]["seconds"].get<double>(), core_seconds);
}

TEST(ApiSubmit, WarnsOfWhatMayNotBeMeantAndTakesItAllTheSame) {
  Service service;
  Json scene = Json::parse(tiny_scene(0.1));
  scene["sensors"][0]["interval"] = 0.01;
  EXPECT_TRUE(body_of(service.post("/v1/jobs", scene.dump()))["warnings"].empty());
  scene["sensors"][0]["position"] = {1.75, 0.02};  // behind the wall, in the domain
  for (const char* target : {"/v1/jobs", "/v1/jobs?dry_run=1"}) {
    const Response response = service.post(target, scene.dump());
    const Json warnings = body_of(response)["warnings"];
    ASSERT_EQ(warnings.size(), 1U) << target << response.body;
    EXPECT_EQ(warnings[0]["pointer"], "/sensors/0/position");
    EXPECT_FALSE(warnings[0]["detail"].get<std::string>().empty());
  }
}

TEST(ApiSubmit, NamesEveryProblemOfASceneAtOnceAndMakesNothing) {
  Service service;
  Json scene = Json::parse(tiny_scene(0.1));
  scene["resolution"]["spacing"] = -1;
  scene["gravitty"] = Json::array({0, -9.81});
  const Response response = service.post("/v1/jobs", scene.dump());
  expect_problem(response, 422, "invalid-scene");
  std::set<std::string> pointers;
  for (const Json& error : list_in(response, "errors")) {
    pointers.insert(error["pointer"]);
    EXPECT_FALSE(error["detail"].get<std::string>().empty());
  }
  EXPECT_TRUE(pointers.contains("/resolution/spacing"));
  EXPECT_TRUE(pointers.contains("/gravitty"));
  EXPECT_EQ(count_folders(service), 0U);
  EXPECT_TRUE(service.store.list({}).empty());
}

TEST(ApiSubmit, TellsTheStabilityMarginAndRefusesACourantNumberBeyondTheLimit) {
  Service service;
  const Json job = body_of(service.post("/v1/jobs", tiny_scene(0.1)));
  const Json& stability = job["estimate"]["stability"];
  EXPECT_EQ(stability["outlook"], "stable");
  const double limit = stability["courant_limit"];
  EXPECT_DOUBLE_EQ(stability["margin"].get<double>(), limit / 0.5 - 1.0);

  Json scene = Json::parse(tiny_scene(1.0));
  scene["numerics"]["integrator"] = "modified_leap_frog";
  scene["numerics"]["courant"] = 1.0;
  const Response refused = service.post("/v1/jobs", scene.dump());
  expect_problem(refused, 422, "invalid-scene");
  EXPECT_EQ(body_of(refused)["errors"][0]["pointer"], "/numerics/courant");
}

TEST(ApiSubmit, RefusesRegionsThatOverlap) {
  Service service;
  Json scene = Json::parse(tiny_scene(0.1));
  scene["fluid"].push_back(scene["fluid"][0]);
  expect_problem(service.post("/v1/jobs", scene.dump()), 422, "invalid-scene");
}

TEST(ApiSubmit, RefusesAnEmptyBodyAndBrokenJson) {
  Service service;
  expect_problem(service.post("/v1/jobs", ""), 422, "invalid-scene");
  expect_problem(service.post("/v1/jobs", "{\"name\":"), 422, "invalid-scene");
  expect_problem(service.post("/v1/jobs", std::string(60'000, '[')), 422, "invalid-scene");
}

TEST(ApiSubmit, DryRunTellsThePlanAndChangesNothing) {
  Service service;
  const Response response = service.post("/v1/jobs?dry_run=1", tiny_scene(0.1));
  ASSERT_EQ(response.status, 200) << response.body;
  const Json body = body_of(response);
  EXPECT_EQ(body["estimate"]["fluid_particles"], 50);
  EXPECT_GT(body["estimate"]["seconds"].get<double>(), 0.0);
  EXPECT_FALSE(body["plan"]["passes"].empty());
  EXPECT_TRUE(service.store.list({}).empty());
  EXPECT_EQ(count_folders(service), 0U);
}

TEST(ApiSubmit, NamesTheLimitThatASceneBreaks) {
  ServiceLimits limits = limits_for_scripts();
  limits.particles_per_job = 10;
  limits.disk_per_job = 1;
  Service service(limits);
  const Response response = service.post("/v1/jobs?dry_run=1", tiny_scene(0.1));
  expect_problem(response, 422, "over-limit");
  const Json errors = body_of(response)["errors"];
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0]["limit"], "particles");
  EXPECT_EQ(errors[0]["allowed"], 10);
  EXPECT_EQ(errors[1]["limit"], "disk_bytes");
}

TEST(ApiSubmit, RefusesMoreJobsThanMayWait) {
  ServiceLimits limits = limits_for_scripts();
  limits.queued_jobs = 1;
  Service service(limits);
  (void)service.submit();
  const Response response = service.post("/v1/jobs", tiny_scene(0.1));
  expect_problem(response, 503, "queue-full");
  EXPECT_EQ(header_of(response, "Retry-After"), "5");
  EXPECT_EQ(count_folders(service), 1U);
}

TEST(ApiSubmit, RefusesParametersThatAreWrongUnknownOrDouble) {
  Service service;
  const Response response = service.post(
      "/v1/jobs?priority=high&threads=0&lable=x&dry_run=maybe&label=a&label=b", tiny_scene(0.1));
  expect_problem(response, 400, "invalid-parameter");
  std::set<std::string> names;
  for (const Json& error : list_in(response, "errors")) names.insert(error["parameter"]);
  EXPECT_EQ(names, (std::set<std::string>{"priority", "threads", "lable", "dry_run", "label"}));
}

TEST(ApiSubmit, RefusesMoreThreadsThanTheServiceHasCores) {
  Service service;  // with two
  EXPECT_EQ(service.post("/v1/jobs?threads=2&dry_run=1", tiny_scene(0.1)).status, 200);
  expect_problem(service.post("/v1/jobs?threads=3", tiny_scene(0.1)), 400, "invalid-parameter");
}

TEST(ApiSubmit, TakesWhatCurlSendsAndRefusesOtherForms) {
  Service service;
  const auto sent_as = [&](const std::string& type) {
    return service.ask("POST", "/v1/jobs?dry_run=1", tiny_scene(0.1), {{"content-type", type}});
  };
  EXPECT_EQ(sent_as("application/json").status, 200);
  EXPECT_EQ(sent_as("application/json; charset=utf-8").status, 200);
  EXPECT_EQ(sent_as("Application/JSON;charset=UTF-8").status, 200);
  EXPECT_EQ(sent_as("application/x-www-form-urlencoded").status, 200);
  expect_problem(sent_as("multipart/form-data; boundary=x"), 400, "bad-request");
  expect_problem(sent_as("multipart/mixed; boundary=x"), 415, "unsupported-media-type");
  expect_problem(sent_as("application/jsonp"), 415, "unsupported-media-type");
}

TEST(ApiSubmit, TakesAFormWithTheSceneAlone) {
  Service service;
  const std::string body = "--x\r\nContent-Disposition: form-data; name=\"scene\"\r\n\r\n" +
                           tiny_scene(0.1) + "\r\n--x--\r\n";
  const Response response =
      service.ask("POST", "/v1/jobs", body, {{"content-type", "multipart/form-data; boundary=x"}});
  ASSERT_EQ(response.status, 202) << response.body;
  const std::string id = body_of(response)["id"];
  EXPECT_EQ(read_file(service.data.job(id) / "scene.json"), tiny_scene(0.1));
}

TEST(ApiSubmit, GivesTheSameJobForTheSameKey) {
  Service service;
  const auto submit = [&](std::string_view target, double end_time) {
    return service.ask("POST", target, tiny_scene(end_time), {{"idempotency-key", "run-1"}});
  };
  const Response first = submit("/v1/jobs", 0.1);
  const Response again = submit("/v1/jobs", 0.1);
  EXPECT_EQ(first.status, 202);
  EXPECT_EQ(again.status, 202);
  EXPECT_EQ(body_of(first)["id"], body_of(again)["id"]);
  EXPECT_EQ(header_of(first, "Idempotency-Replayed"), "");
  EXPECT_EQ(header_of(again, "Idempotency-Replayed"), "true");
  EXPECT_EQ(count_folders(service), 1U);
  expect_problem(submit("/v1/jobs", 0.2), 422, "idempotency-key-reused");
  expect_problem(submit("/v1/jobs?priority=1", 0.1), 422, "idempotency-key-reused");
}

TEST(ApiSubmit, RefusesKeysThatAreNoKeys) {
  Service service;
  for (const std::string& key : {std::string(), std::string(200, 'k'), std::string("a b")}) {
    expect_problem(service.ask("POST", "/v1/jobs", tiny_scene(0.1), {{"idempotency-key", key}}),
                   400, "invalid-parameter");
  }
}

TEST(ApiSubmit, SaysWhatTheDiskRefusedWithoutThePlaceOfItsFolder) {
  Service service;
  fs::remove_all(service.data.path() / "jobs");
  write_file(service.data.path() / "jobs", "in the way");
  const Response response = service.post("/v1/jobs", tiny_scene(0.1));
  expect_problem(response, 500, "internal");
  const std::string detail = body_of(response)["detail"];
  EXPECT_EQ(detail.find(service.data.path()), std::string::npos) << detail;
  EXPECT_EQ(detail.find("jobs/"), 0U) << detail;
  EXPECT_NE(detail.find("Not a directory"), std::string::npos) << detail;
  EXPECT_TRUE(service.store.list({}).empty());

  fs::remove(service.data.path() / "jobs");
  fs::create_directory(service.data.path() / "jobs");
  EXPECT_EQ(service.post("/v1/jobs", tiny_scene(0.1)).status, 202);
}

TEST(ApiSubmitThreads, OneKeyAtTheSameInstantMakesOneJob) {
  Service service;
  std::vector<std::string> ids(16);
  std::vector<std::thread> clients;
  for (std::string& id : ids) {
    clients.emplace_back([&service, &id] {
      const Response response =
          service.ask("POST", "/v1/jobs", tiny_scene(0.1), {{"idempotency-key", "same"}});
      id = nlohmann::json::parse(response.body).value("id", "none");
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 1U);
  EXPECT_EQ(count_folders(service), 1U);
  EXPECT_EQ(service.store.list({}).size(), 1U);
}

TEST(ApiSubmit, TakesNoJobsWhileDraining) {
  Service service;
  service.api.set_draining();
  expect_problem(service.post("/v1/jobs", tiny_scene(0.1)), 503, "draining");
  expect_problem(service.get("/readyz"), 503, "draining");
  EXPECT_EQ(service.get("/livez").status, 200);
  EXPECT_EQ(service.get("/v1/jobs").status, 200);
}

}  // namespace
}  // namespace sluice::test

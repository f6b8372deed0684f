#include <algorithm>
#include <filesystem>
#include <set>

#include "service/jobs/rebuild.hpp"
#include "service/jobs/retention.hpp"
#include "service/jobs/study_store.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Three spacings of the tiny dam break, two targets.
Json ladder() {
  return {{"name", "ladder"},
          {"scene", Json::parse(tiny_scene(0.1))},
          {"vary", {{{"key", "/resolution/spacing"}, {"values", {0.06, 0.05, 0.03}}}}},
          {"targets", {0.5, 0.25}}};
}

Json submit_study(Service& service, const Json& study = ladder(), std::string_view query = "") {
  const Response response = service.post("/v1/studies" + std::string(query), study.dump());
  EXPECT_EQ(response.status, 202) << response.body;
  return body_of(response);
}

Json show(Service& service, const std::string& id) {
  return body_of(service.get("/v1/studies/" + id));
}

std::size_t count_folders(const Service& service, std::string_view kind) {
  const fs::path folder = service.data.path() / kind;
  if (!fs::exists(folder)) return 0;
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

/// Completes the queued job that is next, with a report of this error and cost.
std::string complete_next(Service& service, double error, double core_seconds) {
  const Job running = service.store.claim(2, {}).value();
  const Json report = {{"error", error}, {"cost", {{"core_seconds", core_seconds}}}};
  write_file(service.data.job(running.id) / "report.json", report.dump());
  return service.store.apply(running.id, JobAction::complete, running.token, {}).id;
}

TEST(ApiStudies, MakesEveryRunAnOrdinaryJobWithTheStudysIdAsItsLabel) {
  Service service;
  Json study = ladder();
  study["threads"] = 2;
  const Response response = service.post("/v1/studies?priority=5", study.dump());
  ASSERT_EQ(response.status, 202) << response.body;
  const Json made = body_of(response);
  const std::string id = made["id"];
  EXPECT_EQ(header_of(response, "Location"), "/v1/studies/" + id);
  EXPECT_EQ(made["state"], "open");
  EXPECT_EQ(made["jobs"]["queued"], 3);
  ASSERT_EQ(made["runs"].size(), 3U);
  EXPECT_EQ(made["runs"][0]["run"], "ladder-spacing-0.06");
  EXPECT_EQ(made["runs"][0]["state"], "waiting");
  const Json jobs = list_in(service.get("/v1/jobs?label=" + id), "jobs");
  ASSERT_EQ(jobs.size(), 3U);
  for (const Json& job : jobs) {
    EXPECT_EQ(job["priority"], 5);
    EXPECT_EQ(job["threads"], 2);
  }
  // Oldest first in the queue: the order of the study.
  EXPECT_EQ(service.store.claim(2, {})->name, "ladder-spacing-0.06");
  const Json scene = Json::parse(
      read_file(service.data.job(made["runs"][2]["job"].get<std::string>()) / "scene.json"));
  EXPECT_EQ(scene["resolution"]["spacing"], 0.03);
}

TEST(ApiStudies, ShowsTheParetoFrontAndTheCheapestOfWhatIsComplete) {
  Service service;
  const std::string id = submit_study(service)["id"];
  (void)complete_next(service, 0.4, 1.0);
  (void)complete_next(service, 0.45, 2.0);
  Json shown = show(service, id);
  EXPECT_EQ(shown["state"], "open");
  (void)complete_next(service, 0.2, 10.0);
  shown = show(service, id);
  EXPECT_EQ(shown["state"], "ended");
  EXPECT_EQ(shown["jobs"]["completed"], 3);
  EXPECT_EQ(shown["setups"][0]["on_pareto_front"], true);
  EXPECT_EQ(shown["setups"][1]["on_pareto_front"], false);
  EXPECT_EQ(shown["setups"][2]["on_pareto_front"], true);
  EXPECT_EQ(shown["runs"][2]["error"], 0.2);
  EXPECT_EQ(shown["cheapest"][0]["setup"], "ladder-spacing-0.06");
  EXPECT_EQ(shown["cheapest"][1]["setup"], "ladder-spacing-0.03");
  EXPECT_EQ(shown["convergence"][0]["quantity"], "error");
}

TEST(ApiStudies, ShowsAFailedRunAsFailedAndAPausedOneAsStopped) {
  Service service;
  const std::string id = submit_study(service)["id"];
  const Job first = service.store.claim(1, {}).value();
  JobChange why;
  why.reason = "speed above c";
  service.store.apply(first.id, JobAction::fail, first.token, why);
  const Json runs = show(service, id)["runs"];
  service.store.apply(runs[1]["job"], JobAction::pause, "", {});
  const Json shown = show(service, id);
  EXPECT_EQ(shown["runs"][0]["state"], "failed");
  EXPECT_EQ(shown["runs"][0]["reason"], "speed above c");
  EXPECT_EQ(shown["runs"][1]["state"], "stopped");
  EXPECT_EQ(shown["runs"][2]["state"], "waiting");
  EXPECT_TRUE(shown["setups"][0]["error"].is_null());
  EXPECT_NE(service.get("/v1/studies/" + id + "?format=markdown").body.find("speed above c"),
            std::string::npos);
}

TEST(ApiStudies, GivesTablesAsMarkdownAndCsvAndThePlotAsSvg) {
  Service service;
  const std::string id = submit_study(service)["id"];
  (void)complete_next(service, 0.4, 1.0);
  const Response markdown = service.get("/v1/studies/" + id + "?format=markdown");
  EXPECT_EQ(markdown.content_type, "text/markdown; charset=utf-8");
  EXPECT_NE(markdown.body.find("| ladder-spacing-0.06 | completed | 0.4000 |"), std::string::npos)
      << markdown.body;
  const Response csv = service.get("/v1/studies/" + id + "?format=csv");
  EXPECT_EQ(csv.content_type, "text/csv; charset=utf-8");
  EXPECT_EQ(std::count(csv.body.begin(), csv.body.end(), '\n'), 4);
  const Response svg = service.get("/v1/studies/" + id + "?format=svg");
  EXPECT_EQ(svg.content_type, "image/svg+xml");
  EXPECT_NE(header_of(svg, "Content-Security-Policy").find("default-src 'none'"),
            std::string::npos);
  EXPECT_TRUE(svg.body.starts_with("<svg")) << svg.body.substr(0, 80);
}

TEST(ApiStudies, RefusesAStudyThatIsNoneWithEveryPointerAndMakesNothing) {
  Service service;
  Json study = ladder();
  study["targetts"] = Json::array({1});
  study["threads"] = 0;
  const Response response = service.post("/v1/studies", study.dump());
  expect_problem(response, 422, "invalid-study");
  std::set<std::string> pointers;
  for (const Json& error : list_in(response, "errors")) pointers.insert(error["pointer"]);
  EXPECT_TRUE(pointers.contains("/targetts"));
  EXPECT_TRUE(pointers.contains("/threads"));
  study = ladder();
  study["scene"] = "dambreak.json";
  const Response named = service.post("/v1/studies", study.dump());
  expect_problem(named, 422, "invalid-study");
  EXPECT_EQ(list_in(named, "errors")[0]["pointer"], "/scene");
  for (const char* text : {"", "{", "[]", "null"}) {
    expect_problem(service.post("/v1/studies", text), 422, "invalid-study");
  }
  EXPECT_EQ(count_folders(service, "jobs"), 0U);
  EXPECT_EQ(count_folders(service, "studies"), 0U);
}

TEST(ApiStudies, HoldsEveryRunAgainstTheLimitsOfTheService) {
  ServiceLimits limits = limits_for_scripts();
  limits.runs_per_study = 2;
  Service few(limits);
  expect_problem(few.post("/v1/studies", ladder().dump()), 422, "invalid-study");

  limits = limits_for_scripts();
  limits.particles_per_job = 400;
  Service small(limits);
  const Response response = small.post("/v1/studies", ladder().dump());
  expect_problem(response, 422, "over-limit");
  const Json errors = list_in(response, "errors");
  ASSERT_FALSE(errors.empty());
  EXPECT_EQ(errors.back()["limit"], "particles");
  EXPECT_EQ(errors.back()["detail"], "run ladder-spacing-0.03");

  Json wide = ladder();
  wide["threads"] = 1000;
  const Response many = small.post("/v1/studies", wide.dump());
  expect_problem(many, 422, "over-limit");
  EXPECT_EQ(list_in(many, "errors")[0]["pointer"], "/threads");
}

TEST(ApiStudies, TakesAllRunsIntoTheQueueOrNone) {
  ServiceLimits limits = limits_for_scripts();
  limits.queued_jobs = 3;
  Service service(limits);
  (void)service.submit();
  expect_problem(service.post("/v1/studies", ladder().dump()), 503, "queue-full");
  EXPECT_EQ(count_folders(service, "jobs"), 1U);
  EXPECT_EQ(count_folders(service, "studies"), 0U);
  EXPECT_TRUE(list_in(service.get("/v1/studies"), "studies").empty());
}

TEST(ApiStudies, TakesARunThatIsPredictedToBeUnstableBecauseToFindOutIsItsPurpose) {
  Service service;
  Json study = ladder();
  study["scene"] = Json::parse(tiny_scene(1.0));
  study["scene"]["numerics"]["integrator"] = "modified_leap_frog";
  study["vary"] = {{{"key", "/numerics/courant"}, {"values", {0.25, 1.0}}}};
  expect_problem(service.post("/v1/jobs",
                              [&] {
                                Json scene = study["scene"];
                                scene["numerics"]["courant"] = 1.0;
                                return scene.dump();
                              }()),
                 422, "invalid-scene");
  EXPECT_EQ(submit_study(service, study)["runs"].size(), 2U);
}

TEST(ApiStudies, DryRunTellsEveryRunAndChangesNothing) {
  Service service;
  Json study = ladder();
  study["scene"]["sensors"] = {
      {{"name", "outside"}, {"kind", "pressure"}, {"position", {-0.11, 0.05}}, {"interval", 0.01}}};
  const Response response = service.post("/v1/studies?dry_run=1", study.dump());
  ASSERT_EQ(response.status, 200) << response.body;
  const Json plan = body_of(response);
  EXPECT_EQ(plan["run_count"], 3);
  EXPECT_EQ(plan["runs"][0]["estimate"]["fluid_particles"], 50);  // 0.6 x 0.3 m, cells of 0.06 m
  EXPECT_EQ(plan["runs"][2]["estimate"]["fluid_particles"], 200);
  EXPECT_EQ(plan["runs"][2]["warnings"][0]["pointer"], "/sensors/0/position");
  EXPECT_GT(plan["core_seconds"].get<double>(), 0.0);
  EXPECT_TRUE(service.store.list({}).empty());
  EXPECT_EQ(count_folders(service, "studies"), 0U);
}

TEST(ApiStudies, OneKeyMakesOneStudy) {
  Service service;
  const std::map<std::string, std::string> key{{"idempotency-key", "once"}};
  const Response first = service.ask("POST", "/v1/studies", ladder().dump(), key);
  const Response again = service.ask("POST", "/v1/studies", ladder().dump(), key);
  ASSERT_EQ(again.status, 202) << again.body;
  EXPECT_EQ(body_of(again)["id"], body_of(first)["id"]);
  EXPECT_EQ(header_of(again, "Idempotency-Replayed"), "true");
  EXPECT_EQ(service.store.list({}).size(), 3U);
  expect_problem(service.ask("POST", "/v1/studies?priority=1", ladder().dump(), key), 422,
                 "idempotency-key-reused");
}

TEST(ApiStudies, CancelEndsEveryJobThatHasNotEndedAndMayBeRepeated) {
  Service service;
  const std::string id = submit_study(service)["id"];
  (void)complete_next(service, 0.4, 1.0);
  const Job running = service.store.claim(1, {}).value();
  const Response first = service.post("/v1/studies/" + id + "/cancel");
  EXPECT_EQ(first.status, 202) << first.body;
  EXPECT_EQ(service.store.find(running.id)->pending_stop, PendingStop::cancel);
  service.store.apply(running.id, JobAction::requeue, running.token, {});
  const Response second = service.post("/v1/studies/" + id + "/cancel");
  EXPECT_EQ(second.status, 200);
  const Json study = body_of(second);
  EXPECT_EQ(study["state"], "ended");
  EXPECT_EQ(study["jobs"]["completed"], 1);
  EXPECT_EQ(study["jobs"]["cancelled"], 2);
  EXPECT_EQ(study["runs"][0]["error"], 0.4);
}

TEST(ApiStudies, KeepsTheResultOfARunWhoseJobIsDeleted) {
  Service service;
  const std::string id = submit_study(service)["id"];
  const std::string done = complete_next(service, 0.4, 1.0);
  const Job failing = service.store.claim(1, {}).value();
  JobChange why;
  why.reason = "speed above c";
  service.store.apply(failing.id, JobAction::fail, failing.token, why);
  for (const std::string& job : {done, failing.id}) {
    EXPECT_EQ(service.ask("DELETE", "/v1/jobs/" + job).status, 204);
  }
  const Json shown = show(service, id);
  EXPECT_TRUE(shown["runs"][0]["job"].is_null());
  EXPECT_EQ(shown["runs"][0]["state"], "completed");
  EXPECT_EQ(shown["runs"][0]["error"], 0.4);
  EXPECT_EQ(shown["runs"][1]["state"], "failed");
  EXPECT_NE(shown["runs"][1]["reason"].get<std::string>().find("speed above c"), std::string::npos);
  EXPECT_EQ(shown["runs"][2]["state"], "waiting");
}

TEST(ApiStudies, ARunThatWasExtendedIsAnotherRunAndCountsNoLonger) {
  Service service;
  const std::string id = submit_study(service)["id"];
  const std::string done = complete_next(service, 0.4, 1.0);
  ASSERT_EQ(service.post("/v1/jobs/" + done + "/resume", R"({"end_time": 0.2})").status, 200);
  (void)complete_next(service, 0.1, 1.0);
  const Json runs = show(service, id)["runs"];
  const auto extended =
      std::find_if(runs.begin(), runs.end(), [&](const Json& run) { return run["job"] == done; });
  ASSERT_NE(extended, runs.end());
  EXPECT_EQ((*extended)["state"], "stopped");
  EXPECT_TRUE((*extended)["error"].is_null());
}

TEST(ApiStudies, DeleteTakesTheJobsAlongAndWaitsUntilTheyHaveEnded) {
  Service service;
  const std::string other = service.submit();
  const std::string id = submit_study(service)["id"];
  expect_problem(service.ask("DELETE", "/v1/studies/" + id), 409, "wrong-state");
  EXPECT_EQ(service.post("/v1/studies/" + id + "/cancel").status, 200);
  EXPECT_EQ(service.ask("DELETE", "/v1/studies/" + id).status, 204);
  expect_problem(service.get("/v1/studies/" + id), 404, "no-such-study");
  EXPECT_EQ(count_folders(service, "jobs"), 1U);
  EXPECT_EQ(count_folders(service, "studies"), 0U);
  EXPECT_TRUE(service.store.find(other));
}

TEST(ApiStudies, ListsPagesFromTheNewest) {
  Service service;
  std::vector<std::string> ids;
  for (int n = 0; n < 3; ++n) ids.push_back(submit_study(service)["id"]);
  const Json first = body_of(service.get("/v1/studies?limit=2"));
  ASSERT_EQ(first["studies"].size(), 2U);
  EXPECT_EQ(first["studies"][0]["id"], ids[2]);
  EXPECT_EQ(first["studies"][0]["run_count"], 3);
  const std::string cursor = first["next_cursor"];
  const Json second = body_of(service.get("/v1/studies?limit=2&cursor=" + cursor));
  ASSERT_EQ(second["studies"].size(), 1U);
  EXPECT_EQ(second["studies"][0]["id"], ids[0]);
  EXPECT_TRUE(second["next_cursor"].is_null());
  expect_problem(service.get("/v1/studies?cursor=x"), 400, "invalid-parameter");
}

TEST(ApiStudies, IsFoundAgainByTheNextServiceAlsoWithRowsMadeAnew) {
  Service service;
  const std::map<std::string, std::string> key{{"idempotency-key", "once"}};
  const std::string id = body_of(service.ask("POST", "/v1/studies", ladder().dump(), key))["id"];
  (void)complete_next(service, 0.4, 1.0);
  Api next(service.store, service.scheduler, service.data.path());
  const Json shown = body_of(next.handle(request("GET", "/v1/studies/" + id)));
  EXPECT_EQ(shown["runs"][0]["error"], 0.4);
  EXPECT_EQ(body_of(next.handle(request("POST", "/v1/studies", ladder().dump(), key)))["id"], id);

  // Another data base over the same folders, as after --rebuild.
  DataFolder elsewhere;
  for (const char* kind : {"jobs", "studies"}) {
    fs::copy(service.data.path() / kind, elsewhere.path() / kind, fs::copy_options::recursive);
  }
  write_file(elsewhere.path() / "jobs" / shown["runs"][0]["job"] / "outcome.json",
             R"({"exit_code": 0, "reason": "", "end_time": 0.1})");
  JobStore rows(elsewhere.path());
  EXPECT_EQ(rebuild_from_folders(rows, elsewhere.path(), {}), 3U);
  Scheduler scheduler(rows, elsewhere.path(), limits_for_scripts());
  scheduler.drain();
  Api rebuilt(rows, scheduler, elsewhere.path());
  const Json anew = body_of(rebuilt.handle(request("GET", "/v1/studies/" + id)));
  EXPECT_EQ(anew["jobs"]["completed"], 1);
  EXPECT_EQ(anew["jobs"]["queued"], 2);
  EXPECT_EQ(anew["runs"][0]["error"], 0.4);
}

/// As a crash leaves it between the study's folder and its jobs.
TEST(ApiStudies, TheNextStartMakesTheJobsThatACrashLeftUnmadeAndOnlyThose) {
  Service service;
  const std::string id = submit_study(service)["id"];
  const std::string gone = complete_next(service, 0.4, 1.0);
  const fs::path submission = service.data.path() / "studies" / id / "submission.json";
  Json record = Json::parse(read_file(submission));
  ASSERT_EQ(record["made"], true);
  record["made"] = false;
  write_file(submission, record.dump());
  service.store.remove(gone);
  Api next(service.store, service.scheduler, service.data.path());
  const Json shown = body_of(next.handle(request("GET", "/v1/studies/" + id)));
  EXPECT_EQ(shown["jobs"]["queued"], 3);
  EXPECT_EQ(Json::parse(read_file(submission))["made"], true);

  // Once it is made, a job that somebody deleted stays away.
  service.post("/v1/studies/" + id + "/cancel");
  service.store.remove(shown["runs"][1]["job"]);
  Api third(service.store, service.scheduler, service.data.path());
  EXPECT_EQ(body_of(third.handle(request("GET", "/v1/studies/" + id)))["jobs"]["queued"], 0);
}

TEST(ApiStudies, WhatACutShortSubmissionLeftIsRemovedAtTheNextStart) {
  DataFolder data;
  const std::string id = "s" + std::string(20, '0');
  const fs::path folder = data.path() / "studies";
  for (const fs::path& half : {folder / id, folder / ("." + id + ".new")}) {
    fs::create_directories(half);
    write_file(half / "study.json", ladder().dump());
  }
  const StudyStore studies(data.path());
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_TRUE(studies.list("", 10).empty());
}

TEST(ApiStudies, ThatAreDamagedSaySoAndHideNoOther) {
  Service service;
  const std::string good = submit_study(service)["id"];
  const std::string bad = submit_study(service)["id"];
  const fs::path folder = service.data.path() / "studies" / bad;
  const std::string document = read_file(folder / "study.json");
  const auto expect_damaged = [&](const char* what) {
    for (const char* const format : {"json", "markdown", "csv", "svg"}) {
      SCOPED_TRACE(std::string(what) + " as " + format);
      const Response response = service.get("/v1/studies/" + bad + "?format=" + format);
      expect_problem(response, 500, "damaged-files");
      EXPECT_NE(response.body.find("study.json"), std::string::npos) << response.body;
      EXPECT_EQ(response.body.find(service.data.path().string()), std::string::npos);
    }
    EXPECT_EQ(service.get("/v1/studies/" + good).status, 200);
    EXPECT_EQ(list_in(service.get("/v1/studies"), "studies").size(), 2U);
  };
  write_file(folder / "study.json", "");
  expect_damaged("empty");
  write_file(folder / "study.json", document.substr(0, document.size() / 2));
  expect_damaged("cut short");
  fs::remove(folder / "study.json");
  expect_damaged("missing");
  write_file(service.data.path() / "outside.json", document);
  fs::create_symlink(service.data.path() / "outside.json", folder / "study.json");
  expect_damaged("a link");

  EXPECT_EQ(service.post("/v1/studies/" + good + "/cancel").status, 200);
  EXPECT_EQ(service.post("/v1/studies/" + bad + "/cancel").status, 500) << "done, not shown";
  EXPECT_EQ(service.ask("DELETE", "/v1/studies/" + bad).status, 204);
  EXPECT_FALSE(fs::exists(folder));
}

TEST(ApiStudies, ThatAreDamagedAreNeverTakenForMade) {
  Service service;
  const std::string id = submit_study(service)["id"];
  const fs::path folder = service.data.path() / "studies" / id;
  Json record = Json::parse(read_file(folder / "submission.json"));
  record["made"] = false;
  write_file(folder / "submission.json", record.dump());
  write_file(folder / "study.json", "{");
  testing::internal::CaptureStderr();
  const Api next(service.store, service.scheduler, service.data.path());
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("study_unfinished"), std::string::npos) << log;
  EXPECT_NE(log.find(id), std::string::npos) << log;
  EXPECT_EQ(Json::parse(read_file(folder / "submission.json"))["made"], false);
}

TEST(ApiStudies, ARecordThatCannotBeReadIsPassedOverWithALineInTheLog) {
  Service service;
  const std::string good = submit_study(service)["id"];
  const std::string bad = submit_study(service)["id"];
  const fs::path submission = service.data.path() / "studies" / bad / "submission.json";
  const auto started = [&](const char* what) {
    testing::internal::CaptureStderr();
    const StudyStore studies(service.data.path());
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(studies.find(good)) << what;
    EXPECT_FALSE(studies.find(bad)) << what;
    EXPECT_NE(log.find("study_passed_over"), std::string::npos) << what << log;
    EXPECT_NE(log.find(bad), std::string::npos) << what << log;
    EXPECT_TRUE(fs::exists(fs::symlink_status(submission))) << what << ": it may be mended";
  };
  write_file(submission, "{");
  started("cut short");
  fs::remove(submission);
  fs::create_symlink(submission.filename(), submission);
  started("a link to itself");
  fs::remove(submission);
  fs::create_directory(submission);
  started("a folder");
}

TEST(ApiStudies, FollowNoLink) {
  Service service;
  const std::string id = submit_study(service)["id"];
  const std::string job = complete_next(service, 0.4, 1.0);
  const fs::path report = service.data.job(job) / "report.json";
  write_file(service.data.path() / "outside.json",
             R"({"error": 0.125, "cost": {"core_seconds": 7.0}})");
  fs::remove(report);
  fs::create_symlink(service.data.path() / "outside.json", report);
  EXPECT_TRUE(show(service, id)["runs"][0]["error"].is_null());
  EXPECT_EQ(service.ask("DELETE", "/v1/jobs/" + job).status, 204);
  const Json shown = show(service, id);
  EXPECT_EQ(shown.dump().find("0.125"), std::string::npos) << shown;
  const fs::path kept = service.data.path() / "studies" / id / "kept";
  for (const fs::directory_entry& entry : fs::directory_iterator(kept)) {
    EXPECT_EQ(read_file(entry.path()).find("0.125"), std::string::npos);
    fs::remove(entry.path());
    fs::create_symlink(service.data.path() / "kept.json", entry.path());
  }
  write_file(service.data.path() / "kept.json",
             R"({"state": "failed", "reason": "from outside", "report": ""})");
  EXPECT_EQ(show(service, id).dump().find("from outside"), std::string::npos);
}

TEST(ApiStudies, NobodyElseMayUseAStudysIdAsALabel) {
  Service service;
  const std::string id = submit_study(service)["id"];
  expect_problem(service.post("/v1/jobs?label=" + id, tiny_scene(0.1)), 400, "invalid-parameter");
}

TEST(ApiStudies, OfAnIdThatIsNoneIsNotFound) {
  Service service;
  for (const char* id : {"s", "x", "s00000000000000000000", "j00000000000000000000"}) {
    const std::string target = "/v1/studies/" + std::string(id);
    expect_problem(service.get(target), 404, "no-such-study");
    expect_problem(service.post(target + "/cancel"), 404, "no-such-study");
    expect_problem(service.ask("DELETE", target), 404, "no-such-study");
  }
}

TEST(ApiStudies, PublishesItsSchema) {
  Service service;
  const Response schema = service.get("/v1/schemas/study");
  EXPECT_EQ(schema.content_type, "application/schema+json");
  EXPECT_EQ(body_of(schema)["$id"], "urn:sluice:study:1");
}

}  // namespace
}  // namespace sluice::test

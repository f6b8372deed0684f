#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <random>
#include <thread>

#include "engine/store/disk/errors.hpp"
#include "engine/store/disk/trailer.hpp"
#include "service/api/answer_maker.hpp"
#include "service/http/problem.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

using Json = nlohmann::json;

constexpr double kDry = std::numeric_limits<double>::quiet_NaN();

TEST(ApiSensors, ListsTheSensorsOfTheSceneBeforeAndAfterSamples) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/sensors";
  Json sensors = body_of(service.get(target))["sensors"];
  ASSERT_EQ(sensors.size(), 1U);
  EXPECT_EQ(sensors[0]["name"], "P1");
  EXPECT_EQ(sensors[0]["samples"], 0);
  EXPECT_TRUE(sensors[0]["last"].is_null());
  service.write_samples(id, pressure_series({1.0, 2.0, 3.0}));
  sensors = body_of(service.get(target))["sensors"];
  EXPECT_EQ(sensors[0]["samples"], 3);
  EXPECT_EQ(sensors[0]["last"], 0.002);
  EXPECT_EQ(sensors[0]["columns"][0]["unit"], "Pa");
}

TEST(ApiSensors, TellsNoSamplesYetFromNoSuchSensor) {
  Service service;
  const std::string job = "/v1/jobs/" + service.submit();
  expect_problem(service.get(job + "/sensors/P1"), 409, "no-samples-yet");
  const Response response = service.get(job + "/sensors/P2");
  expect_problem(response, 404, "no-such-sensor");
  EXPECT_NE(response.body.find("P1"), std::string::npos) << "the right name is a hint away";
}

TEST(ApiSensors, GivesRawSamplesWithNullWhereDry) {
  Service service;
  const std::string id = service.submit();
  service.write_samples(id, pressure_series({1.0, kDry, 3.0}));
  const Json body = body_of(service.get("/v1/jobs/" + id + "/sensors/P1"));
  EXPECT_EQ(body["time"], Json::parse("[0,0.001,0.002]"));
  EXPECT_EQ(body["columns"][0]["values"], Json::parse("[1,null,3]"));
  EXPECT_EQ(body["weight"], Json::parse("[1,0,1]"));
  EXPECT_EQ(body["samples"], 3);
  EXPECT_EQ(body["decimated"], false);
  EXPECT_TRUE(body["provisional_after"].is_null());
}

TEST(ApiSensors, GivesTheSameAsCsvWhenAskedEitherWay) {
  Service service;
  const std::string id = service.submit();
  service.write_samples(id, pressure_series({1.5, kDry}));
  const std::string target = "/v1/jobs/" + id + "/sensors/P1";
  const std::string expected = "time_s,value,weight\n0,1.5,1\n0.001,,0\n";
  const Response by_query = service.get(target + "?format=csv");
  EXPECT_EQ(by_query.body, expected);
  EXPECT_TRUE(by_query.content_type.starts_with("text/csv"));
  EXPECT_EQ(service.ask("GET", target, "", {{"accept", "text/csv"}}).body, expected);
  EXPECT_EQ(service.ask("GET", target, "", {{"accept", "*/*"}}).content_type, "application/json");
  expect_problem(service.ask("GET", target, "", {{"accept", "image/png"}}), 406, "not-acceptable");
}

/// Bytes of this process's memory that were in use at most since the last call.
double peak_mebibytes() {
  std::ifstream status("/proc/self/status");
  double kibibytes = 0.0;
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") status >> kibibytes;
  }
  std::ofstream("/proc/self/clear_refs") << "5";
  return kibibytes / 1024.0;
}

TEST(ApiSensors, ManyWhoAskForALongSeriesAtOnceCostLittleMemory) {
  Service service;
  const std::string id = service.submit();
  service.write_samples(id, pressure_series(std::vector<double>(400'000, 5.0)));
  ASSERT_GT(std::filesystem::file_size(service.data.job(id) / "series.h5"), 10'000'000U);
  const std::string target = "/v1/jobs/" + id + "/sensors/P1?max_points=10";
  (void)peak_mebibytes();
  const double before = peak_mebibytes();
  std::atomic<int> whole = 0;
  std::atomic<int> later = 0;
  std::vector<std::thread> clients;
  for (int n = 0; n < 64; ++n) {
    clients.emplace_back([&] {
      const Response response = service.get(target);
      if (response.status == 200) ++whole;
      if (response.status == 503 && !header_of(response, "Retry-After").empty()) ++later;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_GT(whole, 0);
  EXPECT_EQ(whole + later, 64);
  EXPECT_LT(peak_mebibytes() - before, 64.0) << "each alone would take half of that";
}

TEST(ApiSensors, ADamagedFileHurtsNobodyAndIsReadOnce) {
  Service service;
  const std::string id = service.submit();
  const auto path = service.data.job(id) / "series.h5";
  service.write_samples(id, pressure_series({1.0, 2.0}));
  std::ifstream file(path, std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(file)), {});
  std::mt19937_64 random(7);
  for (int n = 0; n < 60; ++n) {
    std::string image = good.substr(0, good.size() - Trailer::kSize);
    image[random() % image.size()] ^= static_cast<char>(1 << (random() % 8));
    const auto trailer = make_trailer(std::as_bytes(std::span(image))).encode();
    image.append(reinterpret_cast<const char*>(trailer.data()), trailer.size());
    write_file(path, image);
    for (const char* const name : {"", "/P1"}) {
      const int status = service.get("/v1/jobs/" + id + "/sensors" + name).status;
      EXPECT_TRUE(status == 200 || status == 409 || status == 500) << status;
    }
  }
  write_file(path, good.substr(0, good.size() / 2));
  expect_problem(service.get("/v1/jobs/" + id + "/sensors/P1"), 500, "damaged-files");
}

TEST(AnswerMaker, KnowsAFileThatWasNotSurvived) {
  const DataFolder data;
  write_file(data.path() / "file", "anything");
  AnswerMaker maker;
  const auto die = [] {
    ::raise(SIGSEGV);
    return std::string();
  };
  EXPECT_THROW((void)maker.from_file(data.path() / "file", die), StorageError);
  EXPECT_THROW((void)maker.from_file(data.path() / "file", [] { return std::string("good"); }),
               StorageError);
  write_file(data.path() / "other", "anything");
  EXPECT_EQ(maker.from_file(data.path() / "other", [] { return std::string("good"); }), "good");
}

TEST(AnswerMaker, RefusesWhatItHasNoMemoryFor) {
  const DataFolder data;
  write_file(data.path() / "file", "anything");
  AnswerMaker maker({1, 1 << 20, 0.0});
  const std::string answer = maker.from_file(data.path() / "file", [] { return std::string("x"); });
  EXPECT_EQ(answer, "x") << "alone it may take all";
  EXPECT_THROW((void)maker.from_file(
                   data.path() / "file",
                   []() -> std::string { throw ApiError(ProblemType::no_samples_yet, "none"); }),
               ApiError);
}

TEST(AnswerMaker, HasNoMoreChildrenAtOnceThanItMay) {
  const DataFolder data;
  write_file(data.path() / "file", "anything");
  struct Counts {
    std::atomic<int> now = 0;
    std::atomic<int> most = 0;
  };
  // Seen by all children.
  void* const shared =
      ::mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  Counts& counts = *new (shared) Counts;
  AnswerMaker maker({32, 256 << 20, 60.0, 2});
  std::vector<std::thread> clients;
  for (int n = 0; n < 8; ++n) {
    clients.emplace_back([&] {
      EXPECT_EQ(maker.from_file(data.path() / "file",
                                [&] {
                                  const int now = ++counts.now;
                                  if (now > counts.most) counts.most = now;
                                  ::usleep(30'000);
                                  --counts.now;
                                  return std::string("done");
                                }),
                "done");
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_GE(counts.most, 1);
  EXPECT_LE(counts.most, 2);
  ::munmap(shared, sizeof(Counts));
}

TEST(ApiSensors, MarksWhatAFilterMayStillChangeUntilTheJobHasCompleted) {
  Service service;
  const std::string id = service.submit();
  service.write_samples(id, pressure_series(std::vector<double>(101, 5.0)));
  const std::string target = "/v1/jobs/" + id + "/sensors/P1?filter=gaussian&tau=0.01";
  const Json growing = body_of(service.get(target));
  EXPECT_NEAR(growing["provisional_after"].get<double>(), 0.1 - 3 * 0.01, 1e-12);
  EXPECT_NEAR(growing["columns"][0]["values"][50].get<double>(), 5.0, 1e-12);
  const Job running = service.store.claim(1, {}).value();
  (void)service.store.apply(id, JobAction::complete, running.token, {});
  EXPECT_TRUE(body_of(service.get(target))["provisional_after"].is_null());
}

TEST(ApiSensors, RefusesFiltersThatMakeNoSense) {
  Service service;
  const std::string id = service.submit();
  service.write_samples(id, pressure_series({1.0, 2.0}));
  const std::string target = "/v1/jobs/" + id + "/sensors/P1";
  for (const char* const query :
       {"?filter=gaussian", "?tau=0.01", "?filter=gaussian&tau=0", "?filter=gaussian&tau=nan",
        "?filter=gaussian&tau=-1", "?filter=gaussian&tau=1e308", "?filter=boxcar", "?from=2&to=1",
        "?from=inf", "?max_points=1", "?max_points=1e6", "?format=xml", "?form=json"}) {
    expect_problem(service.get(target + query), 400, "invalid-parameter");
  }
}

TEST(ApiSensors, HasNoDimensionlessFormWithoutScales) {
  Service service;
  const std::string id = service.submit();
  service.write_samples(id, pressure_series({1.0, 2.0}));
  expect_problem(service.get("/v1/jobs/" + id + "/sensors/P1?dimensionless=1"), 409,
                 "not-dimensionless");
}

TEST(ApiSensors, DividesByTheScenesScales) {
  Service service;
  Json scene = Json::parse(tiny_scene(0.1));
  scene["scales"] = {{"height", 0.3}, {"width", 0.6}};
  const std::string id = body_of(service.post("/v1/jobs", scene.dump()))["id"];
  service.write_samples(id, pressure_series({0.0, 1000.0 * 9.81 * 0.3}));
  const Json body = body_of(service.get("/v1/jobs/" + id + "/sensors/P1?dimensionless=1"));
  EXPECT_NEAR(body["columns"][0]["values"][1].get<double>(), 1.0, 1e-12);            // eq. 22
  EXPECT_NEAR(body["time"][1].get<double>(), 0.001 * std::sqrt(9.81 / 0.3), 1e-12);  // eq. 19
  EXPECT_EQ(body["columns"][0]["unit"], "1");
  EXPECT_EQ(body["time_unit"], "1");
}

TEST(ApiSensors, SeesTheNewSeriesAsSoonAsItIsPublished) {
  Service service;
  const std::string id = service.submit();
  const std::string target = "/v1/jobs/" + id + "/sensors/P1";
  service.write_samples(id, pressure_series({1.0}));
  EXPECT_EQ(body_of(service.get(target))["samples"], 1);
  service.write_samples(id, pressure_series({1.0, 2.0}));
  EXPECT_EQ(body_of(service.get(target))["samples"], 2);
}

}  // namespace
}  // namespace sluice::test

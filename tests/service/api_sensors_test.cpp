#include <cmath>
#include <limits>

#include "tests/service/api_support.hpp"

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

#include <fstream>
#include <string>
#include <vector>

#include "engine/scene/format/json_text.hpp"
#include "tests/service/api/api_support.hpp"

namespace sluice::test {
namespace {

using Json = nlohmann::json;

std::string repeated(std::string_view piece, std::size_t count) {
  std::string text;
  for (std::size_t n = 0; n < count; ++n) text += piece;
  return text;
}

/// A study of the tiny scene that varies one key.
std::string study_over(const std::string& key, const Json& values) {
  return Json{{"name", "s"},
              {"scene", Json::parse(tiny_scene(0.1))},
              {"vary", Json::array({{{"key", key}, {"values", values}}})}}
      .dump();
}

/// The most memory that this process ever had, MiB.
long peak_mebibytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    long kibibytes = 0;
    status >> kibibytes;
    return kibibytes / 1024;
  }
  return 0;
}

/// Bodies of at most 256 KiB, each made to cost far more than it is long.
std::vector<std::string> hostile_bodies() {
  std::vector<std::string> bodies;
  for (const char* const key :
       {"/sensors/50000000", "/sensors/18446744073709551615", "/sensors/1", "/sensors/-",
        "/sensors/00", "/new/99999999/x", "/fluid/0/size/100000000", "/sensors/1e9"}) {
    bodies.push_back(study_over(key, {1, 2}));
  }
  Json values = Json::array();
  for (int n = 0; n < 50; ++n) values.push_back(n);
  bodies.push_back(study_over("/sensors/1000000", values));
  Json wide = Json::parse(study_over("/end_time", {0.1}));
  for (int axis = 0; axis < 5; ++axis) wide["vary"].push_back({{"key", "/x"}, {"values", values}});
  bodies.push_back(wide.dump());
  // A hundred runs of a scene as large as a body may be.
  Json large = Json::parse(study_over("/end_time", values));
  large["scene"]["zeros"] = Json::parse("[" + repeated("0,", 120'000) + "0]");
  bodies.push_back(large.dump());
  large["scene"]["zeros"] = Json::parse("[" + repeated("{},", 80'000) + "0]");
  bodies.push_back(large.dump());
  bodies.push_back(study_over("/description", {std::string(200'000, 'x')}));
  bodies.push_back(
      study_over(repeated("/a", 100), {Json::parse(repeated("[", 10) + repeated("]", 10))}));
  bodies.push_back(repeated("[", 250'000));
  bodies.push_back(repeated("{\"a\":", 50'000));
  bodies.push_back("{" + repeated("\"a\":1,", 40'000) + "\"a\":1}");
  bodies.push_back("{\"" + std::string(100'000, 'k') + "\":{" + repeated("\"a\":1,", 20'000) +
                   "\"a\":1}}");
  bodies.push_back("[" + repeated("[],", 80'000) + "1]");
  bodies.push_back(std::string(250'000, '"'));
  bodies.push_back("{\"end_time\":1" + std::string(250'000, '0') + "}");
  return bodies;
}

TEST(HostileBodies, AreRefusedWithinTheirBoundOfMemory) {
  Service service;
  const std::string job = service.submit_in(JobState::completed);
  // The first one takes what any request takes.
  (void)service.post("/v1/studies?dry_run=1", study_over("/end_time", {0.1, 0.2}));
  const long before = peak_mebibytes();
  for (const std::string& body : hostile_bodies()) {
    for (const std::string& target :
         {std::string("/v1/studies?dry_run=1"), std::string("/v1/jobs?dry_run=1"),
          "/v1/jobs/" + job + "/resume"}) {
      const Response response = service.post(target, body);
      EXPECT_GE(response.status, 400) << target << " " << body.substr(0, 80);
      EXPECT_LT(response.status, 500) << target << " " << response.body.substr(0, 300);
      EXPECT_LT(response.body.size(), std::size_t{4} << 20);
    }
  }
  // A request's text is a quarter of a MiB; its study may have kMaxStudyBytes of scenes.
  EXPECT_LT(peak_mebibytes() - before, 150);
}

TEST(HostileBodies, AnIndexNeverMakesAnArrayLonger) {
  Service service;
  const Response beyond =
      service.post("/v1/studies?dry_run=1", study_over("/sensors/1/kind", {"p"}));
  expect_problem(beyond, 422, "invalid-study");
  EXPECT_NE(beyond.body.find("is no index of an array that has 1 elements"), std::string::npos)
      << beyond.body;
  const Response inside =
      service.post("/v1/studies?dry_run=1", study_over("/sensors/0/interval", {0.001, 0.002}));
  EXPECT_EQ(inside.status, 200) << inside.body;
}

TEST(StoredJson, IsReadWithinBounds) {
  EXPECT_EQ(read_stored_json(R"({"b":1,"a":[2]})").dump(), R"({"b":1,"a":[2]})");
  EXPECT_THROW((void)read_stored_json(repeated("[", 200'000)), std::runtime_error);
  EXPECT_THROW((void)read_stored_json(std::string(kMaxStoredBytes + 1, ' ')), std::runtime_error);
  EXPECT_THROW((void)read_stored_json("{\"" + std::string(kMaxKeyBytes + 1, 'k') + "\":1}"),
               std::runtime_error);
  std::string keys = "{\"\":0";
  for (std::size_t n = 0; n < kMaxKeys; ++n) keys += ",\"" + std::to_string(n) + "\":0";
  EXPECT_THROW((void)read_stored_json(keys + "}"), std::runtime_error);
  EXPECT_THROW((void)read_stored_json(std::string("{}\0x", 4)), std::runtime_error);
}

/// What somebody may have put into a job's folder is an error of that job.
TEST(StoredJson, ABadFileOfAJobIsAProblemOfThatJobAlone) {
  const std::string deep = repeated("[", 200'000) + repeated("]", 200'000);
  for (const char* const file : {"outcome.json", "report.json", "job.json", "scene.json"}) {
    Service service;
    const std::string id = service.submit_in(JobState::completed);
    write_file(service.data.job(id) / file, deep);
    EXPECT_EQ(service.get("/v1/jobs/" + id).status, 200);
    EXPECT_EQ(service.get("/v1/jobs").status, 200);
    // A report is made anew from what is whole; without its scene there is none.
    const Response report = service.get("/v1/jobs/" + id + "/report");
    const bool readable = file != std::string_view("scene.json");
    EXPECT_EQ(report.content_type, readable ? "application/json" : "application/problem+json")
        << file;
    const Response later = service.post("/v1/jobs/" + id + "/resume", R"({"end_time": 0.2})");
    EXPECT_TRUE(later.status == 200 || later.content_type == "application/problem+json") << file;
    EXPECT_EQ(service.get("/metrics").status, 200);
    EXPECT_EQ(service.ask("DELETE", "/v1/jobs/" + id).status, later.status == 200 ? 409 : 204);
  }
}

}  // namespace
}  // namespace sluice::test

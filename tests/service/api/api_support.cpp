#include "tests/service/api/api_support.hpp"

#include <cmath>
#include <filesystem>

#include "engine/scene/checks/parse.hpp"
#include "engine/store/files/series_file.hpp"
#include "service/http/http_head.hpp"

namespace sluice::test {
namespace {

using Json = nlohmann::json;

}  // namespace

Request request(std::string_view method, std::string_view target, std::string_view body,
                std::map<std::string, std::string> headers) {
  const std::string head =
      std::string(method) + " " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  auto parsed = std::get<RequestHead>(parse_head(head, {})).request;
  parsed.body = body;
  parsed.headers.merge(headers);
  return parsed;
}

Service::Service(const ServiceLimits& limits)
    : store(data.path()),
      scheduler(store, data.path(), limits),
      api(store, scheduler, data.path(), SLUICE_PROGRAM) {
  scheduler.drain();
}

Response Service::ask(std::string_view method, std::string_view target, std::string_view body,
                      std::map<std::string, std::string> headers) {
  return api.handle(request(method, target, body, std::move(headers)));
}

std::string Service::submit(std::string_view query) {
  const Response response = post("/v1/jobs" + std::string(query), tiny_scene(0.1));
  EXPECT_EQ(response.status, 202) << response.body;
  return body_of(response)["id"];
}

std::string Service::submit_in(JobState state) {
  const std::string id = submit();
  if (state == JobState::queued) return id;
  if (state == JobState::paused) return store.apply(id, JobAction::pause, "", {}).id;
  if (state == JobState::cancelled) return store.apply(id, JobAction::cancel, "", {}).id;
  const Job running = store.claim(1, {}).value();
  EXPECT_EQ(running.id, id);
  if (state == JobState::completed) {
    return store.apply(id, JobAction::complete, running.token, {}).id;
  }
  if (state == JobState::failed) {
    JobChange change;
    change.reason = "it broke";
    return store.apply(id, JobAction::fail, running.token, change).id;
  }
  return id;
}

void Service::write_samples(const std::string& id, const Series& series) {
  write_series(data.job(id) / "series.h5", {table_of(series)});
}

Json body_of(const Response& response) {
  Json body = Json::parse(response.body, nullptr, /*allow_exceptions=*/false);
  EXPECT_FALSE(body.is_discarded()) << response.body;
  return body;
}

Json list_in(const Response& response, std::string_view key) {
  Json body = body_of(response);
  EXPECT_TRUE(body.contains(key)) << response.body;
  return body.value(key, Json::array());
}

std::string header_of(const Response& response, std::string_view name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return {};
}

void expect_problem(const Response& response, int status, std::string_view slug) {
  EXPECT_EQ(response.status, status) << response.body;
  EXPECT_EQ(response.content_type, "application/problem+json");
  const Json body = body_of(response);
  EXPECT_EQ(body.value("type", ""), "/problems/" + std::string(slug)) << response.body;
  EXPECT_EQ(body.value("status", 0), status);
  EXPECT_FALSE(body.value("title", "").empty());
  EXPECT_FALSE(body.value("detail", "").empty());
}

void expect_agreement(Service& service) {
  std::size_t folders = 0;
  for (const auto& entry : std::filesystem::directory_iterator(service.data.path() / "jobs")) {
    EXPECT_TRUE(service.store.find(entry.path().filename().string())) << entry.path();
    ++folders;
  }
  const auto jobs = service.store.list({});
  EXPECT_EQ(jobs.size(), folders);
  for (const Job& job : jobs) {
    const auto scene = parse_scene(read_file(service.data.job(job.id) / "scene.json"));
    ASSERT_TRUE(scene.scene);
    EXPECT_EQ(scene.scene->end_time, job.end_time) << job.id;
  }
}

}  // namespace sluice::test
